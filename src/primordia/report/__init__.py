"""A run as one HTML page with figures to hover, zoom and scrub, from a file or live from a run."""
