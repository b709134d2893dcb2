"""Radial rolling bearings: how the load is shared by balls or rollers, and every contact on both rings.

Load share: each element is pressed in by delta cos(psi) - c/2 on radial shift delta and clearance c, and carries K
times that to the power n (Stribeck 1901, Sjovall 1933; Harris, *Rolling Bearing Analysis*, ch. 7). Of balls K and
n = 1.5 are Hertz' for both rings, exact. Rollers are cut into slices, which carry by their own compression between
profile and rings (n = 10/9, `reference_life`), tilted rings or not. Both surfaces roll at omega d_m (1 - gamma^2) / 4
over either ring, gamma = D / d_m.

Balls carry an axial load at contact angles of their own (`ball_load`); they slide within their curved contacts, and
spin under an axial load (`differential_sliding`). Edge pressure and skew of rollers are left out. A contact of a roller
has the load per length of its most loaded slice, and its friction is that of all slices. The line film of a scene takes
the middle of a ball's ellipse, and no oil that leaves sideways. The centrifugal force is in the loads of the outer
ring, not in how the load is shared.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from bem.elements.ball_load import BallLoads, share_with_axial_load
from bem.elements.contact import EVEN, ElementContact
from bem.elements.differential_sliding import spins_on_first
from bem.elements.model import Contacts, ElementModel
from bem.elements.rating_life import BearingGeometry, Cleanliness
from bem.elements.reference_life import SlicedRollers, slice_rollers
from bem.materials import contact_modulus
from bem.quantities import si
from bem.reference_solutions.hertz import ellipse_contact
from bem.scenes.common import PositiveLength, PositivePressure, problem
from bem.scenes.units import Dimension, Force, Length, Number, Ratio, RotationSpeed

_STEEL_DENSITY = 7800.0  # kg/m^3, of elements whose material says none
USUAL_BALL_FRICTION = 0.0015
"""Friction coefficient of deep groove ball bearings at the bore, at P = C / 10 and well lubricated (catalogues)."""
_UNLOADED = 1e-9
"""Load of an element over the highest up to which it carries none: one at 90 degrees does by rounding alone."""
BALL_POWER = 1.5
"""Exponent of the load of a ball in its compression between both rings (Hertz)."""


GrooveRatio = Annotated[float, Number("", "the radius of the groove over the diameter of a ball", "0.52")]
AxialFactor = Annotated[Ratio, Field(ge=0, le=10)]


class BearingModel(ElementModel):
    """A radial bearing with a turning inner ring: dimensions of a catalogue or measured, load, clearance, speed.

    Body 1 is the ring, body 2 the ball or roller. Without `pitch_diameter` it is the mean of bore and outside. The load
    is `radial_load`, or the one that gives `hertz_pressure`, the highest Hertz pressure on the inner ring: of rollers
    that of the most loaded slice, with their profile and tilt.
    For the rating life: `dynamic_load_rating`, `static_load_rating` and `fatigue_load_limit` of a catalogue, which
    follow from the geometry where they are left out; `cleanliness`, or `contamination_factor` itself; `reliability` in
    per cent. Of rollers `profile` and `tilt` of the rings against each other. Of balls `axial_load`, with
    `axial_factors` X and Y of a catalogue for the equivalent load, which follow ISO 281 where they are left out.
    """

    element: Literal["rolling-bearing"] = "rolling-bearing"
    rolling: Literal["ball", "roller"] = "ball"
    bore: PositiveLength
    outside: PositiveLength
    pitch_diameter: PositiveLength | None = None
    diameter: PositiveLength
    count: Annotated[int, Field(strict=True, ge=3, le=200)]
    length: PositiveLength | None = None
    groove: Annotated[GrooveRatio, Field(gt=0.5, lt=1)] = 0.52
    radial_load: Annotated[Force, Field(gt=0)] | None = None
    hertz_pressure: PositivePressure | None = None
    axial_load: Annotated[Force, Field(ge=0)] = 0.0
    axial_factors: tuple[AxialFactor, AxialFactor] | None = None
    clearance: Annotated[Length, Field(ge=0)] = 0.0
    speed: Annotated[RotationSpeed, Field(gt=0)]
    dynamic_load_rating: Annotated[Force, Field(gt=0)] | None = None
    static_load_rating: Annotated[Force, Field(gt=0)] | None = None
    fatigue_load_limit: Annotated[Force, Field(gt=0)] | None = None
    cleanliness: Cleanliness | None = None
    contamination_factor: Annotated[Ratio, Field(ge=0, le=1)] | None = None
    reliability: Literal[90, 95, 96, 97, 98, 99] = 90
    profile: Literal["logarithmic", "straight"] = "logarithmic"
    tilt: Annotated[float, Dimension("rad", "an angle", "1 mrad"), Field(ge=0, lt=0.05)] = 0.0

    @model_validator(mode="after")
    def _fits(self) -> Self:
        if not self.outside > self.bore:
            raise problem("outside is not larger than bore", "outside > bore")
        if self.rolling == "roller" and self.length is None:
            raise problem('rolling = "roller" without length', 'the length of a roller, such as length = "11 mm"')
        if self.rolling == "ball" and self.length is not None:
            raise problem('rolling = "ball" with a length', 'no length, or rolling = "roller"')
        pitch = self.pitch
        if not (self.bore < pitch - self.diameter and pitch + self.diameter < self.outside):
            raise problem("the rolling elements do not fit between bore and outside", "a smaller diameter")
        if self.count * math.asin(self.diameter / pitch) > math.pi:
            raise problem(f"{self.count} elements do not fit on the pitch circle", "fewer, or smaller ones")
        if (self.radial_load is None) == (self.hertz_pressure is None):
            if self.radial_load is None:
                raise problem("neither radial_load nor hertz_pressure given", 'one of them: radial_load = "4 kN"')
            raise problem("both radial_load and hertz_pressure given", "one of them; delete the other")
        if self.cleanliness is not None and self.contamination_factor is not None:
            raise problem("both cleanliness and contamination_factor given", "one of them")
        if self.tilt and self.rolling == "ball":
            raise problem("tilt of a ball bearing", 'no tilt, or rolling = "roller"')
        if self.axial_load and self.rolling == "roller":
            raise problem("axial_load of a roller bearing", "a ball bearing; cylindrical rollers carry none by rolling")
        if self.axial_load and self.hertz_pressure is not None:
            raise problem("axial_load beside hertz_pressure", "radial_load beside axial_load")
        if self.axial_factors is not None and not self.axial_load:
            raise problem("axial_factors without axial_load", "both, or neither")
        return self

    @property
    def edge_words(self) -> str:
        """Words behind the highest pressure of straight rollers, whose sharp ends it leaves out; empty for others."""
        if self.length is None or self.profile != "straight":
            return ""
        return " without edge pressure"

    @property
    def pitch(self) -> float:
        """Pitch diameter: of the circle of the middles of the elements [m]."""
        return 0.5 * (self.bore + self.outside) if self.pitch_diameter is None else self.pitch_diameter

    @property
    def geometry(self) -> BearingGeometry:
        """Internal geometry, for load ratings and lives."""
        return BearingGeometry(self.rolling, self.diameter, self.pitch, self.count, self.length, self.groove)

    @cached_property
    def load(self) -> float:
        """Radial load [N]: the one given, or the one that gives the Hertz pressure."""
        if self.radial_load is not None:
            return self.radial_load
        assert self.hertz_pressure is not None
        highest = self._load_under(self.hertz_pressure)
        if self.length is not None:
            return self._load_of_slices(highest)
        stiffness, power = self._stiffness(), BALL_POWER
        shift = (highest / stiffness) ** (1 / power) + 0.5 * self.clearance
        pressed = [max(shift * math.cos(a) - 0.5 * self.clearance, 0.0) for a in self._angles]
        return stiffness * sum(one**power * math.cos(a) for one, a in zip(pressed, self._angles, strict=True))

    def _load_of_slices(self, highest: float) -> float:
        """Return the radial load [N] under which the most loaded slice of all has a load per length [N/m] that gives
        `highest` [N] on the whole length of a roller."""
        from scipy.optimize import brentq

        def excess(load: float) -> float:
            slices = self._sliced(load).loads
            return slices.shape[1] * float(slices.max()) / highest - 1

        low = high = highest
        while excess(low) > 0:
            low *= 0.5
        while excess(high) < 0:
            high *= 2
        return float(brentq(excess, low, high, xtol=1e-12 * highest, rtol=1e-12))

    def _load_under(self, pressure: float) -> float:
        """Return the load of a rolling element [N] that presses on the inner ring with a Hertz pressure [Pa]."""
        modulus = contact_modulus(self.first.build(), self.second.build())
        inner = _races(self)[0]
        along = 1 / (1 / inner.radius + 2 / self.diameter)
        if self.length is not None:
            return math.pi * along * pressure**2 / modulus * self.length
        unit = ellipse_contact(radii=(along, inner.across), contact_modulus=modulus, load=1.0)
        return (pressure / unit.maximum_pressure) ** 3

    def _stiffness(self) -> float:
        modulus = contact_modulus(self.first.build(), self.second.build())
        return _ball_stiffness(self, _races(self), modulus)

    @property
    def _angles(self) -> list[float]:
        return [2 * math.pi * i / self.count for i in range(self.count)]

    @cached_property
    def shared(self) -> list[float]:
        """Loads of all rolling elements [N], without centrifugal force, from the most loaded one round."""
        if self.ball_loads is not None:
            return [float(load) for load in self.ball_loads.loads]
        if self.slices is not None:
            return [float(load) for load in self.slices.loads.sum(axis=1)]
        return share(self.load, self._stiffness(), BALL_POWER, self.clearance, self._angles)

    @cached_property
    def ball_loads(self) -> BallLoads | None:
        """Loads and contact angles of balls under an axial load too; None without one."""
        if not self.axial_load:
            return None
        return share_with_axial_load(
            self.load,
            self.axial_load,
            stiffness=self._stiffness(),
            centre_distance=(2 * self.groove - 1) * self.diameter,
            clearance=self.clearance,
            angles=np.array(self._angles),
        )

    @cached_property
    def slices(self) -> SlicedRollers | None:
        """Loads of the slices of all rollers; None for balls."""
        return None if self.length is None else self._sliced(self.load)

    def _sliced(self, load: float) -> SlicedRollers:
        """Loads of the slices of all rollers under a radial load [N]."""
        profiled = self.profile == "logarithmic"
        return slice_rollers(self.geometry, load, clearance=self.clearance, tilt=self.tilt, profiled=profiled)

    def _spinning(
        self, inner: ElementContact, outer: ElementContact, contact_angle: float
    ) -> tuple[ElementContact, ElementContact]:
        """Return both contacts of an element, of a ball at a contact angle [rad] with its spin on one of them."""
        spin = self.speed * math.sin(contact_angle)
        if spin == 0:
            return inner, outer
        modulus = contact_modulus(self.first.build(), self.second.build())
        if spins_on_first((inner, outer), modulus):
            return replace(inner, spin=spin), outer
        return inner, replace(outer, spin=spin)

    def contacts(self) -> Contacts:
        """Return all loaded contacts, on inner and outer ring, by their angle from the load."""
        angles, shared = self._angles, self.shared
        leaning = np.zeros(self.count) if self.ball_loads is None else self.ball_loads.contact_angles
        uneven = _unevenness(self.slices)
        pressed_out = _centrifugal(self)
        found: list[ElementContact] = []
        for number, (angle, load) in enumerate(zip(angles, shared, strict=True)):
            turned = math.degrees(angle if angle <= math.pi else angle - 2 * math.pi)
            contact_angle = float(leaning[number])
            gamma = self.diameter / self.pitch * math.cos(contact_angle)
            rolling = 0.25 * self.speed * self.pitch * (1 - gamma**2)
            if load <= _UNLOADED * max(shared):
                continue
            both = []
            for race in _races(self, contact_angle):
                total = load * uneven.get(number, 1.0) + (pressed_out if race.name == "outer ring" else 0.0)
                both.append(
                    ElementContact(
                        f"{race.name}, {round(turned, 1):g} deg", math.radians(turned), total,
                        (race.radius, 0.5 * self.diameter), (rolling, rolling), race.across, self.length,
                        slices=() if self.slices is None else self.slices.along(number, total), path=race.name,
                    )
                )  # fmt: skip
            found += self._spinning(both[0], both[1], contact_angle)
        return Contacts(
            tuple(found), "angle", "rad", geometry=_load_sharing(self, shared, pressed_out), at_once=float(len(found))
        )


@dataclass(frozen=True)
class _Race:
    """A ring's path: its radius along the rolling [m], negative outside; relative radius across."""

    name: str
    radius: float
    across: float


