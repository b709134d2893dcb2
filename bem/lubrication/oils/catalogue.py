"""Names and grades of oils, and what each stands for, from `catalogue.toml`."""

from __future__ import annotations

import dataclasses
import difflib
import re
import tomllib
from collections.abc import Callable, Mapping
from functools import cache
from importlib.resources import files
from typing import Any

from bem.errors import InputError
from bem.lubrication.oils.index import viscosity_at_40, viscosity_at_100
from bem.lubrication.oils.oil import Line, Oil
from bem.lubrication.oils.over_temperature import LAWS, MM2_S, OverTemperature, ViscosityTable, Walther
from bem.lubrication.oils.pressure import PressureViscosity
from bem.lubrication.rheology import rheology_of
from bem.physical_constants import ZERO_CELSIUS

_T40, _T100 = 40.0 + ZERO_CELSIUS, 100.0 + ZERO_CELSIUS
_ISO = re.compile(r"(?:iso ?vg|iso|vg) ?(\d{1,5})")
_ISO_OF_BASE = re.compile(
    r"(mineral|naphthenic|ester|pag|traction) ?(?:iso ?vg|iso|vg)? ?(\d{1,5})|(pao) ?(?:iso ?vg|iso|vg) ?(\d{1,5})"
)
"""Base and ISO grade; PAO 4 and the like count the viscosity at 100 degC."""
_MULTIGRADE = re.compile(r"(?:sae )?(\d{1,3}) ?w ?(\d{1,3})")
_MONOGRADE = re.compile(r"sae ?(\d{1,3})")
_LEAST_INDEX = 95.0


@cache
def _data() -> dict[str, Any]:
    return tomllib.loads(files("bem.lubrication.oils").joinpath("catalogue.toml").read_text(encoding="utf-8"))


def bases() -> dict[str, str]:
    """Bases of oils, and what each is."""
    return {name: table["what"] for name, table in _data()["base"].items()}


def correlations() -> tuple[str, ...]:
    """Names of the correlations of the pressure-viscosity coefficient."""
    return tuple(_data()["pressure_viscosity"])


@cache
def oil_names() -> tuple[str, ...]:
    """All names that `find_oil` knows, multigrades as examples."""
    data = _data()
    iso = [f"ISO VG {number}" for number in data["grades"]["iso"]["numbers"]]
    engine = [f"SAE {number}" for number in data["grades"]["sae_engine"]["ranges"]]
    engine += ["SAE 0W-20", "SAE 5W-30", "SAE 10W-40", "SAE 15W-40", "SAE 20W-50"]
    gear = [f"SAE {number}" for number in data["grades"]["sae_gear"]["ranges"]]
    gear += ["SAE 75W-90", "SAE 80W-90", "SAE 85W-140"]
    return (*iso, *engine, *gear, *data["oil"], "water-glycol 46")


def find_oil(name: str, *, viscosity_index: float | None = None, base: str | None = None) -> Oil:
    """The oil of a name or grade: "ISO VG 68", "VG68", "SAE 30", "5W-30", "75W-90", "PAO 6", "squalane",
    "water", "water-glycol 46"; case, blanks and hyphens do not matter. "PAG 68" is ISO VG 68 of base
    pag, as "ester 32" and "mineral 100" are of theirs.

    Parameters
    ----------
    name : the oil or its grade.
    viscosity_index : in place of the usual one of the grade's base; multigrades have at least what their W asks for.
    base : of an ISO grade: "mineral" (paraffinic, the default), "naphthenic", "pao", "ester", "pag", "water-glycol" or
        "traction".

    Raises
    ------
    InputError : an unknown name, with the nearest known one; an index or base where the name has its own, or one that
        no oil has.
    """
    if not isinstance(name, str):
        raise InputError(f"oil {name!r}: must be a name or a grade, such as {oil_names()[5]!r}")
    if base is not None and base not in _data()["base"]:
        raise InputError(f"oil base {base!r}: unknown; choose from {', '.join(_data()['base'])}")
    plain = " ".join(re.sub(r"[-_./]", " ", name.lower()).split())
    if plain.startswith("water glycol"):
        plain, base = "vg " + plain.removeprefix("water glycol").removeprefix(" iso vg").strip(" vg"), "water-glycol"
    if match := _ISO_OF_BASE.fullmatch(plain):
        named, number = (one for one in match.groups() if one is not None)
        if base not in (None, named):
            raise InputError(f'oil "{name[:60]}": has its own base {named}; leave base = "{base}" out')
        plain, base = f"vg {number}", named
    makers: tuple[tuple[re.Pattern[str], Callable[..., Oil]], ...] = (
        (_ISO, _iso_grade),
        (_MULTIGRADE, _multigrade),
        (_MONOGRADE, _monograde),
    )
    for pattern, make in makers:
        if match := pattern.fullmatch(plain):
            return make(name, *map(int, match.groups()), viscosity_index=viscosity_index, base=base)
    for known, table in _data()["oil"].items():
        if _squeezed(known) == _squeezed(name):
            if viscosity_index is not None or base is not None:
                raise InputError(f"oil {known!r}: has its own viscosity index and base; leave them out")
            return _named(known, table)
    raise _unknown(name)


