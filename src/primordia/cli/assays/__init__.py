"""The commands `primordia assay ...`: heredity, limits of evolution, and the worth of genomes."""
