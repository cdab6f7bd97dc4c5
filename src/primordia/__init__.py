"""Primordia: evolutionary self-replication in any simulator."""
