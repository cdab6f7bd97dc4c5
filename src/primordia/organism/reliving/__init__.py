"""The recorded life lived again, tick for tick: compared with its record, filmed, or written to a file.

A habitat in JAX lives many ticks in one call (`in_jax`), and a habitat on the host a tick at a time
(`on_host`).
"""
