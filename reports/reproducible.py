"""Stored results as rows that can be computed anew, each figure with the bar that it must come back within.

`RESULTS` is the table: a result's rows, the processor time of one of them, and why its bars have their size.
"""

from __future__ import annotations

import itertools
import json
import math
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from functools import cache, partial
from importlib import import_module
from pathlib import Path
from typing import Any

from reports.experiments import kept
from reports.experiments.judging import Experiment

Figure = tuple[str, Any, Any, float]
"""Name, stored value, value found now, and the difference allowed between numbers."""
Allowed = Callable[[str, float], float]
"""The difference allowed for a figure, from its name and its stored value."""
JUDGEMENTS = (
    "accuracy_asked", "adhesion_error_bars", "asperity_error_bars", "coating_error_bars", "contact_error_bars",
    "film_error_bars", "flow_error_bars", "heated_mixed_error_bars", "hot_mixed_error_bars", "life_error_bars",
    "march_error_bars", "mixed_ball_error_bars", "mixed_error_bars", "particle_error_bars", "point_error_bars",
    "rough_point_error_bars", "rubbing_error_bars", "running_in_error_bars", "small_contact_error_bars",
    "sticking_error_bars", "tribofilm_error_bars", "viscoelastic_error_bars", "wear_error_bars",
)  # fmt: skip
"""Modules of experiments that judge error bars."""
ROUNDING = 1e-6
"""Relative difference allowed where a figure is prescribed or has no error: solvers' tolerances are smaller."""
RUN_FLOOR = 1e-3
"""Least relative difference allowed of a figure of a run: the tolerance of load balances and contact tables."""
LOOPS = 3
"""Bar of a wear loop over the largest change by rounding that was measured of the figure."""
RESIDUAL = 1e-4
"""Relative error bar below which a bar is of the residual, which varies from run to run, and not of the grid."""
SECONDS = {
    "accuracy_asked": 20, "adhesion_error_bars": 1, "asperity_error_bars": 2, "coating_error_bars": 10,
    "contact_error_bars": 2, "film_error_bars": 1, "flow_error_bars": 4, "heated_mixed_error_bars": 5,
    "hot_mixed_error_bars": 40, "life_error_bars": 15, "march_error_bars": 15, "mixed_ball_error_bars": 10,
    "mixed_error_bars": 15, "particle_error_bars": 2, "point_error_bars": 20, "rough_point_error_bars": 40,
    "rubbing_error_bars": 8, "running_in_error_bars": 10, "small_contact_error_bars": 2, "sticking_error_bars": 60,
    "tribofilm_error_bars": 20, "viscoelastic_error_bars": 5, "wear_error_bars": 15,
}  # fmt: skip
"""Processor time of a case of each judgement, about [s]."""


@dataclass(frozen=True)
class Row:
    """A row of a stored result: its label, a function that computes it and compares, and its processor time [s]."""

    label: str
    compute: Callable[[], Iterable[Figure]]
    seconds: float

    def verdict(self) -> str:
        """Return "in", or the first figure outside its bar with both values and the bar."""
        wrong = [figure for figure in self.compute() if not inside(figure)]
        if not wrong:
            return "in"
        name, stored, found, bar = wrong[0]
        more = f", and {len(wrong) - 1} more" if len(wrong) > 1 else ""
        return f"{name} {_format_value(found)}, stored {_format_value(stored)}, bar {bar:.2g}{more}"


@dataclass(frozen=True)
class Result:
    """A stored result: its rows and the reason for the size of their bars."""

    name: str
    rows: Callable[[], Sequence[Row]]
    reason: str


def inside(figure: Figure) -> bool:
    """Return True if numbers agree within the bar and everything else is equal."""
    _, stored, found, bar = figure
    if isinstance(stored, bool) or not isinstance(stored, int | float):
        return bool(stored == found)
    if found is None or isinstance(found, str):
        return False
    return (math.isnan(stored) and math.isnan(found)) or abs(found - stored) <= bar


def _format_value(value: Any) -> str:
    return f"{value:.5g}" if isinstance(value, int | float) else str(value)


def compared(
    stored: Any, found: Any, allowed: Allowed, *, skip: Sequence[str] = (), name: str = ""
) -> Iterator[Figure]:
    """Yield the figures of nested dictionaries and lists; keys in `skip` and keys of one side alone are left out."""
    if isinstance(stored, dict) and isinstance(found, dict):
        for key in stored.keys() & found.keys():
            if key not in skip:
                yield from compared(stored[key], found[key], allowed, skip=skip, name=f"{name}.{key}".lstrip("."))
    elif isinstance(stored, list | tuple) and isinstance(found, list | tuple) and len(stored) == len(found):
        for number, (one, other) in enumerate(zip(stored, found, strict=True)):
            yield from compared(one, other, allowed, skip=skip, name=f"{name}[{number}]")
    else:
        number = isinstance(stored, int | float) and not isinstance(stored, bool)
        yield name, stored, found, allowed(name.rsplit(".")[-1].split("[")[0], float(stored)) if number else 0.0