def _races(model: BearingModel, contact_angle: float = 0.0) -> tuple[_Race, _Race]:
    pitch = model.pitch / math.cos(contact_angle)
    inner, outer = 0.5 * (pitch - model.diameter), 0.5 * (pitch + model.diameter)
    across = math.inf
    if model.rolling == "ball":
        across = 1 / (2 / model.diameter - 1 / (model.groove * model.diameter))
    return _Race("inner ring", inner, across), _Race("outer ring", -outer, across)


def _unevenness(rollers: SlicedRollers | None) -> dict[int, float]:
    """Return the load per length of the most loaded slice of each roller that carries, over the roller's mean."""
    if rollers is None:
        return {}
    return {number: float(slices.max() / slices.mean()) for number, slices in enumerate(rollers.loads) if slices.any()}


def _ball_stiffness(model: BearingModel, races: Sequence[_Race], modulus: float) -> float:
    """Return the stiffness K [N/m^1.5] of one ball between both rings."""
    ball = 0.5 * model.diameter
    single = []
    for race in races:
        radii = (1 / (1 / race.radius + 1 / ball), race.across)
        one = ellipse_contact(radii=radii, contact_modulus=modulus, load=1.0)
        single.append(one.approach)  # of 1 N: Hertz' approach grows with the load to the power 2/3
    return sum(single) ** -BALL_POWER


