"""Games played side by side: in a habitat in JAX many ticks at a time, on the host tick by tick."""
