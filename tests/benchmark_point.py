"""A measured point of a benchmark with plain numbers, for tests of records and tables."""

from bem.benchmarks.measure import Point


def point(**change):
    """Return a point; `change` replaces fields."""
    settings = {
        "case": "contact-periodic",
        "size": 256,
        "threads": 1,
        "first_cpu": 0.1,
        "cpu": (0.010, 0.011, 0.012),
        "wall": (0.01, 0.01, 0.01),
        "memory": 1e6,
        "errors": {"residual": 1e-9},
        "counts": {"convolutions": 30.0},
        "values": {},
        "split": {"whole": 0.01},
    }
    return Point(**(settings | change))
