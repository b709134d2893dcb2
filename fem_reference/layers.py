"""Layers used by several problems, and what a body with a layer is."""

from __future__ import annotations

from collections.abc import Sequence

from fem_reference.elasticity import Material

LAYERS: dict[str, tuple[float, float, float]] = {
    "soft": (0.1, 0.4, 0.5),
    "stiff": (10.0, 0.25, 0.5),
    "soft-thin": (0.1, 0.4, 0.1),
    "stiff-thin": (10.0, 0.25, 0.1),
    "soft-thick": (0.1, 0.4, 2.0),
    "stiff-thick": (10.0, 0.25, 2.0),
    "rubber": (0.01, 0.49, 1.0),
    # tribofilms on steel (210 GPa) under a patch of a = 1 um (200 nm) or 100 nm (20 nm, 1 nm)
    "film-15GPa-200nm": (15 / 210, 0.3, 0.2),
    "film-130GPa-20nm": (130 / 210, 0.3, 0.2),
    "film-15GPa-1nm": (15 / 210, 0.3, 0.01),
}
"""Modulus over the substrate's, Poisson's ratio, thickness over the load's radius or half-width; by name."""


def bodies(nu: float, layer: Sequence[float] | None) -> tuple[dict[str, Material], float | None]:
    """Materials by cell tag, and the layer's thickness.

    The substrate's modulus is the unit. ValueError for figures no solid has.
    """
    messages = []
    if not -1 < nu < 0.5:
        messages.append(f"nu {nu}: Poisson's ratio must lie between -1 and 0.5, both excluded")
    if layer is not None:
        modulus, poisson, thickness = layer
        if not modulus > 0:
            messages.append(f"layer: modulus ratio {modulus} must be positive")
        if not -1 < poisson < 0.5:
            messages.append(f"layer: Poisson's ratio {poisson} must lie between -1 and 0.5, both excluded")
        if not thickness > 0:
            messages.append(f"layer: thickness {thickness} must be positive")
    if messages:
        raise ValueError("; ".join(messages))
    materials = {"substrate": Material(1.0, nu)}
    if layer is None:
        return materials, None
    materials["layer"] = Material(layer[0], layer[1])
    return materials, layer[2]


def describe_body(nu: float, layer: Sequence[float] | None, length: str) -> str:
    """The body in words, thickness in units of `length`."""
    if layer is None:
        return f"a homogeneous half-space (Poisson's ratio {nu:g})"
    return (
        f"a half-space (Poisson's ratio {nu:g}) with a bonded layer {layer[2]:.4g} {length} thick "
        f"(modulus {layer[0]:.4g} of the substrate's, Poisson's ratio {layer[1]:g})"
    )