def within(relative: float = 0.0, absolute: float = 0.0, **figures: tuple[float, float]) -> Allowed:
    """Return the rule relative * abs(value) + absolute; `figures` have (relative, absolute) of their own."""

    def allowed(name: str, value: float) -> float:
        own = figures.get(name, (relative, absolute))
        return own[0] * abs(value) + own[1]

    return allowed


# ---- judgements of error bars


@cache
def _drawn(experiment: Experiment[Any], count: int) -> list[Any]:
    return experiment.drawn(count)


def judged_case(experiment: Experiment[Any], stored: Sequence[Mapping[str, Any]]) -> Iterator[Figure]:
    """Compare value, true error and bar of every figure of a case with the stored rows.

    Value and error may move by the stored bar: both are known no better. The bar is an estimate with a safety factor
    of two and more, so that it may move by a factor of two. Without a bar the true error takes its place. Figures are
    compared by name, in whatever order they were written.
    """
    number = stored[0]["case"]
    rows = experiment.rows(_drawn(experiment, experiment.cases)[number], number)
    stored, rows = (sorted(found, key=lambda row: row["figure"]) for found in (stored, rows))
    yield "figures", [row["figure"] for row in stored], [row["figure"] for row in rows], 0.0
    for old, new in zip(stored, rows, strict=False):
        bar = max(old["error"] if old["bar"] is None else old["bar"], ROUNDING * abs(old["value"]))
        for key in ("value", "error"):
            yield f"{old['figure']} ({key})", old[key], new[key], bar
        if old["bar"] is None or new["bar"] is None:
            yield f"{old['figure']} (bar)", old["bar"], new["bar"], 0.0
        else:
            large = max(old["bar"], new["bar"])
            # a figure that is zero within its bar has a bar of the residual
            factor = 2 if abs(old["value"]) > old["bar"] else 10
            both = large <= max(factor * min(old["bar"], new["bar"]), RESIDUAL * abs(old["value"]))
            yield f"{old['figure']} (bar)", old["bar"], new["bar"], math.inf if both else 0.0


def judgement(module: str) -> Result:
    """Return the cases of a judgement of error bars."""

    def rows() -> list[Row]:
        experiment: Experiment[Any] = import_module(f"reports.experiments.{module}").EXPERIMENT
        stored = json.loads(experiment.path.read_text("utf-8"))
        experiment = replace(experiment, cases=stored["cases"], seed=stored["seed"])
        cases = itertools.groupby(stored["rows"], key=lambda row: row["case"])
        return [
            Row(f"case {number}", partial(judged_case, experiment, list(own)), SECONDS[module]) for number, own in cases
        ]

    name = "asperities_error_bars" if module == "asperity_error_bars" else module
    return Result(name, rows, "value and true error within the stored bar, the bar within a factor of two")


# ---- experiments of their own


def experiment(
    name: str,
    rows: Callable[[Any, Any], Iterable[tuple[str, Callable[[], Iterable[Figure]]]]],
    seconds: float,
    reason: str,
) -> Result:
    """Return a result whose `rows(module, stored)` yields a label and a comparison for each row."""

    def build_rows() -> list[Row]:
        module = import_module(f"reports.experiments.{name}")
        document = json.loads(kept.result_of(name).read_text("utf-8"))
        stored = document["found"] if isinstance(document, dict) and "found" in document else document
        return [Row(label, compute, seconds) for label, compute in rows(module, stored)]

    return Result(name, build_rows, reason)


Rows = Iterator[tuple[str, Callable[[], Iterable[Figure]]]]


def _again(stored: Any, compute: Callable[[], Any], allowed: Allowed, *skip: str) -> Callable[[], Iterable[Figure]]:
    """Return a comparison of a stored row with what `compute` gives."""
    return lambda: compared(stored, compute(), allowed, skip=skip)


def _contact_area(module: Any, stored: Any) -> Rows:
    allowed = within(absolute=1e-3, area=(1e-4, 0.0), counted=(0.0, 0.01), perimeter=(0.0, 5e-3))
    for surface in (*module.ASKED, *module.OTHERS):
        for load in module.LOADS:
            everything = (*stored["rows"], *stored["others"])
            own = [row for row in everything if (row["seed"], row["load"]) == (surface.seed, load)]
            compute = partial(lambda surface, load: module.rows_at(surface, surface.heights(), load), surface, load)
            yield f"seed {surface.seed}, load {load:g}", _again(own, compute, allowed)


