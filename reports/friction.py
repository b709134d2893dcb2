"""The page "Friction and films against measurements": published, ours, both uncertainties, inside or not, with sources.

Ours are stored in `reports/results/friction_measured.json` (`reports.experiments.friction_measured`); the measurements
stand here, each with how it was read. No constant of an oil is fitted to them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from bem.lubrication.oils.catalogue import bases
from bem.lubrication.rheology import rheology_of
from reports import published
from reports.builder import COLOURS, Page, Section, figure, table, text
from reports.experiments.friction_measured import viscosity_at_pressure
from reports.experiments.kept import age, found
from reports.measurement import MOST, Row
from reports.prose import prose

if TYPE_CHECKING:
    from matplotlib.figure import Figure

NAME = "friction_measured"
HEADERS = ("what", "published", "ours", "scatter", "numerical", "inside", "value inside", "source", "remark")
FORMULA_ERROR = 0.005
"""Within which the formula of Arana et al. (2019) has the coefficients that Mann measured, as they say."""
TESTED = 60.0
"""Temperature at which that formula was tested [degC]."""
THROUGH_FORMULA = ("mann", "clarke", "schlenk")
"""Sources whose measurements are known by a formula that describes them."""
AT_LIMIT = 0.89
"""Mean shear stress over limit from which a contact counts as at its limit."""
ROELANDS_HEADERS = (
    "oil", "degC", "alpha measured (1/GPa)", "alpha ours", "ln(mu/mu0) at 1 GPa, measured", "ours",
    "viscosity over measured",
)  # fmt: skip
FROM_SUMMARY = ("doleschel", "santotrac", "vengudusamy", "rounds", "yilmaz")
"""Sources of which a summary, an abstract or a sentence quoted by others was read."""
DISC_OILS = ("N100", "M100", "PAO100")
"""Oils of Mann's discs."""
CONSTANTS = {
    "shear_stress_limit": ("Eyring stress, `shear_stress_limit` (MPa)", 1e6),
    "limiting_shear_coefficient": ("limiting shear coefficient (-)", 1.0),
    "limiting_shear_softening": ("fall of the limit with temperature (1/K)", 1.0),
    "ambient_shear_strength": ("limiting stress at ambient pressure (MPa)", 1e6),
}
"""Name with unit, and unit, of the constants of a base."""
HOT = "hot_contacts"
"""Stored result of the smooth hot contact, the scatter solved again and the scatter of the ball."""
DISC_CAPTION = (
    "Computed coefficients over those of the formula, all rows of the table; bars: scatter of the oil, and 0.005, "
    "which is assumed at 40, 80 and 100 degC."
)
BASE_NAMES = {"mineral": "mineral oil", "pao": "PAO", "ester": "ester", "pag": "polyglycol"}


def rows(stored: Mapping[str, Any]) -> list[Row]:
    """All published values, from the stored result of the experiment on oils; those of films are read here."""
    oils = (_gear_rows(stored), _disc_rows(stored["discs"]), _base_rows(stored["base_oils"]), _trend_rows(stored))
    sources = prose("friction")["sources"]
    return [
        replace(row, assumed=row.assumed or sources[row.source].get("assumed", False))
        for part in (*oils, *published.rows())
        for row in part
    ]


def _ratio(one: Mapping[str, float], other: Mapping[str, float]) -> tuple[float, float, float, float]:
    """Ratio of two coefficients with scatter down and up, of independent oils, and numerical error."""
    ratio = one["coefficient"] / other["coefficient"]
    down = ratio * math.hypot(one["down"] / one["coefficient"], other["up"] / other["coefficient"])
    up = ratio * math.hypot(one["up"] / one["coefficient"], other["down"] / other["coefficient"])
    numerical = ratio * math.hypot(
        one.get("numerical", 0.0) / one["coefficient"], other.get("numerical", 0.0) / other["coefficient"]
    )
    return ratio, down, up, numerical


