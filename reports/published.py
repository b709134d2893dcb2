"""Rows and sections of the page on friction beyond base oils: traction of more oils, a bearing, shares of load, films,
fatigue. Ours are stored results of experiments; the published values stand here."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from functools import partial
from typing import Any

from reports.builder import Section, table, text
from reports.experiments.bearing_measured import drag
from reports.experiments.kept import age, found, result_of
from reports.measurement import MOST, Row
from reports.prose import prose

FITTED_ERROR = 0.25
"""Relative error assumed of the curves in Gupta's data."""
READ_OFF = 0.15
"""Relative error assumed of torques that were read off figures; of their ratios 20 %."""
LAMBDA_ERROR = 0.2
"""Relative error assumed of the lambda ratio of rough discs."""
TABLE_ERROR, RIPPLE_ERROR, FORMULA_ERROR = 0.03, 0.02, 0.05
"""Relative errors assumed of Venner's table, of Greenwood and Morales-Espejel's ripples and of formulas of rolling."""
POINT_FORMULA_ERROR = 0.10
"""The same of the formula of rolling resistance of point contacts."""
INTERFEROMETRY = 8.0
"""Error assumed of films by interferometry that were digitised [nm]: they scatter by 4 nm rms where they are even."""
PITTED_FACTOR = 2.0
"""Factor within which a pitted fraction is taken as known."""
TORQUES = {
    (0.0, 50.0): {500: 1300, 2000: 2950, 4000: 3750},
    (6500.0, 50.0): {500: 1500, 1000: 1950, 2000: 2500, 4000: 3250},
    (6500.0, 42.0): {500: 2000, 1000: 2650, 2000: 3500, 4000: 4450},
}
"""Torque [N mm] over speed [rpm] by radial load [N] and oil [degC]."""
WAVES_LEFT = {
    (4.0, 0.1): 0.030, (4.0, 0.2): 0.030, (4.0, 0.5): 0.029,
    (1.0, 0.1): 0.183, (1.0, 0.2): 0.182, (1.0, 0.5): 0.195,
    (0.25, 0.1): 0.660, (0.25, 0.2): 0.670, (0.25, 0.5): 0.679,
}  # fmt: skip
"""Amplitude left by wavelength over half-width and amplitude over central film, table 1 of Venner et al. (1997)."""
POINT_LEFT = 0.739
RIPPLES = {14.8e-9: (0.388e9, 33.1e-9), 12.3e-9: (0.413e9, 18.5e-9)}
"""Ripples of pressure [Pa] and film [m] by pressure-viscosity coefficient [1/Pa]."""
DIMPLES = {
    "rolling": {
        "film without a dimple": 211.3,
        "constriction at the outlet": 167.7,
        "film behind the dimple at -86 um": 191.3,
        "film behind the dimple at -48 um": 180.6,
        "film behind the dimple at 26 um": 192.8,
        "film before the dimple at 111 um": 192.6,
    },
    "sliding": {
        "film ahead of the dimple at -62 um": 269.8,
        "film ahead of the dimple at -47 um": 267.3,
        "film ahead of the dimple at -13 um": 236.0,
        "thinnest film ahead, dimple at -117 um": 177.7,
        "thinnest film ahead, dimple at -62 um": 182.0,
        "thinnest film ahead, dimple at -47 um": 182.4,
    },
}
"""Measured films [nm], read from the digitised curves in the windows of the experiment."""
UNRESOLVED = "film before the dimple at 111 um"
"""Film that the grid does not resolve with the etched depth."""
PITTED = (0.010, 0.255, 0.00034, 0.440, 0.00042, 0.00043)
"""Pitted fractions, in the order of the experiment's pairs."""
READING = "per decade"
"""Reading of A that bem has."""
ENDLESS = 9.0
"""Decades of cycles that a contact at the fatigue load limit has at least."""


def rows() -> tuple[Iterator[Row], ...]:
    """All rows, by group."""
    return (
        _traction(found("traction_measured")),
        _bearing(found("bearing_measured")["torque"]),
        _load_share(found("load_share_curves")),
        *(part(found("film_measured")) for part in (_waves, _transverse, _rolling_points, _dimples)),
        _rolling_lines(found("independent_figures")["rolling"]),
        _pitting(found("pitting_measured")),
    )


