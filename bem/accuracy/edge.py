"""Error of stresses at the edge of a contact, extrapolated from the cells beside it (`bem.stress.edge_tension`).

Verified in tests/accuracy/test_edge_bars.py against the closed form of a sliding ball; judged by the experiment
`coating_error_bars`.
"""

from __future__ import annotations

from bem.accuracy.richardson import Row

EDGE = Row(
    (0.75, 0.4, 0.4),
    "First order: the stress at the edge of the contact, extrapolated from the cells beside it. The law of a straight "
    "edge on layers of several cells misses a part of what it adds to the points, and of the pressure next to the edge "
    "where the layer is thinner than a cell.",
    order=1,
    floors={
        "cusp": (0.35, 0.25, 0.15),
        "pressed": (0.03, 0.05, 0.07),
        "edge": (0.01, 0.03, 0.2),
    },
)
"""Rule of stresses at the surface where they are highest at the edge of the contact. Floors: on what the edge
adds to the stress of points (cusp), on the pressure next to the edge (pressed), and on the tension times the fraction
within a cell of the edge (edge)."""
