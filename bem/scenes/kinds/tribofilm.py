"""Kind `tribofilm`: a film that grows under stress and heat, wears, and takes substrate with it (thesis, paper E).

One scene runs over its loads, temperatures and variants; each is one film.
"""

from __future__ import annotations

from functools import partial
from itertools import pairwise
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from bem.errors import InfeasibleError
from bem.grid import Grid
from bem.materials import contact_modulus
from bem.scenes import build
from bem.scenes.common import (
    BodyScene,
    Force,
    GridScene,
    PositiveLength,
    PositivePressure,
    SceneModel,
    ShapeScene,
    Table,
    problem,
)
from bem.scenes.context import Context, Outcome, Variable
from bem.scenes.kinds import Kind
from bem.scenes.planner import Plan, Step, convolution_memory, layered_kernel_seconds, padded_points
from bem.scenes.units import Energy, InverseLength, Length, Rate, Ratio, Speed, Temperature, Time, Volume

_CONVOLUTIONS = 14  # of one warm-started contact, coarse levels included
_CONTACTS = 50  # solved per film: the table is refined only as far as the film gets
_ZERO_CELSIUS = 273.15


class ConstantProperty(Table):
    """The same at every thickness and temperature."""

    kind: Literal["constant"] = "constant"
    value: PositivePressure


class FadingProperty(Table):
    """Falls from the substrate's value to the film's own with thickness; see `bem.tribofilm.FadingSubstrate`."""

    kind: Literal["fading_substrate"] = "fading_substrate"
    substrate: PositivePressure
    film: PositivePressure
    length: PositiveLength
    temperature_slope: Ratio = 0.0  # per kelvin
    reference_temperature: Annotated[Temperature, Field(gt=0)] = 298.15


class TableProperty(Table):
    """Points of a curve over thickness, and of a factor over temperature."""

    kind: Literal["table"] = "table"
    thickness: Annotated[list[Annotated[Length, Field(ge=0)]], Field(min_length=1, max_length=1000)]
    value: Annotated[list[PositivePressure], Field(min_length=1, max_length=1000)]
    temperature: list[Annotated[Temperature, Field(gt=0)]] = [298.15]  # noqa: RUF012
    factor: list[Annotated[Ratio, Field(gt=0)]] = [1.0]  # noqa: RUF012

    @model_validator(mode="after")
    def _rising(self) -> TableProperty:
        for name, other in (("thickness", "value"), ("temperature", "factor")):
            x, y = getattr(self, name), getattr(self, other)
            if len(x) != len(y) or any(b <= a for a, b in pairwise(x)):
                raise problem(f"{name} and {other} do not make a curve", f"as many of both, {name} rising")
        return self


PropertyScene = Annotated[ConstantProperty | FadingProperty | TableProperty, Field(discriminator="kind")]


class FilmScene(Table):
    """The film: kinetics, properties, wear."""

    prefactor: Annotated[Speed, Field(gt=0)] = 1e-2
    activation_energy: Annotated[Energy, Field(gt=0)]
    activation_volume: Annotated[Volume, Field(ge=0)]
    hardness: PropertyScene
    youngs_modulus: PropertyScene
    poissons_ratio: Annotated[Ratio, Field(gt=-1, lt=0.5)] = 0.3
    wear_coefficient: Annotated[Rate, Field(ge=0)]
    lag: Annotated[Time, Field(ge=0)] = 0.0
    concentration_constant: Annotated[InverseLength, Field(gt=0)] | None = None
    initial_thickness: Annotated[Length, Field(ge=0)] = 0.0
    average: Literal["contact", "nominal"] = "contact"
    feedback: Literal["mean", "local"] = "mean"
    local_tolerance: Annotated[Ratio, Field(gt=0, lt=1)] = 1e-2


