"""Our numbers and verdicts for the lines on paper A: film and friction."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable

from bem.reference_solutions.line_film import dowson_higginson_minimum
from reports.experiments.kept import found
from reports.validation_values import (
    READING,
    Rule,
    Summary,
    Value,
    at,
    at_speed,
    curve,
    difference_spread,
    differences,
    differences_with_spread,
    echo,
    elastic_curves,
    experiment,
    hertz_pressure,
    over_runs,
    quoted,
    signed_difference,
    steel_modulus,
    stored,
    within,
)

VISIBLE = 0.01
"""Relative difference of friction from which two plotted curves can be told apart: about the width of their lines."""


def _elastic_above(summary: Summary) -> float:
    """Largest excess of the friction of elastic over that of capped contact, relative to the capped one."""
    pair = (curve(summary, model="elastic")["friction"], curve(summary, model="capped")["friction"])
    return max(elastic / capped - 1 for elastic, capped in zip(*pair, strict=True))


def _elastic_there(summary: Summary) -> str:
    return f"{100 * _elastic_above(summary):.2g} %"


def _largest_difference_speeds(summary: Summary) -> dict[float, float]:
    """Speed [m/s] at which uncoupled and coupled friction differ most, by largest Hertz pressure [GPa], L = 34 um."""
    found = {}
    for one in (c for c in summary["curves"] if c["variant"] == "34 um" and c["model"] == "elastic"):
        other = curve(summary, load_N=one["load_N"], variant="34 um", model="uncoupled_elastic")
        apart = [abs(b - a) for a, b in zip(one["friction"], other["friction"], strict=True)]
        found[round(hertz_pressure(one["load_N"]), 1)] = summary["speed_m_s"][apart.index(max(apart))]
    return dict(sorted(found.items()))


def _difference_at(summary: Summary, pressure: float) -> float:
    """Signed largest difference at a largest Hertz pressure [GPa], L = 34 um [%]."""
    return signed_difference(summary, _elastic_at(summary, pressure))


def _elastic_at(summary: Summary, pressure: float) -> Summary:
    """The coupled curve at a largest Hertz pressure [GPa], L = 34 um."""
    curves = elastic_curves(summary, "34 um")
    (one,) = [c for c in curves if round(hertz_pressure(c["load_N"]), 1) == pressure]
    return one


def _with_spread(values: Iterable[Value]) -> str:
    """Differences with their sign and deviation over repetitions."""
    return ", ".join(f"{value.mean:+.1f} ± {value.spread:.1f}" for value in values)


def _clearly_less(summary: Summary) -> bool:
    """Return True if d of the longer waves lies below that of the shorter by more than their scatter, at each load."""
    pairs = zip(*(differences_with_spread(summary, name) for name in ("34 um", "57 um")), strict=True)
    return all(short.mean - long.mean > max(short.spread or 0.0, long.spread or 0.0) for short, long in pairs)


def _pressures_on_the_square() -> str:
    """Mean pressures [MPa] on the flat squares of `separation_datum`, one for each Hertz pressure."""
    rows = [row for row in found("separation_datum") if round(row["correlation_length_um"]) == 34]
    side = 408e-6
    return ", ".join(
        f"{1e-6 * math.pi * (1e9 * row['hertz_pressure_GPa']) ** 2 * 2e-3 / steel_modulus() / side:.0f}" for row in rows
    )


def _lambda_at(metres_per_second: float) -> float:
    """Dowson and Higginson's smallest film at 5.5 N over the roughness of 100 nm."""
    film = dowson_higginson_minimum(
        load=5.5 / 6e-3,
        radius=2e-3,
        contact_modulus=steel_modulus(),
        mean_speed=metres_per_second / 2,
        viscosity=0.36,
        pressure_viscosity=25e-9,
    )
    return film / 100e-9


def _shares_by_lambda(summary: Summary) -> list[tuple[float, float]]:
    """Lambda and the part of the load on the surfaces, speed after speed."""
    carried = curve(summary, model="capped")["contact_load_N"]
    return [(_lambda_at(v), load / 5.5) for v, load in zip(summary["speed_m_s"], carried, strict=True)]


def _regimes_by_lambda(summary: Summary) -> bool:
    """Return True if film friction does not count below Lambda = 0.1, surfaces carry above it and nothing above 3."""
    film = curve(summary, model="capped")["film_friction_part"]
    friction = curve(summary, model="capped")["friction"]
    parts = [part / whole for part, whole in zip(film, friction, strict=True)]
    shares = _shares_by_lambda(summary)
    boundary = [part for (ratio, _), part in zip(shares, parts, strict=True) if ratio < 0.1]
    full = [share for ratio, share in shares if ratio > 3]
    mixed = [share for ratio, share in shares if 0.1 <= ratio <= 3]
    return (
        bool(boundary and full)
        and max(boundary) < READING
        and max(full) == 0.0
        and any(0.0 < share < 1.0 for share in mixed)
    )


