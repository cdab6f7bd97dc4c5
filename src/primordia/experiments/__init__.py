"""Experiments: arms of many worlds, divided into jobs. A job is a run on one core of any machine."""
