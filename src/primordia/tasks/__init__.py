"""One TOML file a task: the paper's experiments as data."""
