"""MuJoCo robots, stepped in batches."""