def _gear_rows(stored: Mapping[str, Any]) -> Iterator[Row]:
    """The FZG-C gear pair, film and asperities sharing the load; then Schlenk's formula, by power."""
    group, words = "gears", prose("friction")["remarks"]
    mixed, film = stored["gears"]["mixed"], stored["gears"]["film"]
    one = mixed["mineral"]
    yield Row(
        group,
        "mean coefficient, mineral oil",
        0.040,
        0.050,
        one["coefficient"],
        one["down"],
        one["up"],
        one["numerical"],
        "doleschel",
        words["gear_mineral"],
        assumed=True,
    )
    for base in ("pag", "ester"):
        ratio = _ratio(mixed[base], one)
        yield Row(
            group,
            f"{BASE_NAMES[base]} over mineral oil",
            0.6,
            1.0,
            *ratio,
            "doleschel",
            words[f"gear_{base}"],
            assumed=base == "pag",
        )
    slid = film["mineral"]["sliding_power"]
    schlenk = {"mineral": 425.0, "pao": 340.0, "ester": 340.0, "pag": 313.0}
    for base, power in schlenk.items():
        own = mixed[base]
        values = (slid * own[key] for key in ("coefficient", "down", "up", "numerical"))
        yield Row(
            group, f"power loss, {BASE_NAMES[base]} (W)", 0.8 * power, 1.2 * power, *values, "schlenk", words["schlenk"]
        )


def _disc_rows(stored: list[dict[str, Any]]) -> Iterator[Row]:
    """Mann's discs."""
    words = prose("friction")["remarks"]
    for row in stored:
        measured, tested = row["formula"], row["inlet"] == TESTED
        what = f"{row['oil']}, {row['speed']:g} m/s, slide/roll {row['slip']:g}, {row['inlet']:g} degC"
        yield Row(
            "discs",
            what,
            measured - FORMULA_ERROR,
            measured + FORMULA_ERROR,
            row["coefficient"],
            row["down"],
            row["up"],
            row["numerical"],
            "mann",
            _disc_remark(row) if tested else words["mann_temperature"],
            assumed=not tested,
            apart=not tested,
        )


def _disc_remark(row: Mapping[str, Any]) -> str:
    """Why the value of a disc is off; the viscosity that was measured was tried at 4 m/s only."""
    if abs(row["coefficient"] - row["formula"]) <= FORMULA_ERROR:
        return ""
    return str(prose("friction")["remarks"].get(row["oil"] if row["speed"] == 4 else f"{row['oil']}_elsewhere", ""))


def _base_rows(stored: Mapping[str, Any]) -> Iterator[Row]:
    """Bases of oil beside mineral oil in twin discs, film alone."""
    group, words, mineral = "bases", prose("friction")["remarks"], stored["mineral"]
    for base, low, high, source in (
        ("pag", 0.2, 1.0, "doleschel"),
        ("ester", 0.3, 1.0, "doleschel"),
        ("pao", 0.0, 1.0, "doleschel"),
        ("naphthenic", 1.0, MOST, "rounds"),
        ("traction", 1.0, MOST, "santotrac"),
    ):
        name = BASE_NAMES.get(base, f"{base} fluid" if base == "traction" else f"{base} oil")
        remark = words.get(base, words["disc_conditions"])
        values = _ratio(stored[base], mineral)
        yield Row(
            group,
            f"{name} over mineral oil",
            low,
            high,
            *values,
            source,
            remark,
            assumed=base in ("pag", "traction"),
            apart=base == "traction",
        )
    water = stored["water-glycol"]
    values = (water[key] for key in ("coefficient", "down", "up", "numerical"))
    yield Row(group, "coefficient, fluid with water", 0.0, 0.01, *values, "yilmaz", words["water"])
    others = [stored[base] for base in ("mineral", "naphthenic", "pao", "ester")]
    ratio = _ratio(stored["pag"], min(others, key=lambda one: one["coefficient"]))
    yield Row(group, "polyglycol over the lowest other oil", 0.0, 1.0, *ratio, "rounds")


def _trend_rows(stored: Mapping[str, Any]) -> Iterator[Row]:
    """Statements of which the sense is measured."""
    words, trends = prose("friction")["remarks"], stored["trends"]
    for base, low, high in (("pag", AT_LIMIT, 1.0), ("mineral", 0.0, AT_LIMIT), ("pao", 0.0, AT_LIMIT)):
        share, remark = trends["at_limit"][base], words["below_limit" if base == "pag" else "at_limit"]
        what = f"stress over limit, {BASE_NAMES[base]}"
        yield Row("trends", what, low, high, share, 0.0, 0.0, 0.01, "vengudusamy", remark, assumed=True, most=1.0)
    pressure, speed = trends["traction_pressure"], trends["traction_speed"]
    rise, fall = pressure["2"] / pressure["1"], speed["50"] / speed["5"]
    yield Row("trends", "peak traction at 2 GPa over that at 1 GPa", 1.0, MOST, rise, 0.0, 0.0, 0.01, "santotrac")
    yield Row("trends", "peak traction at 50 m/s over that at 5 m/s", 0.0, 1.0, fall, 0.0, 0.0, 0.01, "santotrac")


