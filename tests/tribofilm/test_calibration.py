"""Calibration: it recovers what made the data within its own error bars, and says when data are too few."""

from dataclasses import replace

import numpy as np
import pytest

from bem import InputError
from bem.tribofilm.calibrate import FITTED, Measurement, ReducedModel, calibrate, read_measurements

pytestmark = pytest.mark.internal

TRUTH = ReducedModel()


def synthetic(seed, relative=0.02, model=TRUTH):
    rng = np.random.default_rng(seed)
    exact = [
        Measurement(temperature + 273.15, 60.0 * minutes, 0.0, quantity)
        for temperature in (60, 80, 100)
        for quantity in ("thickness", "wear_depth")
        for minutes in (5, 10, 15, 30, 45, 60, 90, 120)
    ]
    values = model.predict(exact)
    return [
        replace(m, value=float(v * (1 + relative * rng.standard_normal())), error=float(relative * v))
        for m, v in zip(exact, values, strict=True)
    ]


@pytest.mark.slow
def test_parameters_come_back_within_their_error_bars():
    """Six parameters: 3.5 standard deviations are exceeded once in 360 such tests."""
    start = replace(TRUTH, activation_energy_eV=0.68, activation_volume_A3=50.0, wear_coefficient_1_s=9e-4)
    start = replace(start, film_hardness_GPa=3.0, hardness_length_nm=45.0, concentration_constant_1_m=1e7)
    fit = calibrate(synthetic(0), start)
    assert fit.determined, fit.verdict()
    assert fit.chi_square / fit.degrees == pytest.approx(1.0, abs=0.75)  # 3.5 deviations for 42 degrees
    assert np.allclose(np.diag(fit.correlation), 1.0)
    found = np.array([getattr(fit.model, name) for name in FITTED])
    truth = np.array([getattr(TRUTH, name) for name in FITTED])
    pulls = (found - truth) / fit.uncertainty
    assert np.abs(pulls).max() < 3.5
    assert np.abs(pulls).mean() > 0.2  # error bars that are far too wide would be wrong as well


@pytest.mark.slow
def test_two_wear_depths_do_not_determine_the_model():
    """The two published depths (thesis, paper E, table 3)."""
    data = [
        Measurement(333.15, 7200.0, 86.3e-9, "wear_depth", 2700.0, 1e-9),
        Measurement(373.15, 7200.0, 45.8e-9, "wear_depth", 2700.0, 1e-9),
    ]
    fit = calibrate(data, TRUTH)
    assert not fit.determined
    assert "Underdetermined" in fit.verdict()
    assert np.isinf(fit.uncertainty).sum() >= 4
    # with two parameters left the two numbers can be met, and they are
    both = calibrate(data, TRUTH, ("film_hardness_GPa", "hardness_length_nm"))
    assert both.determined
    assert np.abs(both.residuals).max() < 1e-10


def test_a_table_with_units_is_read(tmp_path):
    path = tmp_path / "film.csv"
    path.write_text(
        "# a comment\ntemperature [degC],time [min],thickness [nm],wear_depth [nm],since [min],error [nm]\n"
        "60,45,50,,,2\n100,120,210,45.8,45,3\n"
    )
    data = read_measurements(path)
    assert [m.quantity for m in data] == ["thickness", "thickness", "wear_depth"]
    assert data[0] == Measurement(333.15, 2700.0, 50 * 1e-9, "thickness", 0.0, 2 * 1e-9)
    assert data[2].since == 2700.0
    assert data[2].value == pytest.approx(45.8e-9)


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("", "no data"),
        ("temperature [degC],time [min],thickness [furlong]\n60,1,1\n", "furlong"),
        ("temperature [degC],time [min],colour [nm]\n60,1,1\n", "colour"),
        ("temperature [degC],time [min],thickness [nm]\n60,soon,1\n", "soon"),
        ("temperature [degC],thickness [nm]\n60,1\n", "'time'"),
        ("temperature [degC],time [min],thickness [nm]\n-300,1,1\n", "0 K"),
    ],
)
def test_bad_tables_are_refused_with_the_place(tmp_path, text, word):
    path = tmp_path / "film.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=word):
        read_measurements(path)
    with pytest.raises(InputError, match="cannot be read"):
        read_measurements(tmp_path / "absent.csv")


def test_unknown_parameters_are_refused():
    with pytest.raises(InputError, match="allowed"):
        calibrate(synthetic(0), TRUTH, ("magic",))