class VariantScene(Table):
    """A film that differs from the scene's in what is given here."""

    name: Annotated[str, Field(min_length=1, max_length=60)]
    wear_coefficient: Annotated[Rate, Field(ge=0)] | None = None
    lag: Annotated[Time, Field(ge=0)] | None = None
    activation_volume: Annotated[Volume, Field(ge=0)] | None = None
    activation_energy: Annotated[Energy, Field(gt=0)] | None = None


class RubbingScene(Table):
    """Loads, temperatures and how long; `cycle` converts cycles to time for figures against cycles."""

    loads: Annotated[list[Annotated[Force, Field(gt=0)]], Field(min_length=1, max_length=64)]
    temperatures: Annotated[list[Annotated[Temperature, Field(gt=0)]], Field(min_length=1, max_length=64)]
    friction: Annotated[Ratio, Field(ge=0, le=2)] = 0.1
    duration: Annotated[Time, Field(gt=0)]
    points: Annotated[int, Field(strict=True, ge=2, le=100_000)] = 241
    report: tuple[Annotated[Time, Field(ge=0)], Annotated[Time, Field(ge=0)]] | None = None
    cycle: Annotated[Time, Field(gt=0)] | None = None

    @model_validator(mode="after")
    def _within(self) -> RubbingScene:
        if self.report is not None and not self.report[0] < self.report[1] <= self.duration:
            raise problem(f"report {self.report} s", "two times, the second later and not after duration")
        return self


class TribofilmScene(SceneModel):
    """A film on the lower body, under a rough, capped, layered contact."""

    kind: Literal["tribofilm"] = "tribofilm"
    grid: GridScene
    lower: BodyScene
    upper: BodyScene
    shape: ShapeScene = ShapeScene()
    rubbing: RubbingScene
    film: FilmScene
    variants: list[VariantScene] = []  # noqa: RUF012
    reuse_tolerance: Annotated[Ratio, Field(ge=0, lt=1)] = 2e-3
    repetitions: Annotated[int, Field(strict=True, ge=1, le=1000)] = 1

    @model_validator(mode="after")
    def _delay_needs_the_mean(self) -> TribofilmScene:
        if self.film.feedback == "local" and (self.film.lag > 0 or any(v.lag for v in self.variants)):
            raise problem("a lag with local feedback", 'lag with film.feedback = "mean", or no lag')
        return self

    @model_validator(mode="after")
    def _film_is_the_layer(self) -> TribofilmScene:
        if self.lower.layer is not None or self.upper.layer is not None:
            raise problem("a body has a layer of its own", "bodies without a layer: the film is the layer")
        return self


def resolve(scene: TribofilmScene) -> TribofilmScene:
    """Fill in the grid where measured surfaces decide it."""
    grid = build.resolved_grid(scene.grid, scene.lower.surface, scene.upper.surface)
    return scene.model_copy(update={"grid": grid})


def films(scene: TribofilmScene) -> list[dict[str, Any]]:
    """What is run, in the order of the summary: loads, then temperatures, then variants, then repetitions."""
    variants = scene.variants or [VariantScene(name="film")]
    return [
        {"load": load, "temperature": temperature, "variant": variant, "repetition": repetition}
        for load in scene.rubbing.loads
        for temperature in scene.rubbing.temperatures
        for variant in variants
        for repetition in range(scene.repetitions)
    ]


