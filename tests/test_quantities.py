"""Prefixes of units and numbers with units: one table for texts, tables and axes."""

import math

import pytest

from bem.errors import InputError
from bem.quantities import (
    digits_apart,
    plain_digits,
    prefix_for,
    prefixed,
    si,
    with_prefixes,
    with_signs,
    with_unit,
)

pytestmark = pytest.mark.internal


@pytest.mark.parametrize(
    ("largest", "unit", "factor", "shown"),
    [
        (3e-6, "m", 1e6, "µm"),
        (999.96, "m", 1e-3, "km"),  # four digits show 1000
        (0.2, "m/s", 1e3, "mm/s"),
        (2e9, "Pa", 1e-9, "GPa"),
        (3e-12, "m²", 1e12, "µm²"),
        (4.0, "m³", 1.0, "m³"),
        (4e6, "m²", 1.0, "m²"),  # no prefix above one
        (450.0, "nm", 1.0, "nm"),
        (4500.0, "nm", 1e-3, "µm"),
        (2e-15, "N", 1e12, "pN"),
        (0.0, "m", 1.0, "m"),
        (5e5, "1", 1.0, ""),
        (5e5, "1/s", 1.0, "1/s"),
    ],
)
def test_the_largest_value_decides_the_prefix(largest, unit, factor, shown):
    found = prefix_for(largest, unit)
    assert found == (pytest.approx(factor), shown)


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (45e-9, "m", "45 nm"),
        (1e9, "Pa", "1 GPa"),
        (999.9, "N", "1 kN"),
        (-2.5e-6, "m", "-2.5 um"),
        (1e-12, "m", "1e-12 m"),
        (0.0, "m", "0 m"),
        (float("inf"), "Pa", "inf Pa"),
    ],
)
def test_a_text_has_a_prefix_from_nano_to_giga(value, unit, text):
    assert si(value, unit) == text


@pytest.mark.parametrize(
    ("raw", "text"),
    [
        ("stress -9e+09 Pa, beyond 8.21429e+09 Pa", "stress -9 GPa, beyond 8.21429 GPa"),
        ("at most 1.05e-07 m; a speed of 5e-05 m/s", "at most 105 nm; a speed of 50 um/s"),
        ("a width of 0.00025 m, a length of 0.001207 m", "a width of 250 um, a length of 1.207 mm"),
        ("between 1e-06 and 2e-06 m", "between 1e-06 and 2e-06 m"),
        ('"1e-9 m" is no load; 1e-15 m^2/N and 2e-05 Pa*s', '"1e-9 m" is no load; 1e-15 m^2/N and 2e-05 Pa*s'),
        ("a spacing of 0.5 m holds 1e+06 cells", "a spacing of 0.5 m holds 1e+06 cells"),
    ],
)
def test_numbers_of_refusals_have_prefixed_units(raw, text):
    """Of several numbers before one unit none is changed, or they would differ in their units."""
    assert prefixed(raw) == text
    assert InputError(raw).messages == (text,)


def test_units_without_prefixes_are_written_as_they_are():
    assert with_unit(1234.5, "kg/m^3") == "1.23e+03 kg/m^3"
    assert with_unit(0.36, "Pa*s") == "360 mPa*s"
    assert with_unit(0.3, "") == "0.3"
    assert with_signs("um^2") == "µm²"
    assert (plain_digits(110.4), plain_digits(float("nan")), plain_digits(1234.5, 3)) == ("110", "–", "1230")


def test_all_ways_of_writing_micro_are_one_unit():
    found = with_prefixes("m", "uk")
    assert found == {"m": 0, "um": -6, "µm": -6, "μm": -6, "km": 3}


def test_rows_of_a_table_get_digits_that_tell_them_apart():
    load, radius = [1274.1, 1274.9, 1300.0, 1274.1], [4.77, 4.77, 4.77, 4.77 * (1 + 1e-12)]
    assert digits_apart([load, radius]) == [4, 3]
    assert digits_apart([[1.0, 1.0], [math.nan, math.nan]]) == [3, 3]
    assert digits_apart([[1.0004, 1.0001], [2.0, 2.004]]) == [3, 4]  # the column in which they differ most
    assert digits_apart([[1.0, 2.0], [5.00001, 5.00002]]) == [3, 3]  # told apart by another column
    assert digits_apart([[1.0, 1.0 + 1e-7]]) == [3]
    assert digits_apart([]) == []
    # three rows alike in three digits
    assert digits_apart([[1.0001, 1.0004, 1.00044]]) == [6]
