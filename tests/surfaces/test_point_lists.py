"""Texts with titles, and lists of points x, y, z: read in any order with the units of their columns, or refused."""

import numpy as np
import pytest

from bem import SurfaceFileError, read_surface
from bem.surfaces.point_list import column_units
from bem.surfaces.read import UnstatedScaleError

X, Y = np.meshgrid(0.5 * np.arange(40), 0.25 * np.arange(31), indexing="ij")
HEIGHTS = 100 * np.random.default_rng(1).standard_normal(X.shape)


def points(*, shuffled=True):
    rows = np.column_stack([X.ravel(), Y.ravel(), HEIGHTS.ravel()])
    return np.random.default_rng(2).permutation(rows) if shuffled else rows


def write(path, rows, title="", delimiter=" ", encoding="utf-8"):
    np.savetxt(path, rows, header=title, comments="", fmt="%.9g", delimiter=delimiter, encoding=encoding)
    return path


@pytest.mark.parametrize(
    ("name", "title", "delimiter", "encoding"),
    [
        ("a.txt", "x [um], y [um], z [nm]", " ", "utf-8"),
        ("a.csv", "Pin 3, measured today\nX (µm);Y (µm);Height (nm)", ";", "utf-8"),
        ("a.csv", "X (µm);Y (µm);Z (nm)", ";", "latin-1"),
        ("a.xyz", "# x/um y/um z/nm", "\t", "utf-8"),
        ("a.dat", "x_um,y_um,z_nm", ",", "utf-8"),
    ],
)
def test_a_list_in_any_order_has_the_units_of_its_columns(tmp_path, name, title, delimiter, encoding):
    found = read_surface(write(tmp_path / name, points(), title, delimiter, encoding), detrend="none")
    assert found.spacing == pytest.approx((0.5e-6, 0.25e-6), rel=1e-9, abs=0)
    np.testing.assert_allclose(found.heights, 1e-9 * HEIGHTS, rtol=1e-8)
    assert found.metadata["format"] == "list of points"


def test_a_list_without_units_takes_spacing_and_unit(tmp_path):
    file = write(tmp_path / "a.txt", points())
    with pytest.raises(UnstatedScaleError, match="how far its points are apart"):
        read_surface(file)
    found = read_surface(file, spacing=(1e-6, 0.5e-6), height_unit="nm", detrend="none")
    assert found.spacing == (1e-6, 0.5e-6)
    np.testing.assert_allclose(found.heights, 1e-9 * HEIGHTS, rtol=1e-8)
    with pytest.raises(SurfaceFileError, match="another ratio"):
        read_surface(file, spacing=(1e-6, 1e-6), height_unit="nm")
    with pytest.raises(SurfaceFileError, match=r"heights are in nm; height_unit 'um'"):
        read_surface(write(file, points(), "x [um] y [um] z [nm]"), height_unit="um")


def test_points_that_a_list_leaves_out_are_filled(tmp_path):
    found = read_surface(write(tmp_path / "a.txt", points()[30:], "x [um] y [um] z [nm]"))
    assert found.shape == X.shape
    assert found.metadata["missing_points"] == 30


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ((5, 0, 0.13), r"x = 0\.13 is not a whole number of steps of 0\.5 from 0"),
        ((5, 1, np.nan), "y = nan"),
    ],
)
def test_an_irregular_list_is_refused_with_the_point(tmp_path, change, said):
    rows = points(shuffled=False)
    row, column, value = change
    rows[row, column] = value
    for title in ("", "x [um], y [um], z [nm]"):
        with pytest.raises(SurfaceFileError, match=said) as refused:
            read_surface(write(tmp_path / "a.txt", rows, title), spacing=(0.5e-6, 0.25e-6))
        assert len(refused.value.messages) == 1


def test_scattered_points_and_points_measured_twice_are_refused(tmp_path):
    twice = np.vstack([points(), points()[:1]])
    with pytest.raises(SurfaceFileError, match="two heights at x = "):
        read_surface(write(tmp_path / "a.txt", twice, "x [um], y [um], z [nm]"))
    diagonal = np.column_stack([np.arange(200.0), np.arange(200.0), np.zeros(200)])
    with pytest.raises(SurfaceFileError, match="most of 200 x 200 places without a height"):
        read_surface(write(tmp_path / "a.txt", diagonal, "x [um], y [um], z [nm]"))


def test_titles_above_a_table_are_passed_over_but_not_a_spoilt_line(tmp_path):
    file = write(tmp_path / "a.txt", HEIGHTS, "Height map of pin 3, measured 2026-11-02\nnm")
    found = read_surface(file, spacing=(1e-6, 1e-6), height_unit="nm", detrend="none")
    np.testing.assert_allclose(found.heights, 1e-9 * HEIGHTS, rtol=1e-8)
    file.write_text("1 2 bad 4\n" + "1 2 3 4\n" * 5)
    with pytest.raises(SurfaceFileError, match="bad"):
        read_surface(file, spacing=(1e-6, 1e-6))


def test_names_of_columns():
    assert column_units(["# made today", "x [um], y [um], z [nm]"]) == ("um", "um", "nm")
    assert column_units(["x y z"]) == ("", "", "")
    assert column_units(["x [um], y [um]"]) is None
    assert column_units(["zinc oxide, hydrated"]) is None
