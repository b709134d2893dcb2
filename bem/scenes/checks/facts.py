"""Contacts of a scene in one form for all kinds, for plans and checks."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import product
from typing import TYPE_CHECKING, Any

from bem.grid import Grid
from bem.materials import Body, Material, softer_hardness
from bem.quantities import si
from bem.scenes import build
from bem.scenes.axes import Axis
from bem.scenes.checks.hertz import SmoothContact, smooth_contact
from bem.scenes.checks.surfaces_of import RoughSurface, rough_surface
from bem.scenes.common import SceneModel, SmoothSurface
from bem.scenes.kind import get_kind

if TYPE_CHECKING:
    from bem.scenes.tables.wear_model import WearScenePart

_MOST_SURFACES = 24
"""Surfaces that are looked at; a sweep of variants beyond that shows no more."""


@dataclass(frozen=True)
class Case:
    """One contact of a scene; a scene with several loads, variants or spacings has several.

    Attributes
    ----------
    lower, upper : the bodies; a rigid upper one is None.
    label : which of the scene's contacts, such as "10 N"; empty where there is but one.
    grid : None where the kind has no cells over an area.
    load : on the grid [N]; None where it is not known beforehand.
    whole_load : on the whole contact beside a rough patch that repeats [N]; None of other cases.
    smooth : Hertz contact of the substrates, None for a flat.
    cap : highest pressure a cell takes [Pa]; None where elastic.
    friction : coefficient of (boundary) friction.
    depths : where stresses are wanted [m].
    width : of the cylinder along its axis [m].
    slide : how far the lower surface is moved on in a cycle [m]; None where nothing is.
    shape : "flat", "sphere", "cylinder", "ellipsoid" or "sinusoid".
    wavelength : of a sinusoid [m].
    surfaces : the scene's tables of the surfaces, by body.
    wear : of a wear loop, the parts of its model.
    """

    lower: Body
    upper: Body | None
    label: str = ""
    grid: Grid | None = None
    load: float | None = None
    whole_load: float | None = None
    smooth: SmoothContact | None = None
    cap: float | None = None
    friction: float = 0.0
    depths: tuple[float, ...] = ()
    width: float | None = None
    slide: float | None = None
    shape: str = "flat"
    wavelength: float | None = None
    surfaces: dict[str, build.AnySurface] = field(default_factory=dict)
    wear: WearScenePart | None = None

    @property
    def at(self) -> str:
        """For the end of a sentence: " (10 N)", or nothing."""
        return f" ({self.label})" if self.label else ""

    def note_place(self, key: str = "") -> str:
        """Return the place of a note on this contact: a key of the scene, and the contact's label."""
        return ", ".join(part for part in (key, self.label) if part)

    @property
    def mean_pressure(self) -> float | None:
        """Load over the grid's area [Pa]."""
        return None if self.load is None or self.grid is None else self.load / self.grid.area

    @property
    def bodies(self) -> dict[str, Body]:
        """Elastic bodies by name."""
        return {name: body for name, body in (("lower", self.lower), ("upper", self.upper)) if body is not None}

    @property
    def wearing(self) -> list[Material]:
        """Surface materials of the bodies that wear in a wear loop."""
        return [list(self.bodies.values())[body].surface_material for body in self.wearing_bodies]

    @property
    def wearing_bodies(self) -> tuple[int, ...]:
        """Bodies that wear in a wear loop: 0 the lower, 1 the upper one."""
        if self.wear is None or self.upper is None:
            return ()
        from bem.wear.setup import wearing_bodies

        return wearing_bodies((self.lower, self.upper), self.wear.wears)

    @property
    def softest(self) -> float | None:
        """The smaller hardness of the touching materials [Pa]."""
        return softer_hardness(self.lower, self.upper)


@dataclass(frozen=True)
class Facts:
    """A scene as its checks see it."""

    scene: Any
    cases: tuple[Case, ...]

    @cached_property
    def surfaces(self) -> tuple[tuple[Case, RoughSurface], ...]:
        """The rough surfaces, each once, with the first contact that has it."""
        found: dict[Any, tuple[Case, RoughSurface]] = {}
        for case in self.cases:
            for name, table in case.surfaces.items():
                key = (name, table, case.grid)
                if case.grid is None or key in found or isinstance(table, SmoothSurface):
                    continue
                if len(found) == _MOST_SURFACES:
                    break
                rough = rough_surface(name, table, case.grid, self.scene.seed)
                if rough is not None:
                    found[key] = (case, rough)
        return tuple(found.values())

    @cached_property
    def materials(self) -> dict[str, Material]:
        """Every material of the scene, by its key."""
        found: dict[str, Material] = {}
        for name in ("lower", "upper"):
            table = getattr(self.scene, name, None)
            if table is not None and table.material is not None:
                body = table.build()
                found[f"{name}.material"] = body.material
                for number, layer in enumerate(body.layers):
                    key = "layer" if table.layer is not None else f"layers[{number}]"
                    found[f"{name}.{key}.material"] = layer.material
        return found

    def worst_surfaces(self, measure: Callable[[RoughSurface], float]) -> Iterator[tuple[float, Case, RoughSurface]]:
        """For each body the surface, with its contact, whose measure is largest; none where it is not a number."""
        for name in ("lower", "upper"):
            values = [(measure(rough), case, rough) for case, rough in self.surfaces if rough.body == name]
            values = [found for found in values if not math.isnan(found[0])]
            if values:
                yield max(values, key=lambda found: found[0])

    def of_kind(self, *kinds: str) -> bool:
        """Return True if the scene is of one of these kinds."""
        return self.scene.kind in kinds