def _contact_challenge(module: Any, stored: Any) -> Rows:
    for row in stored:
        if row["cells"] <= 512:
            # of the attraction 1e-4 is left, and cells that open or close one after the other go with rounding
            own = {name: row[name] for name in ("contact_area_fraction", "mean_gap_nm", "rms_slope")}
            compute = partial(module.one, row["cells"], row["way"])
            yield f"{row['cells']} cells a side, {row['way']}", _again(own, compute, within(relative=1e-3))


def _contact_convolutions(module: Any, stored: Any) -> Rows:
    allowed = within(absolute=2.0, share=(0.0, 1e-3))
    asked = [
        (cells, kind, share, hardness)
        for kind, hardness in (*((kind, None) for kind in module.KINDS), ("periodic", module.HARDNESS))
        for cells in module.SIZES
        for share in module.SHARES
    ]
    for given, row in zip(asked, stored, strict=True):
        capped = "" if row["hardness"] is None else ", capped"
        yield f"{given[1]}, {given[0]} cells, {given[2]:.0%}{capped}", _again(row, partial(module.row, *given), allowed)


def _film_regimes(module: Any, stored: Any) -> Rows:
    for name, row in stored["deepest"].items():
        yield name, _regime(module, row, 2000)
    for row in stored["map"]:
        yield f"M {row['M']:g}, L {row['L']:g}", _regime(module, row, 800)


def _regime(module: Any, row: Any, points: int) -> Callable[[], Iterable[Figure]]:
    bar = within(relative=row["H_half"], H_half=(0.5, 0.0), moes=(1e-9, 0.0))
    return _again(row, partial(module.row, row["M"], row["L"], points=points), bar)


def _independent_figures(module: Any, stored: Any) -> Rows:
    for row in stored["rolling"]:
        allowed = within(relative=max(row["mesh_error"], 1e-6), mesh_error=(0.5, 1e-6))
        yield (
            f"rolling, M {row['M']:g}, L {row['L']:g}",
            _again(row, partial(module.rolling_row, row["M"], row["L"]), allowed),
        )
    for name in ("self_affine", "plastic", "near_full"):
        for row in stored[name]:
            compute = partial(lambda name, p: getattr(module, f"{name}_rows")(pressures=(p,))[0], name, row["pressure"])
            allowed = within(relative=1e-4, convolutions=(0.0, 3.0), area_spread=(0.01, 0.0))
            yield f"{name}, pressure {row['pressure']:g}", _again(row, compute, allowed, "residual")


MIXED = within(
    relative=0.01,
    contact_share=(0.0, 0.01),
    share=(0.0, 0.01),
    loaded_contact_share=(0.0, 0.01),
    oil_beside_contact=(0.0, 0.01),
    film_on_contact=(0.0, 0.02),
    film_load=(0.02, 0.0),
    minimum_film=(0.03, 0.0),
    minimum=(0.05, 0.0),
)
"""Load sharing: shares to 1 % of the load, friction to 1 %, which is the median true error of `mixed_error_bars`."""


def _load_share_curves(module: Any, stored: Any) -> Rows:
    modulus = module.STEEL.plane_strain_modulus / 2
    for curve in stored:
        length, counted = curve["length_over_hertz"], curve["oil_volume"]
        for row in curve["rows"]:
            compute = partial(module.row, length, counted, row["speed"], modulus)
            yield f"{length:g} Hertz contacts, {counted}, {row['speed']:.3g} m/s", _again(row, compute, MIXED)


def _patch_length(module: Any, stored: Any) -> Rows:
    for row in stored:
        name, counted, case = row["contact"], row["oil_volume"], module.CASES[row["contact"]]
        cells = round(row["length_um"] / (1e6 * case.spacing))
        compute = partial(
            lambda name, cells, speed, counted: module.row(
                name, module.CASES[name].height(), cells, speed, module.OilVolume(counted)
            ),
            name, cells, row["speed"], counted,
        )  # fmt: skip
        yield f"{name}, {counted}, {row['speed']:g} m/s, {cells} cells", _again(row, compute, MIXED)


def _separation_datum(module: Any, stored: Any) -> Rows:
    for row in stored:
        length, pressure = row["correlation_length_um"], row["hertz_pressure_GPa"]
        compute = partial(module.row, 1e-6 * length, 1e9 * pressure)
        yield f"{length:g} um, {pressure:g} GPa", _again(row, compute, within(relative=1e-6, absolute=0.1))


def _piece_shapes(module: Any, stored: Any) -> Rows:
    for row in stored:
        compute = partial(module.row, row["load_N"], row["connectivity"])
        means = {weight: (_loop_bar(f"{weight}_mean"), 0.0) for weight in module.SHOWN_WEIGHTS}
        allowed = within(pieces=(_loop_bar("particles_per_cycle"), 0.0), **means)
        yield f"{row['load_N']:g} N, {row['connectivity']} neighbours", _again(row, compute, allowed)