def _remark(name: str) -> str:
    return str(prose("friction")["remarks"][name])


def _traction(stored: list[dict[str, Any]]) -> Iterator[Row]:
    """Four oils beside curves fitted to their tests."""
    for row in stored:
        fitted = row["fitted"]
        yield Row(
            "traction",
            f"{row['oil']}, slide/roll {row['slip']:g}, {row['inlet']:g} degC",
            fitted * (1 - FITTED_ERROR),
            fitted * (1 + FITTED_ERROR),
            row["coefficient"],
            math.hypot(row["down"], row["pressure_down"]),
            math.hypot(row["up"], row["pressure_up"]),
            row["numerical"],
            "gupta",
            _fitted_remark(row),
            apart=True,
        )


def _fitted_remark(row: Mapping[str, Any]) -> str:
    """Why a traction coefficient is off the fitted curve; nothing where it is within its error."""
    if abs(row["coefficient"] / row["fitted"] - 1) <= FITTED_ERROR:
        return ""
    if row["oil"].startswith("MIL"):
        return _remark("gupta_ester")
    return _remark("gupta_limit" if row["oil"].startswith("Santotrac") else "gupta_mineral")


def _bearing(stored: list[dict[str, Any]]) -> Iterator[Row]:
    """Torque of the tapered roller bearing; its rise with speed and viscosity."""
    ours = {(row["radial"], row["temperature"], row["speed"]): row for row in stored}
    for (radial, temperature), measured in TORQUES.items():
        for speed, torque in measured.items():
            row = ours[radial, temperature, float(speed)]
            yield Row(
                "bearing",
                f"torque, {speed} rpm, {temperature:g} degC, radial load {radial / 1000:g} kN (N mm)",
                torque * (1 - READ_OFF),
                torque * (1 + READ_OFF),
                row["rolling"] + row["rib"],
                row["rib_scatter"],
                row["rib_dry"] - row["rib"],
                row["numerical"],
                "schwarz",
                _remark("bearing").format(ratio=f"{_total(row) / torque:.1f}"),
            )
    for one, other, what in _torque_ratios():
        measured = TORQUES[one[:2]][int(one[2])] / TORQUES[other[:2]][int(other[2])]
        ratio = _total(ours[one]) / _total(ours[other])
        numerical = ratio * math.hypot(*(ours[key]["numerical"] / _total(ours[key]) for key in (one, other)))
        remark = "" if 0.8 <= ratio / measured <= 1.2 else _remark("bearing_rise")
        yield Row("bearing", what, 0.8 * measured, 1.2 * measured, ratio, 0.0, 0.0, numerical, "schwarz", remark)


Condition = tuple[float, float, float]
"""Radial load [N], oil [degC] and speed [rpm]."""


def _torque_ratios() -> Iterator[tuple[Condition, Condition, str]]:
    """All rises of the torque with speed from 500 rpm on, then all with viscosity."""
    for (radial, temperature), measured in TORQUES.items():
        for speed in measured:
            if speed > 500:
                load = f"radial load {radial / 1000:g} kN"
                what = f"torque at {speed} rpm over that at 500 rpm, {temperature:g} degC, {load}"
                yield (radial, temperature, float(speed)), (radial, temperature, 500.0), what
    for speed in TORQUES[6500.0, 42.0]:
        what = f"torque at 42 degC over that at 50 degC, {speed} rpm"
        yield (6500.0, 42.0, float(speed)), (6500.0, 50.0, float(speed)), what


def _total(row: Mapping[str, float]) -> float:
    return row["rolling"] + row["rib"]


