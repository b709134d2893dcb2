"""Bodies as conductors of heat, and checks of the arguments of the public functions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from numbers import Real

from bem.arguments import is_finite
from bem.errors import InputError
from bem.grid import Grid
from bem.materials import Body

_THERMAL_CONSTANTS = {"thermal_conductivity": "W/(m K)", "density": "kg/m^3", "heat_capacity": "J/(kg K)"}


@dataclass(frozen=True)
class LayerConductor:
    """Layer as a conductor of heat: thickness [m], conductivity [W/(m K)], diffusivity [m^2/s]."""

    thickness: float
    conductivity: float
    diffusivity: float


@dataclass(frozen=True)
class Conductor:
    """Half-space, bare or under layers, that moves along x under the heat source.

    Attributes
    ----------
    conductivity : k [W/(m K)].
    diffusivity : kappa [m^2/s].
    speed : U, of the body relative to the source, positive along +x [m/s].
    bulk : temperature far below the surface [K].
    layers : outermost first.
    """

    conductivity: float
    diffusivity: float
    speed: float
    bulk: float
    layers: tuple[LayerConductor, ...] = ()

    @property
    def peclet_per_length(self) -> float:
        """Return U / (2 kappa) [1/m] with the sign of the speed; times a length it is a Peclet number."""
        return self.speed / (2 * self.diffusivity)


def conductors_of(
    owner: str,
    bodies: Body | Sequence[Body],
    speeds: float | Sequence[float],
    bulk: float | Sequence[float],
    *,
    layered: bool = False,
) -> tuple[Conductor, ...]:
    """Check bodies, speeds and bulk temperatures, and return one or two conductors.

    layered : True if the caller computes the heat of layers.

    Raises
    ------
    InputError : bodies that are neither a body nor a pair, speeds or bulk temperatures of another number or not finite,
        a body with layers that the caller does not compute, a material without its three thermal constants; one
        message per mistake.
    """
    given = (bodies,) if isinstance(bodies, Body) else tuple(bodies) if isinstance(bodies, Sequence) else ()
    if len(given) not in (1, 2) or not all(isinstance(body, Body) for body in given):
        raise InputError(f"{owner}: bodies {bodies!r} must be a Body or a pair of them")
    messages: list[str] = []
    velocities = _numbers(owner, "speeds", speeds, len(given), "m/s", messages)
    temperatures = _numbers(owner, "bulk", bulk, len(given), "K", messages)
    for number, body in enumerate(given):
        what = f"{owner}: body {number + 1} ({body.material.name})"
        if body.layers and not layered:
            messages.append(
                f"{what} has {len(body.layers)} layer(s), which are not included in heat conduction; leave them out "
                "(Body(body.material)) to take the half-space alone: a layer of thickness t and conductivity k adds up "
                "to heat x t / k to the temperature of its surface"
            )
        inside = [(what, body.material)]
        if layered:
            inside += [(f"{what}, layer of {layer.material.name}", layer.material) for layer in body.layers]
        messages += [
            f"{name}: its Material needs {key}, positive and finite [{unit}]"
            for name, material in inside
            for key, unit in _THERMAL_CONSTANTS.items()
            if getattr(material, key) is None
        ]
    if messages:
        raise InputError(messages)
    return tuple(
        Conductor(
            body.material.thermal_conductivity or 0.0,
            body.material.thermal_diffusivity or 0.0,
            speed,
            bulk_k,
            tuple(
                LayerConductor(
                    layer.thickness,
                    layer.material.thermal_conductivity or 0.0,
                    layer.material.thermal_diffusivity or 0.0,
                )
                for layer in body.layers
            ),
        )
        for body, speed, bulk_k in zip(given, velocities, temperatures, strict=True)
    )


def check_steady(grid: Grid, bodies: Sequence[Conductor]) -> None:
    """Check that a steady temperature exists.

    Raises
    ------
    InputError : a grid periodic along x, or periodic along y under a body at rest.
    """
    history = "or ask for the temperature after a time (surface_temperature_history)"
    if grid.periodic[0]:
        raise InputError(
            "surface_temperature: the grid is periodic along x, so that the same heat is made on every period behind "
            "another for ever and no steady temperature exists; make the grid free along x, wide enough for the heat "
            "to spread (in a scene grid.periodic = false, or [false, true] for a slice of a long cylinder between "
            f"moving bodies), {history}"
        )
    if grid.periodic[1] and any(body.speed == 0 for body in bodies):
        raise InputError(
            "surface_temperature: the grid is periodic along y and a body does not move (speed 0): under a line source "
            "at rest the temperature rises for ever, with the logarithm of time, and no steady temperature exists; "
            "make the grid free along y, as wide as the contact is (in a scene grid.periodic = false with the "
            f"cylinder's width as length along y), give the body the speed that it has, {history}"
        )


def _numbers(owner: str, key: str, given: object, count: int, unit: str, messages: list[str]) -> tuple[float, ...]:
    """Return `count` finite numbers.

    For one body a plain number will do, and of a pair of bulk temperatures the first is taken.
    """
    values = (given,) if isinstance(given, Real) else tuple(given) if isinstance(given, Sequence) else ()
    if key == "bulk" and count == 1:
        values = values[:1]
    numbers = [v for v in values if is_finite(v)]
    if len(values) != count or len(numbers) != count:
        messages.append(
            f"{owner}: {key} {given!r} must be {count} finite number{'s'[: count - 1]} [{unit}], one a body"
        )
        return (0.0,) * count
    return tuple(float(number) for number in numbers)
