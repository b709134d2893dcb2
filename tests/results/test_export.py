"""Runs and sweeps as tidy tables: rows in the order of what was varied, units in the head, same numbers in netCDF."""

import csv

import numpy as np
import pytest
import xarray
from command_line import run_command
from small_scenes import CONTACT

from bem import InputError, ResultsError
from bem.results.dataset import read_dataset
from bem.results.export import _laid_out, points_of
from bem.results.read import open_run
from bem.runs import run_scene, run_sweep

pytestmark = pytest.mark.internal

PRESSURES = ["40 MPa", "80 MPa"]


def test_a_run_over_keys_is_a_row_for_each(tmp_path):
    run = run_scene(CONTACT | {"over": {"contact.mean_pressure": PRESSURES}}, tmp_path / "run", figures=False)
    points = points_of(tmp_path / "run")
    np.testing.assert_allclose(points.columns["contact.mean_pressure"], [40e6, 80e6])
    np.testing.assert_array_equal(points.columns["contact_area_fraction"], run.summary["contact_area_fraction"])
    assert "pressure" not in points.columns, "fields are no figures"
    rows = list(csv.reader(points.csv().splitlines()))
    assert "contact.mean_pressure [Pa]" in rows[0]
    assert "contact_area_fraction" in rows[0]
    at = rows[0].index("contact_area_fraction")
    assert [float(row[at]) for row in rows[1:]] == run.summary["contact_area_fraction"]
    points.write_netcdf(tmp_path / "points.nc")
    back = read_dataset(tmp_path / "points.nc")
    assert back["contact_mean_pressure"].attrs["units"] == "Pa"
    np.testing.assert_array_equal(back["contact_area_fraction"], run.summary["contact_area_fraction"])
    with pytest.raises(InputError, match="no contact_load"):
        points.load_share()


def test_a_sweep_is_the_same_table_and_the_command_writes_it(tmp_path):
    scene = CONTACT | {"description": "at 40 MPa"}
    sweep = run_sweep(scene, ["contact.mean_pressure=40 MPa,80 MPa"], tmp_path / "sweep", workers=1)
    assert sweep.figures["over"] == {"contact.mean_pressure": "Pa"}  # what the command prints
    assert sweep.figures["contact.mean_pressure"] == [40e6, 80e6]
    for point in (tmp_path / "sweep" / "points").iterdir():
        described = open_run(point).scene["description"]
        assert described == "at 40 MPa (changed: contact.mean_pressure)"
        summary = open_run(point).summary
        assert summary["contact_area_fraction"] in sweep.figures["contact_area_fraction"]
    points = points_of(sweep.path)
    np.testing.assert_allclose(points.columns["contact.mean_pressure"], [40e6, 80e6])
    assert (np.diff(points.columns["contact_area_fraction"]) > 0).all()
    done = run_command("export", sweep.path, "--csv", "--out", tmp_path / "out", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["sweep-points.csv"]
    with pytest.raises(ResultsError, match="no such folder"):
        points_of(tmp_path / "none")


def stribeck(temperatures, speeds):
    """A dataset as a run of kind friction has it, whose contact share is exp(-0.6 Lambda^1.4)."""
    ratio = np.outer(1 / np.array([1.0, 4.0]), np.array(speeds) ** 0.7)[:, None, :] * 3
    share = np.exp(-0.6 * ratio**1.4)
    dims, units = ("oil.temperature", "load", "speed"), {"units": "N", "long_name": "load"}
    return xarray.Dataset(
        {
            "lambda_ratio": (dims, ratio, {"units": "1"}),
            "contact_load": (dims, 5.5 * share, units),
            "film_load": (dims, 5.5 * (1 - share), units),
        },
        {
            "oil.temperature": ("oil.temperature", temperatures, {"units": "K"}),
            "load": ("load", [5.5], {"units": "N"}),
            "speed": ("speed", speeds, {"units": "m/s"}),
        },
    )


def test_load_share_temperature_and_slide_roll_ratio():
    data = stribeck([313.15, 353.15], [0.01, 0.1, 0.5, 1.0])
    names = ["lambda_ratio", "contact_load", "film_load"]
    scene = {"speeds": {"first": 0.01, "last": 1.0, "cylinder": 0.5}, "oil": {"grade": "VG 68", "temperature": "20 C"}}
    points = _laid_out(data, names, ("oil.temperature", "load", "speed"), scene, "made up")
    assert points.columns["speed"].tolist() == [0.01, 0.1, 0.5, 1.0] * 2
    assert points.columns["oil.temperature"].tolist() == [313.15] * 4 + [353.15] * 4, "varied, not the scene's own"
    np.testing.assert_allclose(points.columns["slide_roll_ratio"], 2 * 0.5 / 1.5)
    fit = points.load_share()
    assert (fit.b, fit.c) == (pytest.approx(0.6, rel=1e-6), pytest.approx(1.4, rel=1e-6))
    by_slip = scene | {"speeds": {"first": 0.01, "last": 1.0, "slide_roll_ratio": 0.02}}
    slipping = _laid_out(data, names, ("oil.temperature", "load", "speed"), by_slip, "made up")
    np.testing.assert_allclose(slipping.columns["slide_roll_ratio"], 0.02, rtol=1e-12)
    cold = _laid_out(data.isel({"oil.temperature": 0}, drop=True), names, ("load", "speed"), scene, "made up")
    np.testing.assert_allclose(cold.columns["oil.temperature"], 293.15)


@pytest.mark.parametrize(
    ("key", "values", "expected"),
    [
        ("speeds.slide_roll_ratio", [0.02, 0.5], [0.02, 0.5]),
        ("speeds.cylinder", [0.98, 0.5], [2 * 0.02 / 1.98, 2 * 0.5 / 1.5]),
    ],
)
def test_a_varied_slide_roll_ratio_is_that_of_its_own_rows(key, values, expected):
    data = xarray.Dataset({"friction": ((key,), [0.1, 0.2], {"units": "1"})}, {key: (key, values, {"units": "1"})})
    points = _laid_out(data, ["friction"], (key,), {"speeds": {"values": [1.0]}}, "made up")
    np.testing.assert_allclose(points.columns["slide_roll_ratio"], expected)
