"""Tasks, one TOML file each: the paper's experiments as data."""