def _input_coverage(module: Any, stored: Any) -> Rows:
    for name in module.CASES:
        yield name, _again(stored[name], partial(module.judged, name), within(relative=0.02, absolute=0.02))


def _stribeck_effects(module: Any, stored: Any) -> Rows:
    for contact, found in stored.items():
        for curve in found["curves"]:
            for place, speed in enumerate(curve["speeds"]):
                own = {key: [curve[key][place]] for key in ("friction", "contact_share", "minimum_film", "status")}
                compute = partial(
                    lambda contact, name, speed: module.curves(module.CONTACTS[contact], (name,), (speed,))[0],
                    contact, curve["name"], speed,
                )  # fmt: skip
                yield f"{contact}, {curve['name']}, {speed:.3g} m/s", _again(own, compute, MIXED)


def _large_contact(module: Any, stored: Any) -> Rows:
    names = ("convolutions", "status", "contact_area_fraction", "cells_in_contact", "maximum_pressure_GPa")
    for size, row in stored.items():
        if int(size) <= 2048:
            own = {name: row[name] for name in names}
            allowed = within(relative=1e-3, convolutions=(0.0, 1.0))
            yield f"{size} cells a side", _again(own, partial(module.one, int(size), 1), allowed)


def _long_ellipse(module: Any, stored: Any) -> Rows:
    grids = [(shape, (1.0, 1.0)) for shape in module.SHAPES]
    grids += [(module.SHAPES[0], further) for further in ((1.5, 1.0), (1.0, 1.3))]
    asked = [(ratio, *grid) for ratio in module.RATIOS for grid in grids]
    for given, row in zip(asked, stored, strict=True):
        bar = row["bar"] or abs(row["error"])
        allowed = within(relative=1e-6, error=(0.0, bar), bar=(0.5, 0.0))
        label = (
            f"Rx/Ry {given[0]:g}, {given[1][0]} x {given[1][1]} cells, {given[2][0]:g} and {given[2][1]:g} times as far"
        )
        yield label, _again(row, partial(module.row, *given), allowed, "cycles")


def _lumped_heat(module: Any, stored: Any) -> Rows:
    allowed = within(
        relative=1e-4, film_error=(0.0, 1e-4), traction_error=(0.0, 1e-4), rise=(1e-3, 0.01), rise_error=(1e-3, 0.01)
    )
    for row in stored:
        given = (row["M"], row["L"], row["slide_roll_ratio"])
        yield (
            "M {:g}, L {:g}, slide-roll {:g}".format(*given),
            _again(row, partial(module.row, *given), allowed, "steps"),
        )


def _friction_measured(module: Any, stored: Any) -> Rows:
    allowed = within(relative=2e-3, numerical=(1.0, 1e-4), temperature=(1e-3, 0.05))
    for row in stored["discs"]:
        given = (row["oil"], row["speed"], row["slip"], row["inlet"])
        yield "disc {}, {:g} m/s, {:g}, {:g}".format(*given), _again(row, partial(module.disc, *given), allowed)
    for base, row in stored["base_oils"].items():
        yield f"base {base}", _again(row, partial(module.base_oil, base), allowed)
    for row in stored["measured_viscosity"]:
        given = (row["oil"], row["slip"])
        label = "measured viscosity {}, {:g}".format(*given)
        yield label, _again(row, partial(module.measured_viscosity, *given), allowed)
    for row in stored["pressure_coefficient"]:
        given = (row["base"], row["alpha"])
        label = "alpha {}, {:.3g}".format(*given)
        yield label, _again(row, partial(module.pressure_coefficient, *given), allowed)
    for base, row in stored["gears"]["film"].items():
        yield f"gears {base}", _again(row, partial(module.film_loss, base), allowed)


def _hot_contacts(module: Any, stored: Any) -> Rows:
    allowed = within(relative=2e-3, traction_numerical=(0.5, 0.0), friction_numerical=(0.5, 0.0))
    for row in stored["smooth"]:
        yield f"smooth, {row['slip']:g}", _again(row, partial(module.smooth, row["slip"]), allowed)
    for row in stored["again"]:
        given = (row["oil"], row["speed"], row["slip"])
        bars = within(relative=2e-3, **dict.fromkeys(("solved_down", "solved_up"), (0.02, 0.0)))
        yield "again {}, {:g} m/s, {:g}".format(*given), _again(row, partial(module.again, *given), bars)


