"""Experiments that a remark or a constant rests on: each a script that prints what it found."""
