"""Units and grid of a point film in time, from all that acts."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from bem.lubrication.lubricant import Lubricant
from bem.lubrication.point.march import Operation, PointMarch
from bem.lubrication.point.setting import Rectangle, Setting, default_rectangle, setting_of
from bem.lubrication.point.solve import check_extent, check_load, entrainment, vectors
from bem.lubrication.time_stepping import Schedule
from bem.materials import Body

LOOKED_AT = 60
"""Times, at most, whose films say how far the grid reaches."""

Pair = tuple[float, float]


@dataclass(frozen=True)
class MarchCase:
    """What acts at the times asked for, radii (Rx, Ry) [m] at a time, bodies and oil; thickness [m] of a first film
    that is given, None of a steady one."""

    schedule: Schedule
    radii: Callable[[float], Sequence[float]]
    contact_modulus: float
    lubricant: Lubricant
    bodies: tuple[Body, ...] | None
    thickness: float | None

    def setting(self, load: float, radii: Pair, flow: Pair, extent: Rectangle | None = None) -> Setting:
        """Of a steady film."""
        return setting_of(load, radii, self.contact_modulus, flow, self.lubricant, extent, self.bodies)

    def moments(self) -> list[tuple[float, Pair, Pair]]:
        """Load, radii and sum of the speeds at some of the times, each once."""
        times = self.schedule.times
        some = np.unique(np.linspace(0, len(times) - 1, min(len(times), LOOKED_AT)).round().astype(int))
        found = []
        for i in some:
            pair = vectors(self.schedule.speeds[i])
            assert pair is not None
            first, second = (float(r) for r in self.radii(float(times[i])))
            found.append((float(self.schedule.loads[i]), (first, second), entrainment(pair)))
        return list(dict.fromkeys(found))


def march_of(
    case: MarchCase, operation: Operation, shape: tuple[int, int], tolerance: float, extent: Rectangle | None
) -> PointMarch:
    """Units of the highest load and the largest entrainment, and a grid as wide as the films of all times need."""
    moments = case.moments()
    load, radii = max(case.schedule.loads), moments[0][1]
    flow = max((one[2] for one in moments), key=lambda flow: math.hypot(*flow))
    entrained = any(flow)
    if not entrained:
        flow = (_squeezing_speed(case, load, radii[0]), 0.0)
    if extent is None:
        extent = _reach(case, moments, load, radii, flow)
    setting = case.setting(load, radii, flow, extent)
    if entrained:
        check_load(setting, load)
    check_extent(setting)
    return PointMarch(
        operation=operation,
        lubricant=case.lubricant,
        contact_modulus=case.contact_modulus,
        scales=setting.scales,
        radius=setting.frame.pair(radii)[0],
        speed=math.hypot(*flow),
        exchanged=setting.frame.exchanged,
        edges=extent,
        shape=shape,
        bodies=case.bodies,
        tolerance=tolerance,
        typical_film=setting.problem.typical_film,
    )


def _squeezing_speed(case: MarchCase, load: float, radius: float) -> float:
    """The speed [m/s] whose unit of film is the gap that bodies at rest begin with (`point_scales`)."""
    assert case.thickness is not None
    share = case.thickness / radius
    if math.isinf(case.contact_modulus):
        drive = load / radius**2 * math.sqrt(share)
    else:
        drive = 2 * case.contact_modulus * share**2
    return drive * radius / case.lubricant.viscosity


def _reach(case: MarchCase, moments: list[tuple[float, Pair, Pair]], load: float, radii: Pair, flow: Pair) -> Rectangle:
    """Edges [m] that hold those of the steady films of all moments, and of the gap that a march begins with."""
    found = [_edges(case.setting(*moment)) for moment in moments if any(moment[2])]
    if case.thickness is not None:
        setting = case.setting(load, radii, flow)
        unit, film = setting.scales.length, case.thickness / setting.scales.film
        both = [default_rectangle(setting.hertz, setting.scales.ratio, film, drag) for drag in ((0.0, 1.0), (1.0, 0.0))]
        x, y = setting.frame.pair((both[0][1] * unit, both[1][3] * unit))
        found.append((-x, x, -y, y))
    first, last, below, above = (np.array(found)[:, k] for k in range(4))
    return float(first.min()), float(last.max()), float(below.min()), float(above.max())


def _edges(setting: Setting) -> Any:
    x0, x1, y0, y1 = (edge * setting.scales.length for edge in setting.problem.rectangle)
    x, y = setting.frame.axes(np.array([x0, x1]), np.array([y0, y1]))
    return float(x[0]), float(x[1]), float(y[0]), float(y[1])