def _traction_measured(module: Any, stored: Any) -> Rows:
    allowed = within(relative=2e-3, numerical=(1.0, 1e-4), temperature=(1e-3, 0.05), fitted=(2e-3, 0.0))
    for row in stored:
        given = (row["oil"], row["slip"], row["inlet"])
        yield "{}, {:g}, {:g}".format(*given), _again(row, partial(module.traction, *given), allowed)


def _bearing_measured(module: Any, stored: Any) -> Rows:
    allowed = within(relative=2e-3, numerical=(1.0, 10.0))
    for row in stored["torque"]:
        given = (row["radial"], row["speed"], row["temperature"])
        yield "{:g} N, {:g} rpm, {:g} degC".format(*given), _again(row, partial(module.torque, *given), allowed)
    for row in stored["starved"]:
        yield f"starved, {row['speed']:g} rpm", _again(row, partial(module.starved, row["speed"]), allowed)


def _film_measured(module: Any, stored: Any) -> Rows:
    allowed = within(relative=2e-3, numerical=(0.5, 1e-3), down=(0.1, 0.0), up=(0.1, 0.0))
    for row in stored["waves"]:
        given = (row["wavelength"], row["amplitude"])
        bars = within(relative=2e-3, numerical=(0.5, 1e-3), ours=(2e-3, row["numerical"]))
        yield "wave {:g}, height {:g}".format(*given), _again(row, partial(module.line_wave, *given), bars)
    yield "point wave", _again(stored["point_wave"], module.point_wave, allowed)
    for row in stored["transverse"]:
        given = (row["alpha"], row["film"])
        # the speed is sought to 0.1 %
        bars = within(relative=5e-3, numerical=(0.5, 0.0), down=(0.1, 0.0), up=(0.1, 0.0))
        yield f"transverse, alpha {row['alpha']:.3g}", _again(row, partial(module.transverse_row, *given), bars)
    for row in stored["rolling"]:
        given = (row["M"], row["L"])
        bars = within(relative=2e-3, numerical=(0.5, 1e-12))
        yield "rolling, M {:g}, L {:g}".format(*given), _again(row, partial(module.rolling, *given), bars)
    for row in stored["dimples"]:
        given = (row["kind"], row["place"])
        bars = within(relative=2e-3, numerical=(0.5, 0.5))
        yield f"dimple, {row['kind']}, {row['place']}", _again(row, partial(module.dimple_row, *given), bars)


def _pitting_measured(module: Any, stored: Any) -> Rows:
    for row in stored["smooth"]:
        compute = partial(module.smooth, row["criterion"])
        yield f"smooth, {row['criterion']}", _again(row, compute, within(relative=1e-3))
    for row in stored["pairs"]:
        given = tuple(row[name] for name in ("roller", "disc", "elongation", "body", "reading"))
        label = "roller {:g}, disc {:g}, elongation {:g}, {}, {}".format(*given)
        yield label, _again(row, partial(module.pair, *given), within(absolute=0.02))


def _point_films(module: Any, stored: Any) -> Rows:
    names = ("cells", "status", "maximum_pressure_GPa")
    for number, row in enumerate(stored["contacts"]):
        own = {name: row[name] for name in names if name in row}
        given = (row["load"], row["oil"], row["ratio"], math.radians(row["angle_deg"]))
        compute = partial(lambda given, one: module.tried(*given, module.Cavitation(one)), given, row["cavitation"])
        yield f"contact {number}", _again(own, compute, within(relative=0.01, absolute=1e-3))


def _point_table(module: Any, stored: Any) -> Rows:
    for row in stored["contacts"]:
        given = (row["load"], row["oil"], row["ratio"])
        own = {name: row[name] for name in ("status", *module.NAMES)}
        bars = {name: (1e-2 * (row[f"{name}_bar"] or 2.0), 0.0) for name in module.NAMES}
        yield "M {:g}, L {:g}, Rx/Ry {:g}".format(*given), _again(own, partial(module.contact, *given), within(**bars))


def _preconditioned_spectrum(module: Any, stored: Any) -> Rows:
    for given, row in zip(module.CASES, stored, strict=True):
        label = f"{given[0]}, {given[1]} cells, {given[2]:.0%}"
        yield label, _again(row, partial(module.row, *given), within(relative=0.02))


def _random_contacts(module: Any, stored: Any) -> Rows:
    for number, count in enumerate(stored["counts"]):
        compute = partial(lambda number: module.found(1, module.FIRST + number)["counts"][0], number)
        yield f"contact {number}", _again(count, compute, within(relative=0.3, absolute=3.0))


def _rough_films(module: Any, stored: Any) -> Rows:
    for case in stored["cases"]:
        if case["contact"] != "line":
            continue
        for place, points in enumerate(module.LINE_POINTS):
            own = [row["films"][place] for row in case["rows"]]
            compute = partial(module.line_figures, case["wavelength"], case["speed"], points)
            yield (
                f"ridges of {case['wavelength']:g}, {case['speed']:g} m/s, {points} points",
                _again(own, compute, within(relative=0.01, share=(0.0, 0.01))),
            )


