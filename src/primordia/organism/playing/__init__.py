"""Fresh games: organisms play with keys that no run uses, many side by side, without neighbours.

A habitat in JAX plays many ticks in one call (`in_jax`), and a habitat on the host a tick at a time
(`on_host`).
"""
