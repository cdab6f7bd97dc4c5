"""The commands `primordia assay ...`, which measure what is inherited and what limits evolution."""