def plan(scene: TribofilmScene) -> Plan:
    """What will be computed.

    Raises
    ------
    InfeasibleError : a load that the film cannot carry on the grid where it is softest.
    """
    grid = build.grid_of(scene.grid)
    build.check_surfaces(grid, lower=scene.lower.surface, upper=scene.upper.surface)
    _check_loads(scene, grid)
    count = len(films(scene))
    points = padded_points(grid.shape, grid.periodic)
    stiff = scene.film.youngs_modulus
    same = isinstance(stiff, ConstantProperty) and stiff.value == scene.lower.build().material.youngs_modulus
    return Plan(
        (
            Step("surfaces", "heights of both bodies", transforms=40, points=grid.cells, memory=8.0 * grid.cells * 8),
            Step(
                "layered kernels",
                "one thickness per contact that is solved" if not same else "the film is as stiff as what it grows on",
                # closed forms where the grid is doubly periodic; elsewhere a quarter of the first one, as measured
                seconds=0.0 if all(grid.periodic) else 0.25 * layered_kernel_seconds(grid.cells) * _CONTACTS * count,
                memory=8.0 * points / 4,
            ),
            Step(
                "contact",
                f"about {_CONTACTS} for each of {count} films, from the last pressure",
                transforms=2.0 * _CONVOLUTIONS * _CONTACTS * count,
                points=points,
                memory=convolution_memory(grid.shape, grid.periodic) + 16.0 * grid.cells * _CONTACTS,
            ),
            Step(
                "contacts at other times",
                f"growth follows thickness alone: it is interpolated to {scene.reuse_tolerance:g}",
                skipped=scene.reuse_tolerance > 0,
            ),
            Step("tangential kernels", "shear stress is friction times pressure", skipped=True),
            Step(
                "balance of growth and wear",
                "implicit integration with error control, lag by lag",
                seconds=0.25 * count + 3e-3 * _lags(scene),
            ),
            Step("figures and report", "pictures of the results", seconds=4.0, memory=2e8),
        )
    )


def _lags(scene: TribofilmScene) -> float:
    """Lags in all films together, which are integrated one by one."""
    return sum(scene.rubbing.duration / lag for film in films(scene) if (lag := _chosen(scene, film, "lag")) > 0)


def _chosen(scene: TribofilmScene, film: dict[str, Any], key: str) -> Any:
    """What the film's variant says, or else the scene."""
    value = getattr(film["variant"], key)
    return getattr(scene.film, key) if value is None else value


def _check_loads(scene: TribofilmScene, grid: Grid) -> None:
    """Refuse loads beyond the softest hardness that a film can get times the grid's area, before any work.

    A film is never thicker than it would be at its fastest growth: initial thickness + growth x time, and without a lag
    no thicker than where wear balances that. Contacts are solved up to twice as thick.
    """
    from bem.tribofilm import StressActivatedGrowth

    hardness = property_of(scene.film.hardness)
    other = None if scene.upper.material is None else scene.upper.material.hardness
    messages = []
    for film in films(scene):
        temperature, load = film["temperature"], film["load"]
        energy, volume = _chosen(scene, film, "activation_energy"), _chosen(scene, film, "activation_volume")
        # at any thickness the pressure is at most the hardest that the film ever is
        stress = scene.rubbing.friction * hardness.highest(temperature)
        fastest = float(StressActivatedGrowth(scene.film.prefactor, energy, volume).rate(stress, temperature))
        thickest = scene.film.initial_thickness + fastest * scene.rubbing.duration
        wear = _chosen(scene, film, "wear_coefficient")
        if wear > 0 and not _chosen(scene, film, "lag") > 0:
            thickest = min(thickest, max(scene.film.initial_thickness, fastest / wear))
        softest = hardness.lowest(2 * thickest, temperature)
        limit = (softest if other is None else min(softest, other)) * grid.area
        if load > limit:
            messages.append(
                f"rubbing.loads: {load:g} N is beyond the softest film's hardness x area of the grid, {limit:.4g} N at "
                f"{temperature - _ZERO_CELSIUS:.4g} degC; allowed: a smaller load, a larger grid or a harder film"
            )
    if messages:
        raise InfeasibleError(list(dict.fromkeys(messages)))


def property_of(scene: Any) -> Any:
    """As a callable of `bem.tribofilm.properties`."""
    from bem.tribofilm import Constant, FadingSubstrate
    from bem.tribofilm import Table as Curve

    if isinstance(scene, ConstantProperty):
        return Constant(scene.value)
    if isinstance(scene, FadingProperty):
        return FadingSubstrate(
            scene.substrate, scene.film, scene.length, scene.temperature_slope, scene.reference_temperature
        )
    return Curve.from_lists(scene.thickness, scene.value, scene.temperature, scene.factor)