def exact(*times):
    data = [Measurement(temperature + 273.15, 60.0 * minutes, 0.0) for temperature in (60, 100) for minutes in times]
    return [replace(m, value=float(v)) for m, v in zip(data, TRUTH.predict(data), strict=True)]


def test_rows_at_time_zero_are_taken_and_left_out_of_the_fit():
    later = exact(15, 45, 120)
    start = [Measurement(333.15, 0.0, 0.0), Measurement(373.15, 0.0, 0.0)]
    with_start, without = (calibrate(data, TRUTH, ("activation_energy_eV",)) for data in (start + later, later))
    assert with_start.model == without.model
    assert with_start.degrees == without.degrees
    assert with_start.uncertainty == pytest.approx(without.uncertainty)
    assert "2 data at time zero tell nothing" in with_start.verdict()
    thick = calibrate([Measurement(333.15, 0.0, 20e-9), *later], TRUTH, ("activation_energy_eV",))
    assert "starts without the 20 nm" in thick.verdict()
    with pytest.raises(InputError, match="all 2 data are at time zero"):
        calibrate(start, TRUTH)


def test_a_bad_fit_is_said_to_be_one():
    good = exact(15, 45, 120)
    assert calibrate(good, TRUTH, ("activation_energy_eV",)).misfit == ""
    wrong = [replace(m, value=m.value * (3 if m.time < 3600 else 0.4)) for m in good]
    fit = calibrate(wrong, TRUTH, ("activation_energy_eV",))
    assert "The fit is bad: the data lie" in fit.verdict()
    with_errors = [replace(m, error=0.02 * m.value) for m in wrong]
    assert "degrees of freedom has a probability" in calibrate(with_errors, TRUTH, ("activation_energy_eV",)).verdict()
    assert calibrate([replace(m, error=0.02 * m.value) for m in good], TRUTH, ("activation_energy_eV",)).misfit == ""


def test_a_parameter_at_the_end_of_its_range_is_named():
    data = [replace(m, value=m.value * 1e-4, error=1e-14) for m in exact(15, 45)]
    start = replace(TRUTH, wear_coefficient_1_s=1e-9)
    assert "wear_coefficient_1_s ran to the end" in calibrate(data, start, ("wear_coefficient_1_s",)).verdict()


def test_the_lines_of_a_scene_are_the_fit():
    """They stand in for those of a built-in scene, which then has the constants."""
    import tomllib

    from bem import load_scene
    from bem.scenes import library

    fit = calibrate(exact(15, 45, 120), TRUTH, ("activation_energy_eV", "film_hardness_GPa"))
    lines = tomllib.loads(fit.scene_lines())
    table = library()["tribofilm-macro"]
    table["film"] |= lines["film"]
    table["rubbing"] |= lines["rubbing"]
    film = load_scene(table).film
    assert film.activation_energy == pytest.approx(fit.model.activation_energy_eV * 1.602176634e-19, rel=1e-5, abs=0)
    assert film.hardness.film == pytest.approx(1e9 * fit.model.film_hardness_GPa, rel=1e-5)
    assert film.hardness.length == pytest.approx(1e-9 * fit.model.hardness_length_nm, rel=1e-5)


def test_a_factor_on_the_whole_curve_reaches_growth_and_the_scene():
    import math
    import tomllib

    model = replace(TRUTH, temperature_slope=2e-3, substrate_temperature_slope=1e-3)
    # bare substrate at 100 degrees: 6 GPa times 1 - 1e-3 * 75, a share of 0.8 of it, friction 0.1
    stress = 0.1 * 0.8 * 6e9 * (1 - 1e-3 * 75)
    barrier = (0.665 * 1.602176634e-19 - stress * 53e-30) / (1.380649e-23 * 373.15)
    assert model.growth_rate(373.15)(0.0) == pytest.approx(1e-2 * math.exp(-barrier), rel=1e-9)
    assert TRUTH.growth_rate(373.15)(0.0) > 1.3 * model.growth_rate(373.15)(0.0)
    fit = calibrate(exact(15, 45, 120), model, ("film_hardness_GPa",))
    hardness = tomllib.loads(fit.scene_lines())["film"]["hardness"]
    assert (hardness["temperature_slope"], hardness["substrate_temperature_slope"]) == (2e-3, 1e-3)
