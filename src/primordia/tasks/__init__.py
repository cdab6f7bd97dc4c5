"""Tasks, one TOML file each: the paper's experiments, and others, as data."""
