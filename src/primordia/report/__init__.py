"""Pages in HTML about runs, with interactive figures, as files or live from a running run."""
