"""Runs: directories on disk, what they record, and how they are begun, continued and repeated."""