def run(scene: TribofilmScene, context: Context) -> Outcome:
    """All films, one after the other; a finished one is never computed again."""
    from bem.tribofilm import FilmContact, StressActivatedGrowth, grow_tribofilm

    grid = build.grid_of(scene.grid)
    wanted = films(scene)
    saved = context.saved()
    finished: list[dict[str, Any]] = list(saved["finished"]) if saved is not None else []
    times = np.linspace(0.0, scene.rubbing.duration, scene.rubbing.points)
    if scene.rubbing.report is not None:
        times = np.unique(np.concatenate([times, scene.rubbing.report]))
    shape = build.shape_of(scene.shape, grid)
    for index, film in enumerate(wanted):
        if index < len(finished):
            continue
        with context.timer("surfaces"):
            heights = sum(
                build.heights_of(body.surface, grid, context.seed(name, film["repetition"]), context.note)
                for name, body in (("lower", scene.lower), ("upper", scene.upper))
            )
        own, chosen = scene.film, partial(_chosen, scene, film)
        contact = FilmContact(
            gap=shape - heights,
            grid=grid,
            substrate=scene.lower.build().material,
            counterface=scene.upper.build().material,
            load=film["load"],
            growth=StressActivatedGrowth(own.prefactor, chosen("activation_energy"), chosen("activation_volume")),
            hardness=property_of(own.hardness),
            modulus=property_of(own.youngs_modulus),
            temperature=film["temperature"],
            poissons_ratio=own.poissons_ratio,
            friction=scene.rubbing.friction,
            average=own.average,
            nominal_area=_nominal_area(scene, grid, film["load"]),
        )
        if own.feedback == "local":
            finished.append(_local_record(scene, film, contact, times, chosen, context))
            context.save({"finished": finished})
            context.progress(1000 * (index + 1), 1000 * len(wanted), "films")
            continue
        solved = 0

        def watch(sample: Any, index: int = index) -> None:
            nonlocal solved
            solved += 1
            part = min(solved / _CONTACTS, 0.95)
            context.progress(
                round(1000 * (index + part)), 1000 * len(wanted), "films", thickness_nm=1e9 * sample.thickness
            )

        with context.timer("films"):
            grown = grow_tribofilm(
                times,
                contact,
                wear_coefficient=chosen("wear_coefficient"),
                lag=chosen("lag"),
                concentration_constant=own.concentration_constant or np.inf,
                initial_thickness=own.initial_thickness,
                reuse_tolerance=scene.reuse_tolerance,
                callback=watch,
            )
        finished.append(_record(scene, film, grown))
        context.save({"finished": finished})
        context.progress(1000 * (index + 1), 1000 * len(wanted), "films")
    return _outcome(scene, grid, times, finished)


def _nominal_area(scene: TribofilmScene, grid: Grid, load: float) -> NDArray[np.float64] | None:
    """Cells inside the smooth Hertz contact of a ball; the whole grid for other shapes."""
    if scene.film.average != "nominal" or scene.shape.kind != "sphere" or scene.shape.radius is None:
        return None
    modulus = contact_modulus(scene.lower.build().material, scene.upper.build().material)
    radius = (3 * load * scene.shape.radius / (4 * modulus)) ** (1 / 3)  # Johnson (1985), eq. 4.22
    return (np.hypot(grid.x[:, None], grid.y[None, :]) <= radius).astype(np.float64)