def _load_share(stored: list[dict[str, Any]]) -> Iterator[Row]:
    """Asperity load share over the lambda ratio, oil counted as bem does unless asked otherwise."""
    counted = [one["rows"] for one in stored if one["oil_volume"] == "loaded"]
    for one, other in zip(*counted, strict=True):
        ratio = one["lambda"]
        if not 0.04 < ratio < 3:
            continue
        low, high = (1 - math.erf(ratio * (1 + sign * LAMBDA_ERROR)) for sign in (1, -1))
        change = other["contact_share"] - one["contact_share"]
        yield Row(
            "share", f"asperity load share at lambda {ratio:.2g}", low, high, one["contact_share"],
            max(-change, 0.0), max(change, 0.0), 0.01, "clarke",
            _remark("share") if one["contact_share"] + max(change, 0.0) + 0.01 < low else "",
        )  # fmt: skip


def _near(value: float, error: float) -> tuple[float, float]:
    return value * (1 - error), value * (1 + error)


def _waves(stored: Mapping[str, Any]) -> Iterator[Row]:
    """Rows of the remaining amplitude of waves in the centre of rolling contacts."""
    ours = {(row["wavelength"], row["amplitude"]): row for row in stored["waves"]}
    solution = partial(Row, "waves", down=0.0, up=0.0, computed=True)
    for key, left in WAVES_LEFT.items():
        if key not in ours:
            continue
        low, high = _near(left, TABLE_ERROR)
        what = f"line, wavelength {key[0]:g} half-widths, amplitude {key[1]:g} films"
        row = ours[key]
        remark = "" if low <= row["ours"] <= high or key[1] < 0.5 else _remark("waves")
        yield solution(what, low, high, row["ours"], numerical=row["numerical"], source="venner1997", remark=remark)
    low, high = _near(POINT_LEFT, TABLE_ERROR)
    row = stored["point_wave"]
    what = "ball, M 1007.6, L 12.05, wavelength 0.25 half-axes"
    yield solution(
        what, low, high, row["ours"], numerical=row["numerical"], source="venner2000", remark=_remark("point_wave")
    )


def _transverse(stored: Mapping[str, Any]) -> Iterator[Row]:
    """Ripples of pressure and film under transverse roughness."""
    for row in stored["transverse"]:
        at = f"alpha {1e9 * row['alpha']:.3g} 1/GPa, film {1e6 * row['film']:.3g} um"
        names = (("pressure_ripple", "pressure ripple (GPa)", 1e-9), ("film_ripple", "film ripple (nm)", 1e9))
        for published, (name, what, unit) in zip(RIPPLES[row["alpha"]], names, strict=True):
            low, high = _near(unit * published, RIPPLE_ERROR)
            own = row[name]
            values = (unit * own[key] for key in ("ours", "down", "up", "numerical"))
            yield Row("transverse", f"{what}, {at}", low, high, *values, "greenwood", _remark("transverse"), True)


def _rolling_lines(stored: list[dict[str, float]]) -> Iterator[Row]:
    """Rolling resistance of line contacts and its exponent of G."""
    by_load: dict[float, dict[float, dict[str, float]]] = {}
    for one in stored:
        by_load.setdefault(one["M"], {})[one["L"]] = one
    for load, own in by_load.items():
        if load < 1:
            continue
        root = math.sqrt(load)
        formula = 1.42 * root * (1 + (1.4 / 1.45 * root) ** 10) ** -0.1
        values = [row["over_U34"] for row in own.values()]
        ours = own[8.0]["over_U34"]
        down, up, numerical = ours - min(values), max(values) - ours, ours * own[8.0]["mesh_error"]
        low, high = _near(formula, FORMULA_ERROR)
        what = f"line, M {load:g}: resistance over E' R U^3/4, L 4 to 16"
        remark = _remark("rolling") if abs(ours / formula - 1) > FORMULA_ERROR else ""
        yield Row("rolling", what, low, high, ours, down, up, numerical, "houpert1", remark, True)
    exponent = math.log(by_load[20.0][16.0]["over_U34"] / by_load[20.0][4.0]["over_U34"]) / math.log(4)
    numerical = math.hypot(by_load[20.0][16.0]["mesh_error"], by_load[20.0][4.0]["mesh_error"]) / math.log(4)
    yield Row("rolling", "line, M 20: exponent of G", -0.36, 0.0, exponent, 0.0, 0.0, numerical, "houpert2", "", True)