def _regimes_line(summary: Summary) -> str:
    shares = _shares_by_lambda(summary)
    (slow, carried), (ratio, _) = shares[0], next(one for one in shares if one[1] == 0.0)
    return f"{carried:.3f} at Lambda {slow:.2g}; none from {ratio:.2g} on"


def _pressure_viscosity_changes(summary: Summary) -> list[float]:
    """Relative change of the film's friction by an oil without pressure-viscosity, speed after speed."""
    pairs = zip(experiment("oil-as-it-is")["film_friction_part"], summary["film_friction_part"], strict=True)
    return [without / own - 1 for own, without in pairs]


def _friction_scatter(summary: Summary) -> tuple[float, float, float]:
    """Deviation of friction over surfaces at the slowest speed, its largest, and at the fastest speed."""
    spread = curve(summary, model="capped")["friction_spread"]
    return spread[0], max(spread), spread[-1]


def _film_there(summary: Summary) -> str:
    return f"{at(summary, 'film_load_N').mean:.3f} N at {at(summary, 'minimum_film_nm').mean:.0f} nm"


def _film_for_the_source() -> float:
    """Film [nm] that would carry the source's 0.225 N: load times film is what the speed gives, 11 N nm."""
    one = experiment("film-load-one-surface")
    return at(one, "film_load_N").mean * at(one, "minimum_film_nm").mean / 0.225


def _film_loads(summary: Summary) -> str:
    later = at_speed(summary, "film_load_N", 0.01)
    there = quoted(_film_there, FILM_LOADS)(summary)
    return (
        f"{later} N. The film carries what its thickness, set by the roughness, lets it: load times film is what the "
        f"speed gives. One surface at 0.001 m/s, film load and film: {there}; 0.225 N take "
        f"{_film_for_the_source():.0f} nm"
    )


def _d_there(summary: Summary) -> str:
    both = (f"{_signed(differences(summary, name))} % for {name}" for name in ("34 um", "57 um"))
    return " and ".join(both)


def _longer_waves(summary: Summary) -> str:
    return f"{', '.join(f'{d:.1f}' for d in differences(summary, '57 um'))} %"


def _signed(values: Iterable[float]) -> str:
    return ", ".join(f"{value:+.0f}" for value in values)


def _by_datum(*lengths: float) -> str:
    """d over Hertz pressure on flat squares, for each datum; see `reports.experiments.separation_datum`."""
    rows = found("separation_datum")
    parts = []
    for datum, words in (("volume", "the volume of oil kept"), ("undeformed_planes", "the undeformed planes as datum")):
        each = []
        for length in lengths:
            values = _signed(row[datum] for row in rows if round(row["correlation_length_um"]) == length)
            each.append(f"{values} % for {length:g} um")
        parts.append(f"{' and '.join(each)} with {words}")
    return (
        f"on flat squares under the loads of Hertz pressures of 0.6, 0.8, 1.0 GPa ({_pressures_on_the_square()} MPa in "
        f"the mean) d is {'; '.join(parts)}"
    )


FILM_LOADS = {
    "film-load-one-surface": "as it is",
    "film-load-cutoff-9-um": "with a cut-off of 9 um",
    "film-load-waves-20-to-60-um": "with waves from 20 to 60 um",
    "film-load-patch-of-180-um": "on a patch twice as long",
    "film-load-plateaus": "with plateaus (skewness -2)",
    "film-load-sq-40-nm": "with Sq 40 nm",
}
FILM_AS_SEPARATION = {"wavelength-film-as-separation": "at 0.6, 0.8, 1.0 GPa"}


SLOWER = {"given-film-a-tenth-as-fast": "at a tenth of that speed"}
SLOWER_LONG = {"given-film-slower-57-um": "at 0.8, 0.9, 1.0, 1.1 GPa"}
SQUARES = {
    "given-film-square-of-204-um": "at 0.6, 0.8, 1.0 GPa on a square of 204 um (one surface)",
    "given-film-square-of-816-um": "on one of 816 um",
}
SHORT_WAVES = {
    "elastic-cutoff-0.9-um": "with a cut-off of 0.9 um",
    "elastic-sq-300-nm": "with Sq 300 nm",
}


