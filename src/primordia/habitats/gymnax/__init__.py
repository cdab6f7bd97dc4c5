"""Environments with the interface of gymnax: gymnax, Craftax, Octax, and your own."""
