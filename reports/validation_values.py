"""Our numbers for the validation report: kept summaries of full-size runs, and what a line of the report holds."""

from __future__ import annotations

import itertools
import json
import math
import statistics
import tomllib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, cast

from bem import Material, contact_modulus
from bem.particles import particle_coefficient
from bem.scenes import PlainContext
from bem.scenes.build import heights_of, modulus_of
from bem.scenes.load import load_scene
from bem.surfaces import SurfaceDescription, describe_surface
from reports.builder import HERE
from reports.validation_origin import stale

if TYPE_CHECKING:
    from bem.kinds.wear.scene import WearScene

STORED = HERE / "results" / "validation"
EXPERIMENTS = HERE / "results" / "experiments"
Summary = dict[str, Any]


@dataclass(frozen=True)
class Value:
    """One of our numbers: mean over repetitions, and their standard deviation where there are several."""

    mean: float
    spread: float | None = None

    def __str__(self) -> str:
        if not math.isfinite(self.mean):
            return "none"
        shown = f"{self.mean:.3g}" if abs(self.mean) < 1000 else f"{self.mean:.0f}"
        if not self.spread or self.spread < 1e-9 * abs(self.mean):  # of what was put in: round-off
            return shown
        return f"{shown} ± {self.spread:.2g}" if self.spread < 99.5 else f"{shown} ± {self.spread:.0f}"


@dataclass(frozen=True)
class Rule:
    """What we get for a line, whether that agrees, and the stored numbers its remark quotes."""

    ours: Callable[[Summary], str]
    agrees: Callable[[Summary], bool | None]
    quoted: Callable[[Summary], str] = lambda summary: ""


BASES = ("input", "calibrated", "by construction")
"""What a line rests on that is shown and not counted: on a number put in, on one that a constant was fitted to or a
choice was made by, or on the form of the model, from which the statement follows whatever its constants are."""


@dataclass(frozen=True)
class Check:
    """A line of the table: what the source says, what is accepted and by what right, our rule, and a remark.

    basis : one of `BASES`, or empty for a line that is judged and counted. A line by construction or
        calibrated that does not hold is judged all the same.
    run : name of the experiment whose result is judged; empty for that of the built-in scene.

    What a remark quotes of ours stands in the place it leaves, `{quoted}`.
    """

    item: str
    scene: str
    source: str
    rule: Rule
    accepted: str
    remark: str = ""
    basis: str = ""
    run: str = ""

    def summary(self) -> Summary:
        """Return the stored result that the line is held against.

        Raises
        ------
        FileNotFoundError : it was not run.
        """
        return experiment(self.run) if self.run else stored(self.scene)


SLIGHT = (747 * 541 * 145 / (600 * 476 * 129)) ** (1 / 3)
"""What the source calls a slight increase: by its AFM the size of steel particles rises by 1.17 from 2.5 to 10 N."""
READING = 0.05
"""What can be read from a curve that is only plotted, of its height."""


def at(summary: Summary, key: str, index: int | None = None) -> Value:
    """A figure of a summary and its spread; `index` into lists over loads, speeds, temperatures or variants."""
    value, spread = summary.get(key), summary.get(f"{key}_spread")
    if isinstance(value, list):
        value = value[index or 0]
        spread = spread[index or 0] if isinstance(spread, list) else None
    return Value(float("nan") if value is None else float(value), spread)


def echo(summary: Summary) -> None:
    """No verdict: the line repeats what was put in."""


def within(value: Value, low: float, high: float) -> bool:
    """Return True if the mean lies in a range; our own spread does not widen it."""
    return low <= value.mean <= high


def near(value: Value, wanted: float, factor: float = SLIGHT) -> bool:
    """Return True if the mean lies within a factor of what the source says."""
    return within(value, wanted / factor, wanted * factor)


def row_of(summary: Summary, key: str, wanted: float) -> int:
    """Index of the run whose `key` (a list) is `wanted`.

    Raises
    ------
    LookupError : the scene has no such run; the nearest one says nothing of it.
    """
    values = summary[key] if isinstance(summary[key], list) else [summary[key]]
    for index, value in enumerate(values):
        if math.isclose(value, wanted, rel_tol=1e-6):  # a thousandth of what scenes write out
            return index
    raise LookupError(f"{summary.get('scene')}: no run of {key} = {wanted:g}; there are {values}")