def _rolling_points(stored: Mapping[str, Any]) -> Iterator[Row]:
    """Rolling resistance of circular contacts."""
    for row in stored["rolling"]:
        rigid = 0.77 * 2 * row["half_axis"] * row["speed"] ** (2 / 3)
        elastic = 1.8 * 2 * row["half_axis"] * row["speed"] ** 0.75
        formula = elastic + (rigid - elastic) / (1 + row["M"] / 6.6)
        low, high = _near(1.0, POINT_FORMULA_ERROR)
        what = f"ball, M {row['M']:g}, L {row['L']:g}: resistance over the formula"
        ours, down, numerical = (row[key] / formula for key in ("ours", "down", "numerical"))
        yield Row("rolling", what, low, high, ours, down, 0.0, numerical, "houpert2", _remark("far"), True, True)


def _dimples(stored: Mapping[str, Any]) -> Iterator[Row]:
    """Films that were measured around a dimple, with the dimple as etched where a film was found, else as simulated."""
    for kind, measured in DIMPLES.items():
        tried = [row for row in stored["dimples"] if row["kind"] == kind]
        own = next(row for row in reversed(tried) if "figures" in row)
        remark = "etched" if own["place"] == 1 else "untried" if len(tried) == 1 else "dimple"
        for name, film in measured.items():
            row = own["figures"][name]
            unresolved = own["place"] == 1 and name == UNRESOLVED
            yield Row(
                "dimples", f"{kind}: {_figure(name)} (nm)", film - INTERFEROMETRY, film + INTERFEROMETRY,
                row["ours"], 0.0, 0.0, row["numerical"],
                "mourier", _remark("unresolved" if unresolved else remark), apart=unresolved,
            )  # fmt: skip


def _figure(name: str) -> str:
    """Name of a stored film of a dimple by its side: ahead is downstream in rolling as in sliding."""
    return name.replace("behind the dimple", "ahead of the dimple").replace(
        "before the dimple", "upstream of the dimple"
    )


def _pitting(stored: Mapping[str, Any]) -> Iterator[Row]:
    """Cycles to damage below a smooth contact; pitted fractions of surface pairs."""
    for row in stored["smooth"]:
        what = f"smooth contact at 1.5 GPa, {_criterion(row)}: decades of cycles to damage"
        yield Row("pitting", what, ENDLESS, MOST, row["decades"][READING], 0.0, 0.0, 0.0, "iso281", apart=True)
    for row, pitted in zip((one for one in stored["pairs"] if one["reading"] == READING), PITTED, strict=True):
        yield Row(
            "pitting", f"{_pair(row)}: pitted fraction", pitted / PITTED_FACTOR, pitted * PITTED_FACTOR,
            row["pitted"], row["pitted"] - row["least"], row["most"] - row["pitted"], 0.0, "brizmer",
            _remark("pitting"),
        )  # fmt: skip


def _criterion(row: Mapping[str, Any]) -> str:
    return str(row["criterion"]).replace("_", " ").title()


def _pair(row: Mapping[str, Any]) -> str:
    lay = "longitudinal" if row["elongation"] > 1 else "transverse"
    body = {"upper": "roller", "lower": "disc"}[row["body"]]
    return f"roller {row['roller']:g} um on disc {row['disc']:g} um, {lay}, {body}"


def sections() -> list[Section]:
    """Experiments on why rows are missed."""
    words = prose("friction")["experiments"]
    bearing, films, pitting = (found(name) for name in ("bearing_measured", "film_measured", "pitting_measured"))
    return [
        Section(
            "What is missed in bearings, films and fatigue, and why",
            text(words["parts"])
            + table(("rpm", "degC", "radial load (kN)", *PARTS, "measured"), _torque_parts(bearing["torque"]))
            + text(words["starved"])
            + table(
                ("rpm", "meniscus (half-widths before the centre)", "resistance over flooded", "film over flooded"),
                [
                    (f"{row['speed']:g}", key, *(map("{:.2f}".format, pair) if pair else ("no film found", "")))
                    for row in bearing["starved"]
                    for key, pair in row.items()
                    if key != "speed"
                ],
            )
            + text(words["share"])
            + table(("lambda", "1 - erf", *_counted()), _shares())
            + text(words["waves"])
            + table(("wavelength (half-widths)", "no height", "0.1 films", "0.2 films", "0.5 films"), _heights(films))
            + text(words["lines"])
            + text(words["far"])
            + table(("M", "L", "share of the resistance on the grid"), _inlets(films))
            + text(words["dimple"])
            + table(("case", "depth (nm)", "figure", "measured (nm)", "ours (nm)"), _depths(films))
            + text(words["fatigue"])
            + table(("criterion", "A per factor e", "A per decade"), _smooth(pitting))
            + table(("pair", "published", "A per factor e", "A per decade"), _readings(pitting)),
        )
    ]