def _slip_beside_aspher(module: Any, stored: Any) -> Rows:
    for row in stored:
        allowed = within(absolute=1e-3, convolutions=(0.0, 2.0))
        compute = partial(module.ours, row["cells"])
        yield f"{row['cells']} cells (bem)", _again(row["bem"], compute, allowed, "cpu", "residual")


def _starved_point(module: Any, stored: Any) -> Rows:
    for row in stored:
        given = (row["M"], row["L"], (row["share"],))
        allowed = within(relative=1e-6, reduction=(row["bar"] or 0.02, 0.0), bar=(0.5, 0.0))
        label = f"M {row['M']:g}, L {row['L']:g}, layer {row['share']:g}"
        yield label, _again(row, partial(lambda given: next(module.rows_of(*given)), given), allowed, "cycles")


def _touching_cells(module: Any, stored: Any) -> Rows:
    for film in stored["films"]:
        for row in film["rows"]:
            bars = {name: (0.01, row[f"{name}_bar"] or 0.0) for name in ("share", "area", "mean")}
            own = {name: row[name] for name in ("status", "minimum", "friction", "opening", *bars)}
            compute = partial(module.row, film["speed"], film["least_film"], row["cells"])
            label = f"{film['speed']:g} m/s, {1e9 * film['least_film']:g} nm, {row['cells']} cells"
            yield label, _again(own, compute, within(relative=0.01, **bars))


def _touching_films(module: Any, stored: Any) -> Rows:
    for surface, case in zip(module.SURFACES, stored["cases"], strict=True):
        for ratio, row in zip(module.LAMBDAS, case["rows"], strict=True):
            bars = {name: (1e-3, bar or 0.0) for name, bar in row["bars"].items()}

            def compute(row: Any = row, bars: Any = bars, surface: Any = surface, ratio: float = ratio) -> list[Figure]:
                found = module.row(surface, ratio)
                film = compared(row["film"], found["film"], within(relative=0.01, **bars), skip=("residual",))
                return [*film, *compared(row["loaded"], found["loaded"], MIXED, name="load sharing")]

            yield f"{surface.name} {1e9 * surface.rms:g} nm, lambda {ratio:g}", compute


def _tribofilm_hardness(module: Any, stored: Any) -> Rows:
    def fit() -> dict[str, Any]:
        table = module.growth_table()
        return {
            "factor_on_the_whole_curve": module.fit(table, module.SLOPE),
            "factor_on_the_film": module.fit(table, 0.0),
        }

    yield "both fits", _again(stored, fit, within(relative=0.01))


def _waviness_reduction(module: Any, stored: Any) -> Rows:
    allowed = within(absolute=2e-3, scaled_wavelength=(1e-3, 0.0))
    for name, cases, solve in (
        ("lines", module.LINE_CASES, module.of_line),
        ("points", module.POINT_CASES, module.of_point),
    ):
        for case in cases:
            own = [row for row in stored[name] if (row["load"], row["oil"]) == case[:2]]
            yield f"{name}, M {case[0]:g}, L {case[1]:g}", _again(own, partial(solve, *case), allowed)
    yield "march", _again(stored["march"], partial(module.marched, *module.MARCHED), allowed)


def _wave_ripples(module: Any, stored: Any) -> Rows:
    allowed = within(relative=0.02, absolute=0.01)
    for case, row in zip(module.cases_of(*next(iter(module.JUDGED.items()))), stored["judged"], strict=True):
        yield f"surfaces {case['seed']:g}", _again(row, partial(module.compared, case), allowed, "seconds")


def _wave_sharing(module: Any, stored: Any) -> Rows:
    allowed = within(relative=0.02, absolute=2e-3)
    for case, row in zip(module.moving_cases(), stored["moving"], strict=True):
        yield f"surfaces {case['seed']:g}", _again(row, partial(module.of_moving, case), allowed)
    for case, row in zip(module.cases_at_rest(), stored["at rest"], strict=True):
        label = f"{row['surface']} ({case[0] + 1}), lambda {row['lambda']:g}"
        yield label, _again(row, partial(module.of_rest, *case), allowed)
    for case, row in zip(module.ridges(), stored["ridges"], strict=True):
        label = f"ridges of {row['wavelength']:g}, {row['speed']:g} m/s, lambda {row['lambda']:g}"
        yield label, _again(row, partial(module.of_ridges, *case), allowed)