def worst(values: Iterable[tuple[float, Case]]) -> tuple[float, Case] | None:
    """The largest value with its contact."""
    return max(values, key=lambda pair: pair[0], default=None)


def examine(scene: SceneModel) -> Facts:
    """The facts of a resolved scene. Surfaces are read, generated and described when they are first asked for.

    Its cases are those of the kind's axes, each once: what differs in temperature alone is one contact. A scene of a
    kind without contacts has the facts of its materials alone.
    """
    kind = get_kind(scene.kind)
    if kind.contacts is None:
        return Facts(scene, ())
    axes = kind.axes(scene)
    found: list[tuple[tuple[int, ...], Case]] = []
    for place in product(*(range(len(axis)) for axis in axes)):
        own: Any = scene
        for axis, i in zip(axes, place, strict=True):
            own = axis.pick(own, i)
        found += [(place, case) for case in kind.contacts(own) if all(case != known for _, known in found)]
    telling = [k for k in range(len(axes)) if len({place[k] for place, _ in found}) > 1]
    several = len({case.label for _, case in found}) > 1
    cases = []
    for place, case in found:
        words = [_words(axes[k], place[k]) for k in telling] + ([case.label] if several else [])
        cases.append(replace(case, label=", ".join(words)))
    return Facts(scene, tuple(cases))


def _words(axis: Axis, i: int) -> str:
    value = axis.values[i]
    return str(value) if isinstance(value, str) else si(value, axis.si)


def bodies_of(scene: Any) -> dict[str, Any]:
    """Bodies of a scene and the tables of their surfaces, as arguments of `Case`."""
    upper = None if scene.upper.material is None else scene.upper.build()
    surfaces = {"lower": scene.lower.surface, "upper": scene.upper.surface}
    return {"lower": scene.lower.build(), "upper": upper, "surfaces": surfaces}


def dry_contacts(scene: Any, depths: tuple[float, ...] = ()) -> list[Case]:
    """Contact of two bodies on a grid without oil.

    depths : at which stresses are wanted [m].
    """
    grid, bodies, control = build.grid_of(scene.grid), bodies_of(scene), scene.contact
    return [
        Case(
            grid=grid,
            load=control.load_on(grid.area),
            smooth=scene.smooth_contact(grid.lengths),
            cap=control.hardness,
            friction=control.friction,
            depths=depths,
            shape=scene.shape.kind,
            wavelength=scene.shape.wavelength,
            **bodies,
        )
    ]


def lubricated_contacts(
    scene: Any, cap: float | None, depths: tuple[float, ...] = (), wear: WearScenePart | None = None
) -> list[Case]:
    """Contact of a cylinder, ball or ellipsoid with a flat in mixed lubrication, on the rough patch under it.

    cap : highest pressure of a cell [Pa]. depths : at which stresses are wanted [m]. wear : model of a wear loop.
    """
    grid, bodies, contact = build.grid_of(scene.grid), bodies_of(scene), scene.contact
    modulus = scene.modulus
    (load,) = contact.forces(modulus)
    cell = []
    if scene.cell_repeats:  # of the contact, and part of a flat
        cell = [Case(grid=grid, load=contact.mean_pressure(load, modulus) * grid.area, cap=cap, **bodies)]
    return [
        *cell,
        Case(
            grid=None if cell else grid,
            load=contact.on_patch(load, grid.lengths),
            whole_load=load if cell else None,
            smooth=smooth_contact(
                bodies["lower"], bodies["upper"], contact.curvature, load=load / contact.length, modulus=modulus
            ),
            cap=cap,
            friction=contact.nominal_friction(load, modulus, scene.speeds.build()[0], scene.oil.temperature),
            depths=depths,
            width=contact.width,
            slide=None if wear is None else wear.shift * grid.spacing[0],
            wear=wear,
            shape="cylinder" if contact.point_radii is None else "ellipsoid",
            **bodies,
        ),
    ]


def ball_contacts(scene: Any) -> list[Case]:
    """Smooth contact of a ball or barrel."""
    bodies = bodies_of(scene)
    force = scene.ball.force(build.modulus_of(scene))
    return [Case(smooth=smooth_contact(bodies["lower"], bodies["upper"], scene.ball.radii, load=force), **bodies)]
