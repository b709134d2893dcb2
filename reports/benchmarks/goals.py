"""Goals of run times."""

PEER_GOALS = {
    ("tamaas", 512): 60.0,
    ("tamaas", 1024): 100.0,
    ("aspher", 1024): 15.0,
    ("tamaas", 2048): 200.0,
    ("aspher", 2048): 20.0,
}
"""How many times faster bem is meant to be, at equal residual on one thread."""
FLOOR_GOALS = {256: 2.5, 512: 1.8, 1024: 1.6, 2048: 1.5}
"""Time of the periodic contact over that of as many FFTW pairs as it has convolutions, by cells a side."""