def _wear_lengths(module: Any, stored: Any) -> Rows:
    names = {
        "particles_per_cycle": "particles_per_cycle",
        "wear_rate": "criterion_wear_rate",
        "rms_height": "Sq_final",
        "number_equivalent_radius": "number_mean_equivalent_radius",
        "volume_equivalent_radius": "volume_mean_equivalent_radius",
    }
    relative = {name: max(0.01, _loop_bar(figure)) for name, figure in names.items()}
    cases = {(case.group, case.value): case for case in module.cases()}
    for row in stored["rows"]:
        key = (row["criterion"], row["group"], row["value"])
        alike = [one for one in stored["rows"] if (one["criterion"], one["group"], one["value"]) == key]
        bars = {}
        for name in names:
            values = [one[name] for one in alike if one[name] is not None]
            bars[name] = (relative[name], max(values) - min(values) if values else 0.0)
        own = {name: row[name] for name in names}
        compute = partial(module.run, cases[key[1:]], row["criterion"], row["seed"])
        yield f"{', '.join(key)}, seed {row['seed']}", _again(own, compute, within(**bars))


def _line_film() -> list[Row]:
    """Rows of the table over M and L, which `reports.benchmarks.line_film` makes."""
    from reports.benchmarks.line_film import film_row, read_table

    allowed = within(relative=1e-4, order_minimum=(0.0, 0.05), order_central=(0.0, 0.05))
    names = ("minimum", "central", "order_minimum", "order_central")
    rows = []
    for stored in read_table(kept.RESULTS / "line_film.csv"):
        own = {name: getattr(stored, name) for name in names}
        compute = partial(lambda load, piezo: asdict(film_row(load, piezo)), stored.load, stored.piezo)
        rows.append(Row(f"M {stored.load:g}, L {stored.piezo:g}", _again(own, compute, allowed), 3))
    return rows


# ---- runs of the validation report


def _run_row(job: Any) -> Row | None:
    """Return a stored run as a row; None where it is not stored or its surfaces are files of the user.

    A scene with several repetitions runs the first one alone, which is compared with the stored first repetition.
    """
    from bem.runs import plan_scene
    from bem.scenes.planner import machine_rate
    from reports.experiments.wear_rounding import first_repetition_only
    from reports.validation_renewal import lacks_files

    if lacks_files(job) or not job.target.exists():
        return None
    stored = json.loads(job.target.read_text("utf-8"))
    settings = first_repetition_only(job.settings, stored)
    seconds = plan_scene(job.scene, settings)[1].seconds(machine_rate())
    return Row(job.name, partial(_run_figures, job.scene, settings, stored), seconds)


def _summary(scene: str, settings: Sequence[str]) -> Mapping[str, Any]:
    from bem.runs import run_scene

    with tempfile.TemporaryDirectory() as folder:
        return run_scene(scene, Path(folder) / "run", settings=settings, figures=False, workers=1).summary


def _run_figures(scene: str, settings: Sequence[str], stored: Mapping[str, Any]) -> Iterator[Figure]:
    found = _summary(scene, settings)
    yield "status", stored["status"], found["status"], 0.0
    for name in (key.removesuffix("_error") for key in stored if key.endswith("_error")):
        if name not in stored or name not in found:
            continue
        values = first_repetition(stored, name)
        scatter, error = stored.get(f"{name}_spread"), stored[f"{name}_error"]
        floor = max(RUN_FLOOR, LOOPS * _loop_changes().get((stored["kind"], name), 0.0))
        for place, (one, now) in enumerate(zip(_listed(values), _listed(found[name]), strict=False)):
            parts = [part[place] if isinstance(part, list) else part for part in (scatter, error)]
            bar = max([part for part in parts if part is not None], default=0.0)
            if one is not None:
                yield f"{name}[{place}]", one, now, max(bar, floor * abs(one))


@cache
def _loop_changes() -> dict[tuple[str, str], float]:
    """Return the largest relative change of a figure of wear loops by rounding, by kind and figure."""
    from reports.experiments import wear_rounding

    return wear_rounding.largest(kept.found("wear_rounding"))


def _loop_bar(figures: str) -> float:
    """Return the relative bar of wear figures whose names begin so."""
    return LOOPS * max(
        change for (kind, name), change in _loop_changes().items() if kind == "wear" and name.startswith(figures)
    )


def _wear_rounding(module: Any, stored: Any) -> Rows:
    largest = module.largest(stored)
    for row in stored:
        bars = {name: (0.0, max(RUN_FLOOR, LOOPS * largest[row["kind"], name])) for name in row["changes"]}
        yield row["run"], _again(row, partial(module.row, row["run"]), within(**bars))


def _listed(value: Any) -> list[Any]:
    return value if isinstance(value, list) else [value]


