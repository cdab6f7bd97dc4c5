"""Figures of runs, as PNG and SVG."""
