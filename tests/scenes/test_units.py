"""Quantities: strings with units or SI numbers come in, SI floats come out, everything else is refused in words."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import BaseModel, ValidationError

from bem.scenes import units

pytestmark = pytest.mark.internal


class Everything(BaseModel):
    length: units.Length = 0.0
    force: units.Force = 0.0
    pressure: units.Pressure = 0.0
    inverse: units.PressureViscosity = 0.0
    temperature: units.Temperature = 0.0
    ratio: units.Ratio = 0.0
    wear: units.WearCoefficient = 0.0
    viscosity: units.Viscosity = 0.0
    energy: units.Energy = 0.0
    volume: units.Volume = 0.0


# Equality is exact: a quantity is rounded once, as the literal on the right is.
@pytest.mark.parametrize(
    ("key", "text", "value"),
    [
        ("length", "45 nm", 45e-9),
        ("length", "0.1um", 0.1e-6),
        ("length", "1e3 µm", 1e-3),
        ("length", "-2.5 mm", -2.5e-3),
        ("length", 3, 3.0),
        ("force", "10 N", 10.0),
        ("pressure", "1.8 GPa", 1.8e9),
        ("pressure", "3 N/mm^2", 3e6),
        ("inverse", "25 1/GPa", 25e-9),
        ("inverse", "25 GPa^-1", 25e-9),
        ("temperature", "60 degC", 333.15),
        ("temperature", 300, 300.0),
        ("ratio", "12 %", 0.12),
        ("ratio", "0.3", 0.3),
        ("wear", "350e-7 mm^3/(N m)", 350e-13 * 1e-3 * 1e3 * 1e-3 * 1e-1 * 10),
        ("wear", "350e-7 mm3/(N m)", 350e-13 * 1e-3 * 1e3 * 1e-3 * 1e-1 * 10),
        ("wear", "350e-7 mm^3/Nm", 350e-13 * 1e-3 * 1e3 * 1e-3 * 1e-1 * 10),
        ("viscosity", "36 mPa s", 0.036),
        ("viscosity", "55 cP", 0.055),
        ("energy", "0.8 eV", 0.8 * 1.602176634e-19),
        ("volume", "85 angstrom^3", 85e-30),
    ],
)
def test_converted(key, text, value):
    found = getattr(Everything.model_validate({key: text}), key)
    if key in ("wear", "energy"):  # the literals above are products: a few roundings
        assert math.isclose(found, value, rel_tol=1e-14)
    else:
        assert found == value


@pytest.mark.parametrize(
    ("value", "said"),
    [
        ("45", "has no unit"),
        ("45 N", "is not a length"),
        ("45 nmm", 'unknown unit "nmm" (did you mean "nm"?)'),
        ("five nm", "not a number followed by a unit"),
        ("nan nm", "not a number followed by a unit"),
        ("1e999 m", "is not finite"),
        (math.nan, "is not finite"),
        (math.inf, "is not finite"),
        (10**400, "is not finite"),
        (True, "not a number"),
        ([1.0], "not a number"),
        ("", "not a number"),
        ("3 m^99", "unknown unit"),
        ("3 m**9**9", "unknown unit"),
        ("3 m*10", "unknown unit"),
        ("3 __import__('os').getcwd()", "unknown unit"),
        ("20 degC", "is not a length"),
    ],
)
def test_refused(value, said):
    with pytest.raises(ValidationError) as caught:
        Everything.model_validate({"length": value})
    (mistake,) = caught.value.errors()
    assert said in mistake["msg"]
    assert 'allowed: a length such as "45 nm"' in mistake["msg"]


def test_temperature_difference_scales_are_not_mixed_up():
    with pytest.raises(ValidationError, match="unknown unit"):
        Everything.model_validate({"temperature": "5 degF/m"})


@given(
    st.floats(allow_nan=False, allow_infinity=False, min_value=-1e30, max_value=1e30),
    st.sampled_from(["nm", "um", "m"]),
)
@settings(deadline=None, max_examples=60)
def test_same_as_decimal_arithmetic(number, unit):
    from decimal import Decimal

    power = {"nm": -9, "um": -6, "m": 0}[unit]
    wanted = float(Decimal(repr(number)) * Decimal(10) ** power)
    assert Everything.model_validate({"length": f"{number!r} {unit}"}).length == wanted


@given(st.text(max_size=30))
@settings(deadline=None, max_examples=150)
def test_no_text_escapes(text):
    """Any text is a number in metres or refused with a message; nothing else comes out of the parser."""
    try:
        value = Everything.model_validate({"length": "7 " + text}).length
    except ValidationError:
        return
    assert math.isfinite(value)


def test_usual_units_are_those_of_the_registry(monkeypatch):
    """Every usual unit, and every product and quotient of two: dimensions and factor to the last of fifteen digits."""
    from bem.scenes import units, usual_units

    names = list(usual_units._UNITS)
    texts = names + [f"{a}{sign}{b}" for a in names for sign in "*/" for b in names[::3]]
    texts += [
        "1/GPa",
        "m^2",
        "mm**2",
        "m^2/N",
        "mm^3/(N*m)",
        "N*s/m^2",
        "1 / Pa",
        "eV/nm^3",
        "kg/m^3",
        "1/N*m",
        "m/s/s",
    ]
    found = {text: usual_units.usual_unit(text) for text in texts}
    assert None not in found.values()
    monkeypatch.setattr(units, "usual_unit", lambda text: None)
    units._unit.cache_clear()
    assert {text: units._unit(text) for text in texts} == found
    units._unit.cache_clear()


@pytest.mark.parametrize("text", ["", "1", "m/", "/m", "*m", "1*m", "m m", "furlong", "m^9", "m^-1", "(m)", "m**2**2"])
def test_other_units_are_left_to_the_registry(text):
    from bem.scenes.usual_units import usual_unit

    assert usual_unit(text) is None