def first_repetition(summary: Mapping[str, Any], name: str) -> Any:
    """Return a figure of the first repetition; a list over the cases of the scene.

    Scenes of friction have a list over speeds for each repetition, others a list over repetitions for each case.
    """
    each, value = summary.get(f"{name}_each"), summary[name]
    if each is None:
        return value
    if not isinstance(value, list) or summary["kind"] == "friction":
        return each[0]
    return [case[0] for case in each]


def validation_rows() -> list[Row]:
    """Return every stored run of the validation report and of the experiments that its remarks quote."""
    from reports.validation_renewal import jobs

    return [row for row in map(_run_row, jobs().values()) if row is not None]


_COUNTS = "counts of convolutions within the round or two that round-off moves them by"
_MIXED = "shares within 1 % of the load, friction within 1 %, the median true error of `mixed_error_bars`"
RESULTS: dict[str, Result] = {
    result.name: result
    for result in (
        *map(judgement, JUDGEMENTS),
        experiment("contact_area", _contact_area, 60, "area within 1e-4, its errors within 1e-3"),
        experiment("contact_challenge", _contact_challenge, 5, "1e-3, ten times the tolerance of the attraction"),
        experiment("contact_convolutions", _contact_convolutions, 10, _COUNTS),
        experiment("film_regimes", _film_regimes, 1, "the difference to half the points"),
        experiment("bearing_measured", _bearing_measured, 4, "2e-3, ten times what half the points change"),
        experiment("film_measured", _film_measured, 20, "2e-3 besides the difference between meshes"),
        experiment("friction_measured", _friction_measured, 5, "2e-3, ten times what half the points change"),
        experiment("hot_contacts", _hot_contacts, 15, "2e-3, as of friction_measured"),
        experiment(
            "independent_figures", _independent_figures, 20, "the difference to half the points; area within 1e-4"
        ),
        experiment("input_coverage", _input_coverage, 10, "2 % of a deviation, and 0.02 of the draws: four of 200"),
        experiment("large_contact", _large_contact, 20, _COUNTS + "; figures within 1e-3, the tolerance being 1e-6"),
        experiment("load_share_curves", _load_share_curves, 4, _MIXED),
        experiment("long_ellipse", _long_ellipse, 10, "the film's own error bar"),
        experiment("lumped_heat", _lumped_heat, 6, "1e-4 of a film or a friction, ten times Newton's tolerance"),
        experiment("patch_length", _patch_length, 6, _MIXED),
        experiment("piece_shapes", _piece_shapes, 15, "three times what rounding moves wear loops by"),
        experiment("pitting_measured", _pitting_measured, 8, "0.02 of the surface, what a few drawn ridges decide"),
        experiment("point_films", _point_films, 4, "status and grid equal, pressure within 1 % of so few cells"),
        experiment("point_table", _point_table, 40, "the film's own error bar on the finest grid"),
        experiment("preconditioned_spectrum", _preconditioned_spectrum, 5, "2 %, what one cell at the edge changes"),
        experiment("random_contacts", _random_contacts, 0.3, _COUNTS + ", or 30 %"),
        experiment("rough_films", _rough_films, 60, "1 %, less than grids differ by; where films end is equal"),
        experiment("separation_datum", _separation_datum, 3, "0.1 of a per cent, the last digit that a remark quotes"),
        experiment("slip_beside_aspher", _slip_beside_aspher, 1, _COUNTS + "; the part that sticks within 1e-3"),
        experiment("starved_point", _starved_point, 15, "the film's own error bar"),
        experiment("stribeck_effects", _stribeck_effects, 10, _MIXED),
        experiment("touching_cells", _touching_cells, 10, "the film's own error bar and 1 %"),
        experiment("touching_films", _touching_films, 15, "the film's own error bars; load sharing: " + _MIXED),
        experiment("traction_measured", _traction_measured, 2, "2e-3, as of friction_measured"),
        experiment("tribofilm_hardness", _tribofilm_hardness, 120, "1 %, less than either bound is known to"),
        experiment("waviness_reduction", _waviness_reduction, 60, "2e-3, the difference between grids"),
        experiment("wave_ripples", _wave_ripples, 90, "2 % of a ripple, less than the march is off"),
        experiment("wave_sharing", _wave_sharing, 5, "2 % or 2e-3, less than the shares are off"),
        experiment("wear_lengths", _wear_lengths, 20, "the scatter over the three pairs of surfaces and by rounding"),
        Result("line_film", _line_film, "1e-4 of a film, of which five digits are stored; orders within 0.05"),
        experiment("wear_rounding", _wear_rounding, 40, "three times the largest change over all runs, or 0.1 %"),
        Result(
            "validation",
            validation_rows,
            "scatter over repetitions or error bar, at least 0.1 % and three times what rounding moves wear loops by",
        ),
    )
}
"""Every result that can be computed anew, by name."""
