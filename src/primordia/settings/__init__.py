"""Settings: what every group of settings has in common, and nested tables of settings."""