def share(load: float, stiffness: float, power: float, clearance: float, angles: Sequence[float]) -> list[float]:
    """Return the loads [N] of elements at angles from a radial load [N] that they carry together.

    stiffness K [N/m^power], diametral clearance [m]. The radial shift is found by bracketing.
    """
    from scipy.optimize import brentq

    def loads(shift: float) -> list[float]:
        return [stiffness * max(shift * math.cos(a) - 0.5 * clearance, 0.0) ** power for a in angles]

    def missing(shift: float) -> float:
        return sum(q * math.cos(a) for q, a in zip(loads(shift), angles, strict=True)) / load - 1

    high = 0.5 * clearance + (load / stiffness) ** (1 / power)
    while missing(high) < 0:
        high *= 2
    return loads(float(brentq(missing, 0.5 * clearance, high, xtol=1e-18, rtol=1e-14)))


def load_integral(factor: float, power: float, integrate: Callable[..., tuple[float, float]]) -> float:
    """Return Sjovall's radial integral J_r of the load factor epsilon; F_r = Z Q_max J_r.

    It is the mean over the circle of the share of the most loaded element, [1 - (1 - cos psi) / 2 epsilon]^power, times
    cos(psi). `integrate` is quad of scipy.
    """
    edge = math.acos(max(1 - 2 * factor, -1.0))

    def inside(angle: float) -> float:
        return max(1 - (1 - math.cos(angle)) / (2 * factor), 0.0) ** power * math.cos(angle)

    return integrate(inside, -edge, edge)[0] / (2 * math.pi)


