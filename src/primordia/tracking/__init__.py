"""Metrics of runs for dashboards, written beside the run by another process, also while it goes on."""
