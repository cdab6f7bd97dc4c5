"""A run as one HTML page with figures to hover, zoom and scrub: a file, or live while a run goes on."""