RULES: dict[str, Rule] = {
    "spheres_14_20_30_40_um_apart_load_over_hertz": Rule(
        over_runs("load_over_hertz_finite_array"),
        lambda s: all(a < b < 1 for a, b in itertools.pairwise((*s["load_over_hertz_finite_array"][:4], 0.999))),
    ),
    "the_same_from_the_mean_plane_of_the_deformed": Rule(
        over_runs("load_over_hertz"),
        lambda s: None,
    ),
    "e_of_steel_on_steel_twice_the_contact_modulus": Rule(
        lambda s: f"{2e-9 * steel_modulus():.1f}",
        echo,
    ),
    "hertz_pressure_at_5_5_n_mean_and_largest_mpa": Rule(
        lambda s: f"{250 * math.pi * hertz_pressure(5.5):.0f} and {1000 * hertz_pressure(5.5):.0f}",
        echo,
    ),
    "friction_at_0_001_m_s": Rule(
        lambda s: str(at_speed(s, "friction", 0.001)),
        echo,
    ),
    "contact_load_at_0_001_m_s_n": Rule(
        lambda s: str(at_speed(s, "contact_load_N", 0.001)),
        echo,
    ),
    "film_load_at_0_001_m_s_n": Rule(
        lambda s: str(at_speed(s, "film_load_N", 0.001)),
        lambda s: within(at_speed(s, "film_load_N", 0.001), 0.2245, 0.2255),
        _film_loads,
    ),
    "contact_load_at_0_3_m_s_n": Rule(
        lambda s: f"{at_speed(s, 'contact_load_N', 0.3)}",
        lambda s: at_speed(s, "contact_load_N", 0.3).mean == 0.0,
    ),
    "elastic_against_capped_at_6_gpa_largest": Rule(
        lambda s: f"{100 * _elastic_above(s):.2g}",
        lambda s: _elastic_above(s) >= VISIBLE,
        quoted(_elastic_there, SHORT_WAVES),
    ),
    "uncoupled_against_coupled_asperities_at_5_5_n": Rule(
        lambda s: f"{signed_difference(s, curve(s, model='elastic')):+.1f}",
        lambda s: signed_difference(s, curve(s, model="elastic")) >= 100 * VISIBLE,
    ),
    "uncoupled_less_coupled_friction_d_with_its": Rule(
        lambda s: _with_spread(differences_with_spread(s, "34 um")),
        lambda s: min(differences(s, "34 um")) > 0,
    ),
    "largest_difference_near_1_gpa": Rule(
        lambda s: f"{_difference_at(s, 1.0):.1f} ± {difference_spread(s, _elastic_at(s, 1.0)):.1f}",
        lambda s: 31.5 <= _difference_at(s, 1.0) < 32.5,
        lambda s: (
            f"{_difference_at(stored('asperities-given-film'), 1.0):.1f} at 0.003 m/s, "
            f"{quoted(lambda slower: f'{_difference_at(slower, 1.0):.1f}', SLOWER)(s)}; "
            f"{quoted(_d_there, SQUARES)(s)}"
        ),
    ),
    "speed_of_the_largest_difference": Rule(
        lambda s: ", ".join(f"{v:.2g}" for v in _largest_difference_speeds(s).values()),
        lambda s: all(0.056 < v < 0.18 for v in _largest_difference_speeds(s).values()),
        lambda s: ", ".join(f"{v:.2g}" for v in _largest_difference_speeds(stored("asperities-given-film")).values()),
    ),
    "the_same_for_l_57_um": Rule(
        lambda s: _with_spread(differences_with_spread(s, "57 um")),
        _clearly_less,
        lambda s: _by_datum(34, 57),
    ),
    "the_size_of_d_grows_with_load_l_34_um": Rule(
        lambda s: ", ".join(f"{abs(d):.1f}" for d in differences(s, "34 um")) + " %",
        lambda s: all(abs(a) < abs(b) for a, b in itertools.pairwise(differences(s, "34 um"))),
        lambda s: _by_datum(34),
    ),
    "the_size_of_d_grows_with_load_l_57_um": Rule(
        lambda s: ", ".join(f"{abs(d):.1f}" for d in differences(s, "57 um")) + " %",
        lambda s: all(abs(a) < abs(b) for a, b in itertools.pairwise(differences(s, "57 um"))),
        lambda s: f"{quoted(_longer_waves, SLOWER_LONG)(s)}. Of the load carried, {_by_datum(57)}",
    ),
    "regimes_by_lambda": Rule(_regimes_line, _regimes_by_lambda),
    "pressure_viscosity_plays_a_minor_role": Rule(
        lambda s: f"{100 * max(_pressure_viscosity_changes(s), key=abs):+.1f}",
        lambda s: max(abs(change) for change in _pressure_viscosity_changes(s)) < READING,
        lambda s: f"{100 * _pressure_viscosity_changes(s)[-1]:+.1f} %",
    ),
    "scatter_of_friction": Rule(
        lambda s: ", ".join(f"{value:.1g}" for value in _friction_scatter(s)),
        lambda s: _friction_scatter(s)[0] == _friction_scatter(s)[1],
        quoted(lambda s: f"{at(s, 'friction').mean:.4f}", FILM_LOADS),
    ),
    "d_with_the_volume_of_oil_kept_in_both": Rule(
        _d_there,
        lambda s: None,
        lambda s: f"{quoted(_d_there, FILM_AS_SEPARATION)(s)} (one surface)",
    ),
    "two_measured_surfaces_friction_at_0_001_m_s": Rule(
        lambda s: (
            f"{at(s, 'friction', 0)}; {at(s, 'contact_load_N', 0)} and "
            f"{at(s, 'contact_load_N', len(s['speed_m_s']) - 1)}"
        ),
        lambda s: None,
        lambda s: f"Sq {s['Sq_nm']:.0f} nm",
    ),
}