def _record(scene: TribofilmScene, film: dict[str, Any], grown: Any) -> dict[str, Any]:
    history = grown.history
    last = min(grown.contacts, key=lambda s: abs(s.thickness - history.thickness[-1]))
    report = scene.rubbing.report
    return {
        "load": film["load"],
        "temperature": film["temperature"],
        "variant": film["variant"].name,
        "repetition": film["repetition"],
        "thickness": history.thickness,
        "grown": history.grown,
        "worn": history.worn,
        "substrate_wear": history.substrate_wear,
        "growth_rate": history.growth_rate,
        "wear_rate": history.wear_rate,
        "concentration": history.concentration,
        "wear_depth": None if report is None else grown.wear_depth(*report),
        "steady": None if np.isinf(grown.steady) else grown.steady,
        "contacts": len(grown.contacts),
        "sample_thickness": np.array([s.thickness for s in grown.contacts]),
        "sample_mean_pressure": np.array([s.mean_pressure for s in grown.contacts]),
        "sample_hardness": np.array([s.hardness for s in grown.contacts]),
        "sample_growth": np.array([s.growth for s in grown.contacts]),
        "sample_contact_area": np.array([s.contact_area for s in grown.contacts]),
        "film_map": grown.film_map,
        "pressure": last.pressure,
    }


def _local_record(
    scene: TribofilmScene,
    film: dict[str, Any],
    contact: Any,
    times: NDArray[np.float64],
    chosen: Any,
    context: Context,
) -> dict[str, Any]:
    """A film with local feedback, in the shape of `_record`."""
    from bem.tribofilm import grow_local_film

    samples: list[Any] = []
    with context.timer("films"):
        grown = grow_local_film(
            times,
            contact,
            wear_coefficient=chosen("wear_coefficient"),
            concentration_constant=scene.film.concentration_constant or np.inf,
            initial_thickness=scene.film.initial_thickness,
            tolerance=scene.film.local_tolerance,
            callback=lambda now, sample: samples.append(sample),
        )
    constant = scene.film.concentration_constant
    report = scene.rubbing.report
    depth = None if report is None else float(np.diff(np.interp(report, times, grown.substrate_wear))[0])
    return {
        "load": film["load"],
        "temperature": film["temperature"],
        "variant": film["variant"].name,
        "repetition": film["repetition"],
        "thickness": grown.thickness,
        "grown": grown.grown,
        "worn": grown.worn,
        "substrate_wear": grown.substrate_wear,
        "growth_rate": np.gradient(grown.grown, times),
        "wear_rate": chosen("wear_coefficient") * grown.thickness,
        "concentration": np.zeros_like(times) if constant is None else np.exp(-constant * grown.thickness),
        "wear_depth": depth,
        "steady": None,
        "contacts": grown.contacts,
        "sample_thickness": np.array([s.thickness for s in samples]),
        "sample_mean_pressure": np.array([s.mean_pressure for s in samples]),
        "sample_hardness": np.array([s.hardness for s in samples]),
        "sample_growth": np.array([s.growth for s in samples]),
        "sample_contact_area": np.array([s.contact_area for s in samples]),
        "film_map": grown.film_map,
        "pressure": grown.pressure,
    }