def verdict(shown: list[Row]) -> str:
    """The head of the page: how many measured and computed values, from how many sources, and the shares inside."""
    apart = [row for row in shown if row.apart]
    measured, computed = ([row for row in shown if row.computed is kind and not row.apart] for kind in (False, True))
    sources, fitted = len({row.source for row in shown}), sum(row.source in THROUGH_FORMULA for row in measured)
    told = sum(row.source in FROM_SUMMARY for row in measured)
    sided = [row for row in measured if row.one_sided]
    oils = {oil: [row for row in measured if row.group == "discs" and row.what.startswith(oil)] for oil in DISC_OILS}
    by_oil = ", ".join(f"{oil} {sum(row.inside for row in own)} of {len(own)}" for oil, own in oils.items())
    by_value = ", ".join(f"{oil} {sum(row.middle_inside for row in own)}" for oil, own in oils.items())
    return (
        f"{len(shown)} published values from {sources} sources. Of {len(measured)} measured ones {_counts(measured)}. "
        f"{fitted} of the measured ones are known by a formula that describes the measurement, {told} from a summary, "
        f"an abstract or a sentence quoted by others. {len(sided)} have an interval with one side, from "
        f"zero, or to the largest possible value, which is easily met ({sum(row.inside for row in sided)} inside). "
        f"Twin discs inside by oil: {by_oil}; by our value alone: {by_value}. "
        f"Of {len(computed)} values that others computed {_counts(computed)}. "
        f"{len(apart)} values, marked (apart) on the page, are counted apart as formulas or fitted curves beyond what "
        f"their tests are known to cover, a standard, a fluid above another by its purpose, or a film that our grid "
        f"does not resolve: {_counts(apart)}. The uncertainty "
        f"of {sum(row.assumed for row in shown)} values is assumed here (marked * on the page). No constant is fitted "
        "to the values; which rows share constants with their sources is said under How to read this."
    )


def _counts(shown: list[Row]) -> str:
    inside, middle = (sum(getattr(row, name) for row in shown) for name in ("inside", "middle_inside"))
    return (
        f"{inside} ({inside / len(shown):.0%}) are inside both uncertainties, {middle} ({middle / len(shown):.0%}) "
        "have our value inside theirs alone"
    )


def _scatter(own: list[Row]) -> str:
    """The least and the largest scatter of a table over its values."""
    parts = [part / row.ours for row in own for part in (row.down, row.up) if row.down or row.up]
    return f" The scatter is {min(parts):.1%} to {max(parts):.0%} of ours." if parts else ""


def build() -> Page:
    """The page, from the stored result."""
    stored, words = found(NAME), prose("friction")
    measured = rows(stored)
    sections = [Section("How to read this", "".join(text(one) for one in words["reading"]))]
    for group, title in words["groups"].items():
        own = [row for row in measured if row.group == group]
        inside, apart = (sum(getattr(row, name) for row in own) for name in ("inside", "apart"))
        counted = f"; {apart} of the {len(own)} {'is' if apart == 1 else 'are'} counted apart" if apart else ""
        share = f"{inside} of {len(own)} are inside both uncertainties{counted}.{_scatter(own)}"
        body = text(words["introductions"][group]) + text(share)
        if group == "discs":
            body += figure(_drawing(own), DISC_CAPTION)
        sections.append(Section(title, body + table(HEADERS, map(_cells, own))))
    hot = found(HOT)
    sections += [_missed(stored), *published.sections(), _ball(stored, hot), _checks(hot), _constants(), _sources()]
    return Page("friction", "Friction and films against measurements", verdict(measured), sections)


def _cells(row: Row) -> tuple[Any, ...]:
    """A row of the tables."""
    digits = next((count for count in (3, 4, 5) if _as_shown(row, count) == row.middle_inside), 6)
    high = "" if math.isinf(row.high) else f" to {_short(row.high, digits)}"
    marks = f"{' *' if row.assumed else ''}{' (apart)' if row.apart else ''}"
    published_range = f"{'above ' if math.isinf(row.high) else ''}{_short(row.low, digits)}{high}{marks}"
    scatter = f"-{_short(row.down, 2)} +{_short(row.up, 2)}" if row.down or row.up else "-"
    numerical = _short(row.numerical, 1) if row.numerical else "-"
    source = prose("friction")["sources"][row.source]["short"]
    verdicts = ("yes" if row.inside else "no", "yes" if row.middle_inside else "no")
    return row.what, published_range, _short(row.ours, digits), scatter, numerical, *verdicts, source, row.remark


