"""Layers used by several problems, and what a body with a layer is."""

from __future__ import annotations

from collections.abc import Sequence

from fem_reference.elasticity import Material
from meshes.grids import CELL_TAGS, layer_names

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

STACKS: dict[str, tuple[float, ...]] = {
    # a hard coat on a compliant, nearly incompressible interlayer; a soft one on a stiff interlayer
    "stiff-on-soft": (10.0, 0.25, 0.25, 0.1, 0.45, 0.15),
    "soft-on-stiff": (0.2, 0.4, 0.3, 8.0, 0.2, 0.2),
}
"""The same three figures of each layer of a stack, outermost first; by name."""


def stack_of(layer: Sequence[float] | None) -> list[tuple[float, float, float]]:
    """(modulus ratio, Poisson's ratio, thickness) of each layer, outermost first. ValueError unless in threes."""
    figures = list(layer or ())
    if len(figures) % 3:
        raise ValueError(f"layer: {len(figures)} figures; three belong to each layer, outermost first")
    return list(zip(figures[::3], figures[1::3], figures[2::3], strict=True))


def one_layer(layer: Sequence[float] | None) -> float | None:
    """Thickness of the only layer, None without one. ValueError where there are several."""
    stack = stack_of(layer)
    if len(stack) > 1:
        raise ValueError(f"layer: {len(stack)} layers, but this problem takes one")
    return stack[0][2] if stack else None


def bodies(nu: float, layer: Sequence[float] | None) -> tuple[dict[str, Material], tuple[float, ...]]:
    """Materials by cell tag, and the thicknesses of the layers, outermost first.

    The substrate's modulus is the unit. ValueError for figures no solid has.
    """
    stack = stack_of(layer)
    messages = []
    if not -1 < nu < 0.5:
        messages.append(f"nu {nu}: Poisson's ratio must lie between -1 and 0.5, both excluded")
    if len(stack) > len(CELL_TAGS) - 1:
        messages.append(f"layer: {len(stack)} layers; at most {len(CELL_TAGS) - 1} are meshed")
    for modulus, poisson, thickness in stack:
        if not modulus > 0:
            messages.append(f"layer: modulus ratio {modulus} must be positive")
        if not -1 < poisson < 0.5:
            messages.append(f"layer: Poisson's ratio {poisson} must lie between -1 and 0.5, both excluded")
        if not thickness > 0:
            messages.append(f"layer: thickness {thickness} must be positive")
    if messages:
        raise ValueError("; ".join(messages))
    materials = {"substrate": Material(1.0, nu)}
    for name, (modulus, poisson, _) in zip(layer_names(len(stack)), stack, strict=True):
        materials[name] = Material(modulus, poisson)
    return materials, tuple(thickness for _, _, thickness in stack)


def describe_body(nu: float, layer: Sequence[float] | None, length: str) -> str:
    """The body in words, thickness in units of `length`."""
    words = [
        f"{thickness:.4g} {length} thick (modulus {modulus:.4g} of the substrate's, Poisson's ratio {poisson:g})"
        for modulus, poisson, thickness in stack_of(layer)
    ]
    if not words:
        return f"a homogeneous half-space (Poisson's ratio {nu:g})"
    if len(words) == 1:
        return f"a half-space (Poisson's ratio {nu:g}) with a bonded layer {words[0]}"
    return (
        f"a half-space (Poisson's ratio {nu:g}) under {len(words)} bonded layers, outermost first: {'; '.join(words)}"
    )
