"""What makes a process start quickly: names that load when first used, compiled loops read without the compiler, and
loops compiled ahead of their first use.

Knows Python's imports and numba's inside, nothing of what is computed. Verified in tests/packaging/.
"""