def oil_from_viscosities(
    points: Mapping[float, float],
    *,
    name: str = "own oil",
    base: str = "mineral",
    law: str | None = None,
) -> Oil:
    """An oil of measured kinematic viscosities.

    Parameters
    ----------
    points : kinematic viscosities [m^2/s] by temperature [K].
    name : what to call it.
    base : whose density, heat capacity, conductivity and correlation of the pressure-viscosity coefficient it takes.
    law : "walther" (two points, the default for two), "vogel" (three), "andrade" (two) or "table" (the default).

    Raises
    ------
    InputError : an unknown base or law, too few points, viscosities that do not fall with temperature.
    """
    if base not in _data()["base"]:
        raise InputError(f"oil base {base!r}: unknown; choose from {', '.join(_data()['base'])}")
    law = law or ("walther" if len(points) == 2 else "table")
    if law not in LAWS:
        raise InputError(f"oil law {law!r}: unknown; choose from {', '.join(LAWS)}")
    return _made(name, base, LAWS[law].through(tuple(points.items())), "given", {})


def correlation(name: str) -> PressureViscosity:
    """A correlation of the pressure-viscosity coefficient by its name.

    Raises
    ------
    InputError : an unknown one.
    """
    table = _data()["pressure_viscosity"].get(name)
    if table is None:
        raise InputError(f"pressure-viscosity correlation {name!r}: unknown; choose from {', '.join(correlations())}")
    cold, hot = table["temperature"]
    return PressureViscosity(
        name,
        table["source"],
        dynamic=table["of"] == "dynamic",
        factor=table.get("factor", 0.0),
        exponent=table.get("exponent", 0.0),
        slope_exponent=table.get("slope_exponent", 0.0),
        logarithm=tuple(table["logarithm"]) if "logarithm" in table else None,
        viscosity=tuple(table["viscosity"]),
        temperature=(cold + ZERO_CELSIUS, hot + ZERO_CELSIUS),
        pressure=1e9 * table.get("pressure", 0.0),
        error=table["error"],
    )


def _squeezed(name: str) -> str:
    return re.sub(r"[^a-z0-9]", "", name.lower())


_PAG = 'allowed: "PAG 220" and other ISO grades'
_NO_OIL = {
    "grease": "grease has no entry: take its base oil, by grade or viscosities from the maker's sheet, and a table "
    "[supply] where the contact starves",
    **dict.fromkeys(("pag", "polyglycol", "polyalkylene"), f"the grade is missing: {_PAG}"),
}
"""Lubricants that are not in the catalogue, and what to give instead."""


def _unknown(name: str) -> InputError:
    words = re.findall("[a-z]+", name.lower())
    if "glycol" in words:
        return InputError(f'oil "{name[:60]}": the grade is missing; allowed: "water-glycol 46" and other ISO grades')
    for word, advice in _NO_OIL.items():
        if word in words:
            return InputError(f'oil "{name[:60]}": {advice}')
    match = re.fullmatch(r"pao(\d+)", _squeezed(name))
    if match and int(match[1]) in _data()["grades"]["iso"]["numbers"]:
        return InputError(
            f'oil "{name[:60]}": unknown, as PAO grades are viscosities at 100 degC; allowed: "PAO VG {match[1]}", the '
            "ISO grade"
        )
    known = {_squeezed(one): one for one in oil_names()}
    close = difflib.get_close_matches(_squeezed(name), known, n=1, cutoff=0.6)
    hint = f' - did you mean "{known[close[0]]}"?' if close else ""
    return InputError(
        f'oil "{name[:60]}": unknown{hint}; allowed: ISO VG, SAE and PAO grades, squalane, esters, water, water-glycol '
        "(`bem oils` lists them), or viscosities of your own"
    )


def _iso_grade(name: str, number: int, *, viscosity_index: float | None, base: str | None) -> Oil:
    grade, base = _data()["grades"]["iso"], base or "mineral"
    if number not in grade["numbers"]:
        near = min(grade["numbers"], key=lambda one: abs(one - number))
        if number > max(grade["numbers"]) and number % 10 == 0 and number // 10 in grade["numbers"]:
            near = number // 10  # a digit too many
        raise InputError(
            f'oil "{name[:60]}": no such grade - did you mean "ISO VG {near}"?; allowed: '
            + ", ".join(map(str, grade["numbers"]))
        )
    table = _data()["base"][base]
    index = table.get("viscosity_index") if viscosity_index is None else viscosity_index
    if index is None:
        raise InputError(f'oil "{name[:60]}": viscosity_index is missing; {base} fluids differ, see the maker\'s sheet')
    title = {"mineral": f"ISO VG {number}", "pao": f"pao VG {number}"}.get(base, f"{base} {number}")
    given = "given" if viscosity_index is not None else table["viscosity_index_source"]
    law = _from_index(float(number), viscosity_at_100(number, index))
    return _made(title, base, law, f"{grade['source']}; index {index:g} ({given}), ASTM D2270", {})