def _outcome(scene: TribofilmScene, grid: Grid, times: NDArray[np.float64], finished: list[dict[str, Any]]) -> Outcome:
    groups: list[list[dict[str, Any]]] = [
        finished[start : start + scene.repetitions] for start in range(0, len(finished), scene.repetitions)
    ]

    def over(figure: Any) -> Any:
        """One value per load, temperature and variant: the mean over repetitions; a list where there are several."""
        values = []
        for group in groups:
            found = [figure(record) for record in group]
            values.append(None if any(v is None for v in found) else float(np.mean(found)))
        return values[0] if len(values) == 1 else values

    first = [group[0] for group in groups]
    several = len(groups) > 1
    summary: dict[str, Any] = {
        "temperature_C": [r["temperature"] - _ZERO_CELSIUS for r in first]
        if several
        else first[0]["temperature"] - _ZERO_CELSIUS,
        "load_N": [r["load"] for r in first] if several else first[0]["load"],
        "variant": [r["variant"] for r in first] if several else first[0]["variant"],
        "film_thickness_nm": over(lambda r: 1e9 * r["thickness"][-1]),
        "largest_thickness_nm": over(lambda r: 1e9 * r["thickness"].max()),
        "film_wear_rate_nm_s": over(lambda r: 1e9 * r["wear_rate"][-1]),
        "wear_depth_nm": over(lambda r: None if r["wear_depth"] is None else 1e9 * r["wear_depth"]),
        "total_wear_depth_nm": over(lambda r: 1e9 * r["substrate_wear"][-1]),
        "concentration": over(lambda r: r["concentration"][-1]),
        "steady_thickness_nm": over(lambda r: None if r["steady"] is None else 1e9 * r["steady"]),
        "contacts_solved": over(lambda r: r["contacts"]),
        "repetitions": scene.repetitions,
        "cycle_s": scene.rubbing.cycle,
    }
    if scene.repetitions > 1:
        for key, quantity in (("film_thickness_nm", "thickness"), ("wear_depth_nm", "wear_depth")):
            spreads = []
            for group in groups:
                found = [r[quantity] if quantity == "wear_depth" else r[quantity][-1] for r in group]
                spreads.append(None if any(v is None for v in found) else 1e9 * float(np.std(found, ddof=1)))
            summary[f"{key}_spread"] = spreads if several else spreads[0]

    def stacked(name: str) -> NDArray[np.float64]:
        return np.stack([record[name] for record in finished])

    variables = {
        "time": Variable(("time",), times, "s", "time of rubbing"),
        "load": Variable(("film",), np.array([r["load"] for r in finished]), "N", "load"),
        "temperature": Variable(("film",), np.array([r["temperature"] for r in finished]), "K", "temperature"),
        "variant": Variable(("film",), np.array([r["variant"] for r in finished]), "1", "variant"),
        "repetition": Variable(("film",), np.array([r["repetition"] for r in finished]), "1", "repetition"),
        "x": Variable(("x",), grid.x, "m", "x, along sliding"),
        "y": Variable(("y",), grid.y, "m", "y"),
        "film_map": Variable(("film", "x", "y"), stacked("film_map"), "m", "local film thickness at the end"),
        "film_pressure": Variable(("film", "x", "y"), stacked("pressure"), "Pa", "contact pressure at the end"),
    }
    for name, unit, text in (
        ("thickness", "m", "mean film thickness"),
        ("grown", "m", "film grown so far"),
        ("worn", "m", "film worn so far"),
        ("substrate_wear", "m", "depth of substrate worn"),
        ("growth_rate", "m/s", "growth rate of the film"),
        ("wear_rate", "m/s", "wear rate of the film"),
        ("concentration", "1", "concentration of substrate at the surface of the film"),
    ):
        variables[name] = Variable(("film", "time"), stacked(name), unit, text)
    counts = [record["contacts"] for record in finished]
    variables["sample_film"] = Variable(
        ("sample",), np.repeat(np.arange(len(finished)), counts), "1", "film that a solved contact belongs to"
    )
    for name, unit, text in (
        ("thickness", "m", "film thickness"),
        ("mean_pressure", "Pa", "mean contact pressure"),
        ("hardness", "Pa", "hardness"),
        ("growth", "m/s", "growth rate"),
        ("contact_area", "m^2", "contact area"),
    ):
        values = np.concatenate([record[f"sample_{name}"] for record in finished])
        variables[f"sample_{name}"] = Variable(("sample",), values, unit, f"{text} of a solved contact")
    return Outcome(summary, variables)


KIND = Kind(
    name="tribofilm",
    title="a tribofilm that grows under stress and heat, wears, and takes substrate with it",
    model=TribofilmScene,
    plan=plan,
    run=run,
    resolve=resolve,
    figures=(
        "film-thickness",
        "film-wear-rate",
        "substrate-wear",
        "substrate-concentration",
        "film-pressure-over-thickness",
        "film-map",
        "film-pressure-map",
    ),
    headline=(
        "temperature_C",
        "film_thickness_nm",
        "film_wear_rate_nm_s",
        "wear_depth_nm",
        "concentration",
        "steady_thickness_nm",
        "contacts_solved",
    ),
)
