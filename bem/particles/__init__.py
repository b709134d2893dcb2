"""Particles: what they are, and the statistics of simulated and measured ones (thesis, paper B)."""