def _monograde(name: str, number: int, *, viscosity_index: float | None, base: str | None) -> Oil:
    grade, v100 = _sae(name, number)
    index = _LEAST_INDEX if viscosity_index is None else viscosity_index
    law = _from_index(viscosity_at_40(v100, index), v100)
    given = "given" if viscosity_index is not None else "usual of straight grades"
    return _made(f"SAE {number}", base or "mineral", law, f"{grade['source']}; index {index:g} ({given})", {})


def _multigrade(name: str, winter: int, number: int, *, viscosity_index: float | None, base: str | None) -> Oil:
    grade, v100 = _sae(name, number)
    cold = grade["winter"].get(str(winter))
    if cold is None:
        allowed = ", ".join(f"{one}W" for one in grade["winter"])
        raise InputError(f'oil "{name[:60]}": no such W grade beside {number}; allowed: {allowed}')
    density = _line("density", _data()["base"][base or "mineral"])
    least = _least_index(v100, cold + ZERO_CELSIUS, grade["limit"] / density(cold + ZERO_CELSIUS))
    index = max(least, _LEAST_INDEX) if viscosity_index is None else viscosity_index
    law = _from_index(viscosity_at_40(v100, index), v100)
    given = "given" if viscosity_index is not None else grade["index_source"]
    return _made(
        f"SAE {winter}W-{number}", base or "mineral", law, f"{grade['source']}; index {index:.0f}: {given}", {}
    )


def _sae(name: str, number: int) -> tuple[Mapping[str, Any], float]:
    grades = [_data()["grades"][key] for key in ("sae_engine", "sae_gear")]
    for grade in grades:
        if str(number) in grade["ranges"]:
            low, high = grade["ranges"][str(number)]
            return grade, 0.5 * (low + high)
    numbers = [key for grade in grades for key in grade["ranges"]]
    near = min(numbers, key=lambda one: abs(int(one) - number))
    raise InputError(
        f'oil "{name[:60]}": no such SAE grade - did you mean "SAE {near}"?; allowed: {", ".join(numbers)}'
    )


def _from_index(v40: float, v100: float) -> Walther:
    return Walther.through(((_T40, v40 * MM2_S), (_T100, v100 * MM2_S)))


def _least_index(v100: float, cold: float, largest: float) -> float:
    """The least index with which the kinematic viscosity at a temperature [K] is no larger [m^2/s], by bisection."""
    low, high = 0.0, 400.0
    for _ in range(50):
        middle = 0.5 * (low + high)
        thick = _from_index(viscosity_at_40(v100, middle), v100).kinematic(cold) > largest
        low, high = (middle, high) if thick else (low, middle)
    return high


def _named(name: str, table: Mapping[str, Any]) -> Oil:
    law: OverTemperature
    if "temperatures" in table:
        pairs = zip(table["temperatures"], table["viscosities"], strict=True)
        law = LAWS[table.get("law", ViscosityTable.name)].through([(t + ZERO_CELSIUS, v * MM2_S) for t, v in pairs])
    elif "viscosity" in table:
        law = _from_index(*table["viscosity"])
    elif "viscosity_100" in table:
        law = _from_index(viscosity_at_40(table["viscosity_100"], table["viscosity_index"]), table["viscosity_100"])
    else:
        law = _from_index(table["viscosity_40"], viscosity_at_100(table["viscosity_40"], table["viscosity_index"]))
    return _made(name, table["base"], law, table["source"], table)


def _made(name: str, base: str, law: OverTemperature, source: str, own: Mapping[str, Any]) -> Oil:
    table = {**_data()["base"].get(base, {}), **own}
    alpha = correlation(table["pressure_viscosity"]) if "pressure_viscosity" in table else None
    if alpha is not None and "pressure_viscosity_source" in table:
        alpha = dataclasses.replace(alpha, source=f"{table['pressure_viscosity_source']}: {alpha.source}")
    limits = {
        key: table[key] + ZERO_CELSIUS
        for key in ("freezing_point", "flash_point", "boiling_point", "largest_service")
        if key in table
    }
    return Oil(
        name,
        base,
        law,
        source,
        _line("density", table),
        _line("heat_capacity", table),
        _line("thermal_conductivity", table),
        alpha,
        **limits,
        limits_source=table.get("limits_source", ""),
        shear=rheology_of(base, own.get("shear", {})),
    )


def _line(key: str, table: Mapping[str, Any]) -> Line:
    at, value, slope = table[key]
    return Line(at + ZERO_CELSIUS, value, slope, table[f"{key}_source"])
