"""Experiments: arms of many worlds, cut into jobs that are runs, lived on all cores or on a cluster."""