def at_speed(summary: Summary, key: str, metres_per_second: float) -> Value:
    """A figure at a speed; between two speeds of the scene on the line over log speed, with the larger spread.

    Raises
    ------
    LookupError : the speed lies outside those of the scene.
    """
    speeds = summary["speed_m_s"]
    exact = [i for i, v in enumerate(speeds) if math.isclose(v, metres_per_second, rel_tol=1e-6)]
    if exact:
        return at(summary, key, exact[0])
    upper = next((i for i, v in enumerate(speeds) if v > metres_per_second), 0)
    if upper == 0:
        raise LookupError(f"{summary.get('scene')}: {metres_per_second:g} m/s outside {speeds[0]:g} to {speeds[-1]:g}")
    low, high = at(summary, key, upper - 1), at(summary, key, upper)
    share = math.log(metres_per_second / speeds[upper - 1]) / math.log(speeds[upper] / speeds[upper - 1])
    return Value(low.mean + share * (high.mean - low.mean), max(low.spread or 0.0, high.spread or 0.0) or None)


def speed(metres_per_second: float) -> Callable[[Summary], int]:
    """Index of a speed."""
    return lambda summary: row_of(summary, "speed_m_s", metres_per_second)


def drop(summary: Summary, metres_per_second: float) -> float:
    """Initial less run-in friction at a speed."""
    index = speed(metres_per_second)(summary)
    return at(summary, "friction_initial", index).mean - at(summary, "friction_run_in", index).mean


def sizes(index_of: Callable[[Summary], int]) -> Callable[[Summary], str]:
    """Length / width / thickness by volume at one load."""

    def show(summary: Summary) -> str:
        parts = [at(summary, f"particle_{q}_nm", index_of(summary)) for q in ("length", "width", "thickness")]
        return " / ".join(str(part) for part in parts)

    return show


def load(newtons: float) -> Callable[[Summary], int]:
    """Index of a load."""
    return lambda summary: row_of(summary, "load_N", newtons)


def near_sizes(newtons: float, length: float, width: float, thickness: float) -> Callable[[Summary], bool]:
    """Each of the three apart from the source's by less than a change that it calls slight."""

    def judge(summary: Summary) -> bool:
        index = load(newtons)(summary)
        return all(
            near(at(summary, f"particle_{q}_nm", index), wanted)
            for q, wanted in (("length", length), ("width", width), ("thickness", thickness))
        )

    return judge


def radius(newtons: float) -> Callable[[Summary], str]:
    """Volume-mean radius at a load."""
    return lambda summary: str(at(summary, "particle_equivalent_radius_nm", load(newtons)(summary)))


def radii(summary: Summary) -> list[Value]:
    """Reported radius of every run of a scene."""
    count = len(summary["load_N"]) if isinstance(summary["load_N"], list) else 1
    return [at(summary, "particle_equivalent_radius_nm", i) for i in range(count)]


WEIGHTS = {"number": "by number", "area": "by area", "volume": "by volume", "scattering": "by light scattering"}
"""Means of a radius and their words: by light scattering it is the z-average, sum R^6 / sum R^5 (ISO 22412)."""


def radii_by(summary: Summary, weight: str) -> list[Value]:
    """Mean radius of one weight of every run of a wear scene."""
    count = len(summary["load_N"]) if isinstance(summary["load_N"], list) else 1
    return [at(summary, f"{weight}_mean_equivalent_radius_nm", i) for i in range(count)]


def four_radii(summary: Summary) -> str:
    """Mean radii of every run of a wear scene, by each weight."""
    return "; ".join(f"{listed(radii_by(summary, weight))} {words}" for weight, words in WEIGHTS.items())


def mean_of(values: Sequence[float | None]) -> float:
    """Mean of the values that are there."""
    found = [value for value in values if value is not None]
    return sum(found) / len(found) if found else math.nan


def cycles_of(summary: Summary, key: str, index: int = 0) -> list[float | None] | None:
    """A figure over the cycles of one run; None where the result was kept without its cycles."""
    rows = summary.get(key)
    return None if rows is None else rows[index]


def listed(values: Sequence[Value]) -> str:
    """Values side by side."""
    return ", ".join(str(v) for v in values)


def mesh_means(weight: str) -> Callable[[Summary], str]:
    """Mean radius of one weight over the meshes of the convergence scene."""
    return lambda s: ", ".join(
        f"{at(s, f'{weight}_mean_equivalent_radius_nm', i).mean:.0f}" for i in range(len(s["variant"]))
    )


