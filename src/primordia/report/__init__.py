"""A run as one HTML page: figures to hover, zoom and scrub, from a file or live from a run that goes on."""