def _centrifugal(model: BearingModel) -> float:
    """Return the centrifugal force of each element on the outer ring [N]."""
    density = model.second.density or _STEEL_DENSITY
    volume = math.pi * model.diameter**3 / 6
    if model.length is not None:
        volume = math.pi * model.diameter**2 / 4 * model.length
    cage = 0.5 * model.speed * (1 - model.diameter / model.pitch)
    return density * volume * 0.5 * model.pitch * cage**2


def _load_sharing(model: BearingModel, shared: Sequence[float], pressed_out: float) -> tuple[str, ...]:
    """Return sentences with the figures of the load sharing."""
    highest = max(shared)
    said = [
        f"{sum(q > _UNLOADED * highest for q in shared)} of {model.count} {model.rolling}s carry; the most loaded one "
        f"{si(highest, 'N', 4)}, {highest * model.count / model.load:.3g} times the radial load over the number of "
        f"{model.rolling}s."
    ]
    if model.ball_loads is not None:
        carrying = model.ball_loads.contact_angles[model.ball_loads.loads > 0]
        least, most = (math.degrees(float(one)) for one in (carrying.min(), carrying.max()))
        said.append(
            f"Axial load {si(model.axial_load, 'N', 4)}: contact angles {least:.3g} to {most:.3g} deg, the inner ring "
            f"moves {1e6 * model.ball_loads.axial_shift:.3g} um along the axis."
        )
    if model.slices is not None:
        critical = int(model.slices.loads.max(axis=1).argmax())
        rings = f"rings tilted by {1e3 * model.tilt:.3g} mrad" if model.tilt else "rings without tilt"
        uneven = _unevenness(model.slices)[critical]
        rollers = f"{model.profile.capitalize()} rollers, {rings}"
        said.append(
            f"{rollers}: the most loaded slice of the critical roller has {uneven:.3g} times that roller's mean load "
            "per length. Pressure, film and temperatures of a contact are those of its most loaded slice; load and "
            "friction are sums over slices."
            if uneven > EVEN
            else f"{rollers}: their load is even along the length."
        )
    if pressed_out > 0.05 * highest:
        said.append(
            f"Centrifugal force presses each element outwards with {si(pressed_out, 'N')}, which is in the loads of "
            "the outer ring and not in how the radial load is shared."
        )
    return tuple(said)


def usual_ball_moment(load: float, bore: float) -> float:
    """Return the friction moment of a ball bearing by the usual estimate [N m], of the equivalent load at the bore."""
    return USUAL_BALL_FRICTION * load * 0.5 * bore