def _as_shown(row: Row, digits: int) -> bool:
    """Return True if our value is within the interval by the figures that so many digits show."""
    low, high, ours = (float(_short(value, digits)) for value in (row.low, row.high, row.ours))
    return low <= ours <= high


def _short(value: float, digits: int = 3) -> str:
    """A number with so many digits, or whole from ten on where these are fewer."""
    shown = f"{value:.{digits}g}"
    return shown if abs(float(shown)) < 10**digits or math.isinf(value) else f"{value:.0f}"


def _drawing(own: list[Row]) -> Figure:
    """Computed coefficients of the discs over those of the formula."""
    import matplotlib.pyplot as plt

    drawing, axes = plt.subplots(figsize=(5, 4.5))
    for colour, oil in zip(COLOURS, DISC_OILS, strict=False):
        rows_of = [row for row in own if row.what.startswith(oil)]
        x = [0.5 * (row.low + row.high) for row in rows_of]
        y, down, up = ([getattr(row, name) for row in rows_of] for name in ("ours", "down", "up"))
        axes.errorbar(
            x, y, yerr=[down, up], xerr=FORMULA_ERROR, fmt="o", ms=3, lw=0.6, color=colour, label=oil, alpha=0.8
        )
    axes.plot([0, 0.06], [0, 0.06], color="0.5", lw=0.8)
    axes.set_xlabel("coefficient of friction by the formula")
    axes.set_ylabel("computed")
    axes.legend()
    return drawing


def _missed(stored: Mapping[str, Any]) -> Section:
    """Experiments on why rows are missed."""
    words = prose("friction")["experiments"]
    rough = stored["gears"]["roughness"]
    heights = list(next(iter(rough.values())))
    mineral = rough["mineral"]
    ratios = [
        (BASE_NAMES[base], *(f"{one[rms]:.4f} ({one[rms] / mineral[rms]:.2f})" for rms in heights))
        for base, one in rough.items()
    ]
    film = stored["gears"]["film"]
    alone = [
        (BASE_NAMES[base], f"{one['power']:.0f}", f"{one['coefficient']:.4f}", f"-{one['down']:.2g} +{one['up']:.2g}",
         f"{one['coefficient'] / film['mineral']['coefficient']:.2f}")
        for base, one in film.items()
    ]  # fmt: skip
    formula = {(row["oil"], row["slip"]): row for row in stored["discs"] if row["speed"] == 4 and row["inlet"] == 60}
    viscosity = [
        (row["oil"], f"{row['slip']:g}", *map(_number, (one["formula"], one["coefficient"], row["coefficient"])))
        for row in stored["measured_viscosity"]
        for one in [formula[row["oil"], row["slip"]]]
    ]
    mineral_disc = stored["base_oils"]["mineral"]["coefficient"]
    alpha = [
        (BASE_NAMES[row["base"]], f"{1e9 * row['alpha']:.1f}", _number(row["coefficient"]),
         f"{row['coefficient'] / mineral_disc:.2f}")
        for row in stored["pressure_coefficient"]
    ]  # fmt: skip
    heat = [
        (row["oil"], f"{row['speed']:g}", f"{row['slip']:g}", *(_number(row[key]) for key in ("off", "lumped", "full")))
        for row in stored["full_heat"]
    ]
    roelands = [
        (name, f"{row['temperature']:g}", f"{row['alpha_measured']:.1f}", f"{row['alpha']:.1f}",
         f"{row['measured']:.1f}", f"{row['ours']:.1f}", f"{math.exp(row['ours'] - row['measured']):.2g}")
        for name, row in viscosity_at_pressure()
    ]  # fmt: skip
    measured = {(row["oil"], row["slip"]): row["coefficient"] for row in stored["measured_viscosity"]}
    at = {(row["oil"], row["speed"], row["slip"]): row for row in stored["discs"] if row["inlet"] == TESTED}
    sliding = [
        (oil, f"{speed:g}", *(f"{at[oil, speed, 0.1][name] / at[oil, speed, 0.02][name]:.2f}" for name in
         ("formula", "coefficient")), f"{measured[oil, 0.1] / measured[oil, 0.02]:.2f}" if speed == 4 else "-")
        for oil in DISC_OILS for speed in sorted({key[1] for key in at})
    ]  # fmt: skip
    return Section(
        "What is missed in oils and gears, and why",
        text(words["roughness"])
        + table(("oil", *(f"Sq {rms} nm" for rms in heights)), ratios)
        + text(words["film"])
        + table(("oil", "film alone (W)", "coefficient", "scatter of the oil", "over mineral oil"), alone)
        + text(words["viscosity"])
        + table(("oil", "slide/roll", "formula of the measurement", "ours", "ours, viscosity as measured"), viscosity)
        + text(words["sliding"])
        + table(("oil", "speed (m/s)", "formula of the measurement", "ours", "ours, viscosity as measured"), sliding)
        + text(words["roelands"])
        + table(ROELANDS_HEADERS, roelands)
        + text(words["alpha"])
        + table(("oil", "1/GPa at 60 degC", "friction", "over mineral oil"), alpha)
        + text(words["heat"])
        + table(("oil", "speed (m/s)", "slide/roll", "no heat", "lumped", "full"), heat),
    )


