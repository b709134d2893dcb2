"""Values of a scene whose unit is likely wrong: said in place of whatever else then refuses the scene.

A modulus of 3 Pa or a radius of 6 km makes Hertz' contact larger than every grid, and the grid is refused where the
unit is meant. Where nothing refuses it, it is only noted (`plausible.py`). Knows keys and values of scenes, nothing
of contacts. Verified in tests/scenes/test_refusals.py.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from bem.plausibility import LARGEST_RADIUS, SMALLEST_RADIUS, SOFTEST, STIFFEST
from bem.quantities import si
from bem.scenes.common import MaterialScene
from bem.scenes.table import Table

_RADII = ("radius", "radius_y", "ball", "radii")


def suspected_units(scene: Table) -> list[str]:
    """A message for each modulus and radius of a scene that no solid has; a stand-in for a rigid body that is called
    so is meant."""
    return list(dict.fromkeys(_suspected(scene, "")))


def _suspected(value: Any, key: str) -> Iterator[str]:
    if isinstance(value, Table):
        for name, inner in value:
            yield from _suspected(inner, f"{key}.{name}" if key else name)
        if isinstance(value, MaterialScene):
            name = "youngs_modulus" if value.stiffness is None else "stiffness"
            yield from _modulus(value, f"{key}.{name}")
    elif isinstance(value, list | tuple):
        for i, inner in enumerate(value):
            yield from _suspected(inner, f"{key}[{i}]")
    elif isinstance(value, float) and key.rpartition(".")[2].partition("[")[0] in _RADII:
        yield from _radius(value, key)


def _modulus(material: MaterialScene, key: str) -> Iterable[str]:
    value = material.build().youngs_modulus
    if value < SOFTEST or (value > STIFFEST and "rigid" not in material.name.lower()):
        meant = f'; "{value:g} GPa" if that is meant' if 0.01 <= value < SOFTEST else ""
        yield (
            f"{key}: was read as {si(value, 'Pa')} ({value / 1e9:.3g} GPa), which no solid has; check its unit: "
            f"allowed: {si(SOFTEST, 'Pa')} (gels) to {si(STIFFEST, 'Pa')} (above diamond){meant}"
        )


def _radius(value: float, key: str) -> Iterable[str]:
    if not SMALLEST_RADIUS <= value <= LARGEST_RADIUS:
        yield (
            f"{key}: was read as {value:.3g} m, which no body in contact has; check its unit: allowed: "
            f"{SMALLEST_RADIUS:g} m to {LARGEST_RADIUS:g} m"
        )
