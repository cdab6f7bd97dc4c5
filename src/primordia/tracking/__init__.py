"""Metrics of runs for dashboards, written by a separate process, also during the run."""