PARTS = ("rolling", "ribs with a film", "ribs without a film", "rollers in full oil")
"""Parts of the torque [N mm]."""


def _torque_parts(stored: list[dict[str, Any]]) -> list[tuple[str, ...]]:
    """Parts of the torque of the bearing, the last two upper bounds of what is left out."""
    shown = []
    for row in stored:
        radial, temperature, speed = (row[key] for key in ("radial", "temperature", "speed"))
        parts = (row["rolling"], row["rib"], row["rib_dry"], drag(speed, temperature))
        measured = TORQUES[radial, temperature][int(speed)]
        cells = (speed, temperature, 1e-3 * radial, *map(round, parts), measured)
        shown.append(tuple(f"{cell:g}" for cell in cells))
    return shown


def _counted() -> tuple[str, ...]:
    return tuple(
        f"{one['oil_volume']}, patch {one['length_over_hertz']:g} contacts" for one in found("load_share_curves")
    )


def _shares() -> list[tuple[str, ...]]:
    stored = found("load_share_curves")
    return [
        (
            f"{rows[0]['lambda']:.3g}",
            f"{1 - math.erf(rows[0]['lambda']):.3f}",
            *(f"{one['contact_share']:.3f}" for one in rows),
        )
        for rows in zip(*(one["rows"] for one in stored), strict=True)
        if rows[0]["lambda"] < 4
    ]


def _heights(films: Mapping[str, Any]) -> list[tuple[str, ...]]:
    by_length: dict[float, dict[float, str]] = {}
    for row in films["waves"]:
        by_length.setdefault(row["wavelength"], {})[row["amplitude"]] = f"{row['ours']:.3f}"
    return [
        (f"{length:g}", *(left.get(key, "-") for key in (0.0, 0.1, 0.2, 0.5))) for length, left in by_length.items()
    ]


def _inlets(films: Mapping[str, Any]) -> list[tuple[str, ...]]:
    return [(f"{row['M']:g}", f"{row['L']:g}", f"{row['grid'] / row['ours']:.2f}") for row in films["rolling"]]


def _depths(films: Mapping[str, Any]) -> list[tuple[str, ...]]:
    shown = []
    for row in films["dimples"]:
        depth = f"{1e9 * row['depth']:.0f}"
        if "figures" not in row:
            shown.append((row["kind"], depth, row["status"], "", ""))
        for name, own in row.get("figures", {}).items():
            shown.append((row["kind"], depth, _figure(name), f"{DIMPLES[row['kind']][name]:.0f}", f"{own['ours']:.0f}"))
    return shown


def _smooth(pitting: Mapping[str, Any]) -> list[tuple[str, ...]]:
    return [
        (_criterion(row), *(f"10^{row['decades'][key]:.1f}" for key in ("per factor e", READING)))
        for row in pitting["smooth"]
    ]


def _readings(pitting: Mapping[str, Any]) -> list[tuple[str, ...]]:
    shares: dict[str, dict[str, str]] = {}
    for row in pitting["pairs"]:
        shares.setdefault(_pair(row), {})[row["reading"]] = f"{row['pitted']:.1%}"
    return [
        (name, f"{published:.3%}", own.get("per factor e", "-"), own[READING])
        for published, (name, own) in zip(PITTED, shares.items(), strict=True)
    ]


RESULTS = ("traction_measured", "bearing_measured", "film_measured", "pitting_measured")
"""Stored results that are this page's own."""


def ages() -> str:
    """When each of them was last reproduced."""
    return "".join(age(name) for name in RESULTS if result_of(name).exists())
