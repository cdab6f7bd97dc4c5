"""Figures of what assays found: each module has `draw(found) -> Figure`."""
