"""The elastic contact whose pressure is capped at a hardness: what the plastic indentation is compared to.

Knows condensed bodies. Verified in tests/fem_reference/test_fem_plasticity.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fem_reference.contact_body import ElasticBody, elastic_body
from fem_reference.contact_solve import weighted_profile
from meshes.contact_block import ContactBlock

CAP = 2.8
"""Hardness over yield stress in the capped model that the plastic one is compared to (Tabor)."""


def _capped_pressures(body: ElasticBody, profile: NDArray[np.float64], approach: float) -> NDArray[np.float64]:
    """Pressures (n,) at an approach, by an active set with three states: open, in contact, at the cap."""
    state = np.where(profile < approach * body.weights, 1, 0)
    for _ in range(200):
        free = state == 1
        pressure = np.where(state == 2, CAP, 0.0)
        right = (approach * body.weights - profile - body.compliance @ pressure)[free]
        pressure[free] = np.linalg.solve(body.compliance[np.ix_(free, free)], right)
        gap = body.compliance @ pressure + profile - approach * body.weights
        small = 1e-12 * approach * body.weights
        new = np.where(free & (pressure < 0), 0, state)
        new = np.where(free & (pressure > CAP), 2, new)
        # a node leaves the cap where the gap has opened, and joins the contact where the bodies would overlap
        new = np.where(((state == 2) & (gap > small)) | ((state == 0) & (gap < -small)), 1, new)
        if np.array_equal(new, state):
            return pressure
        state = new
    raise RuntimeError(f"the capped contact at an approach of {approach:g} does not settle")


def capped(
    loads: NDArray[np.float64], sizes: NDArray[np.float64], nu: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Contact sizes and approaches of an elastic body whose pressure is capped at CAP yield stresses.

    loads : what is carried; sizes : contact sizes near the answer, which choose the scale of each problem; all in the
    units of `_express`.

    The condensed body of the contact cases, one mesh; each load by bisection over the approach, each approach by an
    active set.
    """
    block = ContactBlock(patch=1.3, cells=104, reach=1.3e5, depth=1.3e5)
    body = elastic_body(block, {"substrate": (1.0, nu)}, axisymmetric=True)
    stiffness = 1 / (1 - nu**2)
    parabola = weighted_profile(body.nodes, lambda x: x * x / 2, axisymmetric=True)

    radius, depth = np.empty(loads.size), np.empty(loads.size)
    for i, (load, size) in enumerate(zip(loads, sizes, strict=True)):
        force = load / (2 * np.pi * size**2)
        profile = size / stiffness * parabola
        low, high = 0.0, 2 * size / stiffness
        for _ in range(45):
            middle = 0.5 * (low + high)
            pressure = _capped_pressures(body, profile, middle)
            low, high = (middle, high) if body.weights @ pressure < force else (low, middle)
        last = int(np.flatnonzero(pressure > 0)[-1])
        radius[i] = 0.5 * (body.nodes[last] + body.nodes[last + 1]) * size
        depth[i] = middle * size * stiffness
    return radius, depth