def _number(value: Any) -> str:
    return f"{value:.4f}" if isinstance(value, float) else str(value)


def _ball(stored: Mapping[str, Any], hot: Mapping[str, Any]) -> Section:
    """The built-in Stribeck curve with the errors of its run, beside another draw of the surface."""
    curve = [
        (*(f"{row[name]:.3g}" for name in ("speed", "lambda", "touching", "friction")),
         *(f"{row[name]:.2g}" if (row[name] or 0.0) >= 1e-6 else "-" for name in ("numerical", "oil")),
         *(f"{other[name]:.3g}" for name in ("touching", "friction")))
        for row, other in zip(hot["ball"], stored["ball"], strict=True)
    ]  # fmt: skip
    return Section(
        "A ball's Stribeck curve",
        text(prose("friction")["ball"])
        + table(
            (
                "disc (m/s)",
                "lambda ratio",
                "asperity load share",
                "friction",
                "numerical",
                "oil",
                "other draw: share",
                "other draw: friction",
            ),
            curve,
        ),
    )


def _checks(hot: Mapping[str, Any]) -> Section:
    """One smooth hot contact by two kinds; the scatter of the oil beside that with the film solved again."""
    words = prose("friction")["experiments"]
    smooth = [
        (f"{row['slip']:g}", *(f"{row[f'{kind}{end}']:.4g}" for kind in ("traction", "friction")
         for end in ("", "_numerical", "_temperature")), f"{abs(row['traction'] - row['friction']):.1g}")
        for row in hot["smooth"]
    ]  # fmt: skip
    again = [
        (row["oil"], f"{row['speed']:g}", f"{row['slip']:g}", f"{row['coefficient']:.4f}",
         *(f"-{row[f'{kind}down']:.4f} +{row[f'{kind}up']:.4f}" for kind in ("", "solved_")))
        for row in hot["again"]
    ]  # fmt: skip
    kinds = (f"{kind}{end}" for kind in ("traction", "friction") for end in ("", ": numerical", ": oil (degC)"))
    return Section(
        "Two kinds for one contact, and scatter with the film solved again",
        text(words["smooth"])
        + table(("slide/roll", *kinds, "difference"), smooth)
        + text(words["again"])
        + table(("oil", "speed (m/s)", "slide/roll", "ours", "scatter in the tables", "solved again"), again),
    )


def _constants() -> Section:
    """The constants of the base oils."""
    shown = [
        (
            BASE_NAMES.get(base, base),
            label,
            f"{one.value / unit:.3g}",
            f"{one.low / unit:.3g} to {one.high / unit:.3g}",
            one.source,
        )
        for base in bases()
        for name, one in rheology_of(base).constants().items()
        for label, unit in [CONSTANTS[name]]
        if base == "mineral" or name in ("shear_stress_limit", "limiting_shear_coefficient")
    ]
    return Section(
        "Constants of the base oils",
        text(prose("friction")["constants"])
        + table(("base", "constant", "value", "range", "source"), shown)
        + text(prose("friction")["stored"])
        + age(NAME)
        + age(HOT)
        + published.ages(),
    )


def _sources() -> Section:
    """Where the measurements are from, and how they were read."""
    return Section(
        "Sources",
        table(
            ("short", "source", "how it was read"),
            [(one["short"], one["source"], one["read"]) for one in prose("friction")["sources"].values()],
        ),
    )
