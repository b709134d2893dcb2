"""Quick starts: names that load when first used, and loops compiled ahead of their first use.

`lazy` has the packages that load names on demand, `compile_ahead` compiles recorded loops on all cores, `signatures`
is the text form of the record. Knows Python's imports and numba's dispatchers, nothing of what is computed. Verified in
tests/packaging/.
"""
