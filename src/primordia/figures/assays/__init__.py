"""Figures of assays: each module has `draw(found) -> Figure`."""