def last_change(summary: Summary, weight: str) -> float:
    """Relative change of a mean radius from 240 to 320 cells."""
    values = [at(summary, f"{weight}_mean_equivalent_radius_nm", i).mean for i in (2, 3)]
    return abs(values[1] / values[0] - 1)


def unchanged(values: Sequence[Value], factor: float = SLIGHT) -> bool:
    """Return True if the largest lies within a factor of the smallest."""
    return max(v.mean for v in values) < factor * min(v.mean for v in values)


def falling(values: Sequence[Value]) -> bool:
    """Return True if each value is less than the one before."""
    return all(a.mean > b.mean for a, b in itertools.pairwise(values))


def settled_by_mesh(weight: str) -> Callable[[Summary], bool]:
    """Return True if a mean changes by no more than can be read from the source's curve, from 240 to 320 cells."""
    return lambda summary: last_change(summary, weight) < READING


def converges_by_mesh(weight: str) -> Callable[[Summary], bool]:
    """Return True if a mean falls from mesh to mesh up to 320 cells, and is settled there."""
    return lambda summary: settled_by_mesh(weight)(summary) and falling(radii_by(summary, weight)[:4])


def plateau_from(cycles: Sequence[float | None], settled: int = 50, factor: float = 1 + READING) -> int | None:
    """Cycle from which the mean radius of ten cycles stays within a factor of that of the last `settled`.

    None where it never does before the last `settled` cycles, which are what it is measured by.
    """
    means = [
        sum(found) / len(found) if (found := [v for v in cycles[i : i + 10] if v is not None]) else math.nan
        for i in range(0, len(cycles), 10)
    ]
    last = means[-(settled // 10) :]
    level = sum(last) / len(last)
    early = means[: -(settled // 10)]
    outside = [i for i, mean in enumerate(early) if not level / factor <= mean <= level * factor]
    start = outside[-1] + 1 if outside else 0
    return None if start == len(early) else 10 * start


def over_runs(key: str) -> Callable[[Summary], str]:
    """A list of a summary, value after value."""
    return lambda summary: listed([at(summary, key, i) for i in range(len(summary[key]))])


def largest_drop(summary: Summary) -> float:
    """Speed [m/s] at which friction falls most by running-in."""
    return max((drop(summary, v), v) for v in summary["speed_m_s"])[1]


def clear_minimum(summary: Summary) -> bool:
    """Return True if run-in friction is least inside the range of hardness, and both ends are above it by more than
    spread."""
    friction, spread = summary["friction_run_in"], summary["friction_run_in_spread"]
    least = min(range(len(friction)), key=friction.__getitem__)
    return all(friction[end] > friction[least] + max(spread[end], spread[least]) for end in (0, -1))


def criterion_over_archard(summary: Summary, newtons: float, wear_rate: float, shift: int = 3) -> float:
    """Wear per load and distance of the yield criterion, over a measured specific wear rate [mm^3/(N m)].

    A cycle slides `shift` cells; the grid, 240 cells wide, carries its share of the load on 6 mm.
    """
    index = load(newtons)(summary)
    cell = 1e-9 * at(summary, "cell_nm", index).mean
    volume = 1e-9 * at(summary, "worn_volume_per_cycle_um3", index).mean
    share = newtons * 240 * cell / 6e-3
    return volume / (share * shift * cell) / wear_rate


def particles_per_mm_and_newton(summary: Summary, newtons: float, wear_rate: float) -> float:
    """Measured specific wear rate [mm^3/(N m)] over our mean particle volume."""
    index = load(newtons)(summary)
    volume = at(summary, "worn_volume_per_cycle_um3", index).mean / at(summary, "particles_per_cycle", index).mean
    return 1e-3 * particle_coefficient(1e-9 * wear_rate, 1e-18 * volume)


def steel_modulus() -> float:
    """E* of steel on steel [Pa]: 2 E* is the thesis' 231 GPa."""
    steel = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3)
    return contact_modulus(steel, steel)


def hertz_pressure(newtons: float) -> float:
    """Largest pressure [GPa] of the cylinder, 2 mm by 6 mm, on steel; Johnson (1985), eq. 4.45."""
    return 1e-9 * math.sqrt(newtons / 6e-3 * steel_modulus() / (math.pi * 2e-3))


def surface_statistics(scene: str, body: str) -> SurfaceDescription:
    """Statistics of the first generated surface of a body of a built-in wear scene, on its grid at its largest load."""
    model = cast("WearScene", load_scene(scene))
    cylinder = model.cylinder.model_copy(update={"loads": [max(model.cylinder.loads)]})
    grid, _ = model.domain.at(cylinder, modulus_of(model))
    surface = (model.lower if body == "lower" else model.upper).surface
    heights = heights_of(surface, grid, PlainContext(scene_seed=model.seed).seed(body, 0))
    return describe_surface(heights, grid.spacing, periodic=grid.periodic)


def statistics_line(description: SurfaceDescription) -> str:
    """Sq, skewness, kurtosis and slope, as the source lists them."""
    return f"{1e9 * description.Sq:.0f} nm, {description.Ssk:.2f}, {description.Sku:.2f}, {description.Sdq:.2f}"


def ratio_of_means(summary: Summary, newtons: float, one: str, other: str) -> float:
    """Ratio of two means of a summary at a load."""
    index = load(newtons)(summary)
    return at(summary, one, index).mean / at(summary, other, index).mean


def curve(summary: Summary, **wanted: Any) -> Summary:
    """The friction curve of a summary with that load, variant or model."""
    return next(c for c in summary["curves"] if all(c[key] == value for key, value in wanted.items()))


def signed_difference(summary: Summary, one: Summary) -> float:
    """Largest difference, uncoupled less coupled, over uncoupled friction at its speed [%]; `one` is coupled."""
    other = curve(
        summary,
        load_N=one["load_N"],
        variant=one["variant"],
        model={"capped": "uncoupled", "elastic": "uncoupled_elastic"}[one["model"]],
    )
    pairs = list(zip(one["friction"], other["friction"], strict=True))
    coupled, alone = max(pairs, key=lambda pair: abs(pair[1] - pair[0]))
    return 100 * (alone - coupled) / alone


def elastic_curves(summary: Summary, variant: str) -> list[Summary]:
    """The coupled elastic curves of one surface, load after load."""
    curves = [c for c in summary["curves"] if c["variant"] == variant and c["model"] == "elastic"]
    return sorted(curves, key=lambda c: float(c["load_N"]))


def differences(summary: Summary, variant: str) -> list[float]:
    """Signed largest differences of the elastic curves of one surface, load after load [%]."""
    return [signed_difference(summary, one) for one in elastic_curves(summary, variant)]


def difference_spread(summary: Summary, one: Summary) -> float:
    """Deviation over repetitions of the signed largest difference, each at the speed of its own maximum [%]."""
    other = curve(summary, load_N=one["load_N"], variant=one["variant"], model="uncoupled_elastic")
    found = []
    for coupled, alone in zip(one["friction_each"], other["friction_each"], strict=True):
        pair = max(zip(coupled, alone, strict=True), key=lambda pair: abs(pair[1] - pair[0]))
        found.append(100 * (pair[1] - pair[0]) / pair[1])
    return statistics.stdev(found)


def differences_with_spread(summary: Summary, variant: str) -> list[Value]:
    """Signed largest differences of the elastic curves of one surface and their deviation, load after load [%]."""
    curves = elastic_curves(summary, variant)
    return [Value(signed_difference(summary, one), difference_spread(summary, one)) for one in curves]


def stored(scene: str) -> Summary:
    """The kept summary of a scene.

    Raises
    ------
    FileNotFoundError : the scene was not run at full size.
    """
    found: Summary = json.loads((STORED / f"{scene}.json").read_text())
    return found


def experiments() -> list[dict[str, Any]]:
    """The runs that remarks quote: name, built-in scene, settings."""
    text = (HERE / "experiments" / "runs.toml").read_text("utf-8")
    return list(tomllib.loads(text)["run"])


def experiment(name: str) -> Summary:
    """The kept result of an experiment.

    Raises
    ------
    FileNotFoundError : it was not run.
    """
    found: Summary = json.loads((EXPERIMENTS / f"{name}.json").read_text("utf-8"))
    return found


def quoted(show: Callable[[Summary], str], runs: dict[str, str]) -> Callable[[Summary], str]:
    """For a remark: what experiments show, by name, each with what was done there; says which were not run or stale."""

    def words(summary: Summary) -> str:
        parts, aged = [], 0
        for name, done in runs.items():
            try:
                found = experiment(name)
            except FileNotFoundError:
                parts.append(f"not run {done}")
                continue
            parts.append(f"{show(found)} {done}")
            aged += bool(stale(found["scene"], found))
        return "; ".join(parts) + (f" ({aged} of {len(runs)} stale)" if aged else "")

    return words
