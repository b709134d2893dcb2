"""Measured files: real ones, damaged ones, plain maps; one kind of error."""

import os

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from bem import Grid, InputError, ResultsError, Surface, SurfaceFileError, describe_surface, read_surface
from bem.surfaces import resample, write_surface

# as in the data's own table: cells, spacing [m], Sq [m], Ssk, Sku, rms slope; to the digits given there
TABLE = {
    "al3d-1.al3d": ((200, 296), (438e-9, 438e-9), 290e-9, 0.0, 3.1, 0.09),
    "tmd-1.tmd": ((300, 300), (63e-9, 63e-9), 74e-9, -0.3, 1.9, 0.16),
    "di-3.di": ((256, 256), (39e-9, 39e-9), 35e-9, -0.4, 5.7, 0.19),
    "x3p-2.x3p": ((650, 650), (128e-9, 315e-9), 77e-9, -0.4, 3.0, 0.06),
    "opd-1.opd": ((640, 480), (197e-9, 197e-9), 6.7e-9, -0.4, 4.5, 0.02),
}


@pytest.mark.parametrize("name", TABLE)
def test_real_files(measured, name):
    shape, spacing, rms, skewness, kurtosis, slope = TABLE[name]
    surface = read_surface(measured / name)
    got = describe_surface(surface.heights, surface.spacing)
    assert surface.shape == shape
    assert surface.spacing == pytest.approx(spacing, rel=0.005)
    assert got.Sq == pytest.approx(rms, rel=0.01)
    assert got.Ssk == pytest.approx(skewness, abs=0.05)
    assert got.Sku == pytest.approx(kurtosis, abs=0.06)  # filled points of opd-1 add nothing to its tails
    assert got.Sdq == pytest.approx(slope, abs=0.005)
    assert abs(surface.heights.mean()) < 1e-2 * rms
    assert surface.metadata["file"] == name
    assert surface.metadata["detrend"] == "plane"


def test_missing_points(measured):
    surface = read_surface(measured / "opd-1.opd")
    assert surface.metadata["missing_points"] == 116
    assert np.isfinite(surface.heights).all()
    with pytest.raises(SurfaceFileError, match="116 of 307200 points are missing"):
        read_surface(measured / "opd-1.opd", fill=False)


def test_detrending(measured):
    raw, plane, curved = (
        read_surface(measured / "tmd-1.tmd", detrend=d).heights for d in ("none", "plane", "curvature")
    )
    assert raw.std() > plane.std() > curved.std()
    x = np.arange(300) - 149.5
    assert abs((plane * x[:, None]).mean()) < 1e-6 * plane.std() * x.std()
    assert abs((plane * x[None, :]).mean()) < 1e-6 * plane.std() * x.std()
    assert abs((curved * (x**2 - np.mean(x**2))[:, None]).mean()) < 1e-6 * curved.std() * x.std() ** 2


def test_channels(measured):
    default = read_surface(measured / "di-3.di")
    assert default.metadata["channel"] == "ZSensor"
    other = read_surface(measured / "di-3.di", channel="Height")
    assert other.metadata["channel"] == "Height"
    # two sensors saw the same surface
    assert np.corrcoef(default.heights.ravel(), other.heights.ravel())[0, 1] > 0.9
    with pytest.raises(SurfaceFileError, match=r"unit of length|does not say its unit"):
        read_surface(measured / "di-3.di", channel="Phase")
    with pytest.raises(SurfaceFileError, match="ZSensor"):
        read_surface(measured / "di-3.di", channel="Depth")


def test_orientation_of_unequal_spacing(measured):
    """x3p-2 is finer along x; its slopes and lengths must come out with the spacing of their own axis."""
    surface = read_surface(measured / "x3p-2.x3p")
    assert surface.lengths == pytest.approx((82.98e-6, 204.5e-6), rel=1e-3)


def test_onto_a_scene_grid(measured):
    surface = read_surface(measured / "al3d-1.al3d", detrend="curvature")
    grid = Grid((240, 240), (102e-9, 102e-9))
    patch = resample(surface, grid)
    assert patch.shape == grid.shape
    window = surface.heights[72:128, 120:176]
    assert patch.heights.std() == pytest.approx(window.std(), rel=0.05)  # the same 24 um, up to a cell's rim


# --- damaged files -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", TABLE)
def test_truncated_files(measured, tmp_path, name):
    data = (measured / name).read_bytes()
    whole = read_surface(measured / name).heights
    path = tmp_path / name
    for share in (0.0, 0.001, 0.05, 0.3):
        path.write_bytes(data[: int(share * len(data))])
        with pytest.raises(SurfaceFileError) as caught:
            read_surface(path)
        assert str(path) in str(caught.value)
        assert caught.value.exit_code == 2
    for share in (0.7, 0.9999):
        path.write_bytes(data[: int(share * len(data))])
        try:
            heights = read_surface(path).heights
        except SurfaceFileError:
            continue
        # only an image of the surface, stored behind the heights, was cut
        np.testing.assert_array_equal(heights, whole)


@settings(max_examples=35, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.sampled_from(sorted(TABLE)),
    st.lists(st.tuples(st.floats(0, 1), st.integers(0, 255)), max_size=20),
    st.booleans(),
    st.floats(0, 1),
    st.sampled_from([None, *sorted(TABLE)]),
)
def test_corrupted_files_give_one_kind_of_error(measured, tmp_path, name, changes, header_only, keep, disguise):
    data = bytearray((measured / name).read_bytes())
    span = min(len(data), 4096) if header_only else len(data)
    for where, value in changes:
        data[int(where * (span - 1))] = value
    path = tmp_path / (disguise or name)
    path.write_bytes(data[: max(1, int(keep * len(data)))] if keep < 0.9 else data)
    surface, problem = None, None
    try:
        surface = read_surface(path)
    except SurfaceFileError as caught:
        problem = caught
    if surface is None:
        assert len(problem.messages) == 1
        assert "\n" not in problem.messages[0]
    else:
        assert np.isfinite(surface.heights).all()
        assert min(surface.spacing) > 0


def test_readers_neither_warn_nor_print(measured, tmp_path, capfd):
    path = tmp_path / "cut.opd"
    path.write_bytes((measured / "opd-1.opd").read_bytes()[:3000])
    with pytest.raises(SurfaceFileError):
        read_surface(path)
    assert capfd.readouterr() == ("", "")


@settings(max_examples=35, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.binary(max_size=300),
    st.sampled_from(
        [b"", b"PK\x03\x04", b"\x93NUMPY\x01\x00", b"1 2 3\n4 5 6\n", b"\x89HDF\r\n\x1a\n", b"AliconaImaging"]
    ),
    st.sampled_from([".npz", ".npy", ".txt", ".csv", ".asc", ".x3p", ".nc", ".mat", ".xyz", ".sur", ""]),
    st.booleans(),
)
def test_any_bytes_give_one_kind_of_error(tmp_path, content, start, suffix, with_spacing):
    path = tmp_path / f"any{suffix}"
    path.write_bytes(start + content)
    surface = None
    try:
        surface = read_surface(path, spacing=(1e-6, 1e-6) if with_spacing else None)
    except SurfaceFileError:
        return
    assert np.isfinite(surface.heights).all()


def test_instrument_text(tmp_path):
    """A line is one iy there; the header's units hold."""
    heights = np.arange(12.0).reshape(3, 4)
    path = tmp_path / "g.asc"
    lines = ["# Channel: Height", "# Width: 2 µm", "# Height: 3 µm", "# Value units: nm"]
    path.write_text("\n".join([*lines, *("\t".join(f"{v:.3f}" for v in row) for row in heights)]), encoding="utf-8")
    surface = read_surface(path, detrend="none")
    assert surface.shape == (4, 3)
    assert surface.spacing == pytest.approx((0.5e-6, 1e-6))
    np.testing.assert_allclose(surface.heights, 1e-9 * heights.T, atol=1e-18)
    np.savetxt(path, heights)
    with pytest.raises(SurfaceFileError, match="how far its points are apart"):
        read_surface(path)
    assert "spacing_in_file" not in surface.metadata
    bare = read_surface(path, detrend="none", spacing=(1e-7, 2e-7), height_unit="nm")
    np.testing.assert_allclose(bare.heights, 1e-9 * heights.T, atol=1e-18)


def test_units_that_contradict_the_file_are_not_swallowed():
    """A unit of the heights was ignored without a word, and a spacing replaced the file's."""
    path = "example/ground-disk.al3d"
    own = read_surface(path)
    with pytest.raises(SurfaceFileError, match=r"says that its heights are in .*height_unit 'km'"):
        read_surface(path, height_unit="km")
    other = read_surface(path, spacing=(1e-3, 1e-3))
    assert other.metadata["spacing_in_file"] == pytest.approx(list(own.spacing))
    assert other.spacing == (1e-3, 1e-3)
    rounded = tuple(1.004 * side for side in own.spacing)
    assert "spacing_in_file" not in read_surface(path, spacing=rounded).metadata


def test_maps_in_metres_take_no_other_unit(tmp_path):
    """Heights of a map that this package had written were multiplied by 1e-6 without a word."""
    path = write_surface(tmp_path / "map.npz", Surface(np.eye(4), (1e-6, 1e-6)))
    with pytest.raises(SurfaceFileError, match=r"says that its heights are in m; height_unit 'um'"):
        read_surface(path, height_unit="um")
    np.testing.assert_array_equal(read_surface(path, height_unit="m", detrend="none").heights, np.eye(4))


def test_what_is_no_surface(tmp_path):
    with pytest.raises(SurfaceFileError, match="no such file"):
        read_surface(tmp_path / "nothing.di")
    with pytest.raises(SurfaceFileError, match="folder"):
        read_surface(tmp_path)
    with pytest.raises(SurfaceFileError, match=r"cannot be opened|no such file"):
        read_surface("a\0b")
    empty = tmp_path / "empty.x3p"
    empty.touch()
    with pytest.raises(SurfaceFileError, match="empty"):
        read_surface(empty)
    for name, content in (("photo.png", b"\x89PNG\r\n\x1a\n" + bytes(500)), ("note.txt", b"dear reader\n" * 40)):
        (tmp_path / name).write_bytes(content)
        # the letter could be a table without its spacing: with it, it is none either
        with pytest.raises(SurfaceFileError, match=r"unreadable|how far its points are apart"):
            read_surface(tmp_path / name)
        with pytest.raises(SurfaceFileError, match="unreadable"):
            read_surface(tmp_path / name, spacing=(1e-6, 1e-6))


@pytest.mark.skipif(os.geteuid() == 0, reason="root reads everything")
def test_unreadable_by_permission(tmp_path):
    path = tmp_path / "locked.di"
    path.write_bytes(b"x")
    path.chmod(0)
    with pytest.raises(SurfaceFileError, match="cannot be opened"):
        read_surface(path)


def test_arguments(tmp_path):
    with pytest.raises(InputError) as caught:
        read_surface(tmp_path / "x.di", detrend="linear", height_unit="furlong", spacing=(0, 1))
    assert len(caught.value.messages) == 3


# --- plain maps --------------------------------------------------------------------------------------------------


def test_npz_round_trip(tmp_path):
    heights = np.random.default_rng(0).normal(size=(12, 9)) * 1e-8
    path = write_surface(tmp_path / "map", Surface(heights, (1e-7, 2e-7), {"seed": 3}))
    assert path.name == "map.npz"
    again = read_surface(path, detrend="none")
    np.testing.assert_array_equal(again.heights, heights)
    assert again.spacing == (1e-7, 2e-7)
    assert again.metadata["seed"] == 3
    assert list(tmp_path.iterdir()) == [path]
    for cut in (10, 100, len(path.read_bytes()) - 30):
        broken = tmp_path / "broken.npz"
        broken.write_bytes(path.read_bytes()[:cut])
        with pytest.raises(SurfaceFileError, match="unreadable"):
            read_surface(broken)
    np.savez(tmp_path / "other.npz", z=heights)
    with pytest.raises(SurfaceFileError, match="no array 'heights'"):
        read_surface(tmp_path / "other.npz")
    np.savez(tmp_path / "bare.npz", heights=heights)
    with pytest.raises(SurfaceFileError, match="how far its points are apart"):
        read_surface(tmp_path / "bare.npz")


def test_write_errors(tmp_path):
    with pytest.raises(ResultsError, match="cannot write"):
        write_surface(tmp_path / "none" / "map.npz", Surface(np.zeros((2, 2)), (1.0, 1.0)))


def test_tables(tmp_path):
    heights = np.random.default_rng(0).normal(size=(6, 4)) * 1e-8
    for suffix, separator in ((".csv", ","), (".csv", ";"), (".txt", " "), (".dat", "\t")):
        path = tmp_path / f"map{suffix}"
        np.savetxt(path, heights, delimiter=separator, header="heights in m")
        got = read_surface(path, spacing=(1e-7, 3e-7), detrend="none")
        np.testing.assert_allclose(got.heights, heights, rtol=1e-15)
        assert got.spacing == (1e-7, 3e-7)
    np.savetxt(path, heights * 1e9)
    nanometres = read_surface(path, spacing=(1e-7, 3e-7), detrend="none", height_unit="nm")
    np.testing.assert_allclose(nanometres.heights, heights, rtol=1e-12)
    with pytest.raises(SurfaceFileError):  # a table without spacing says neither lengths nor units
        read_surface(path)
    path.write_text("1 2 3\n4 5\n")
    with pytest.raises(SurfaceFileError, match="same number of values"):
        read_surface(path, spacing=(1.0, 1.0))
    path.write_text("1 2 3\n")
    with pytest.raises(SurfaceFileError, match="not a height map"):
        read_surface(path, spacing=(1.0, 1.0))
    path.write_text("1 nan\nnan nan\n")
    with pytest.raises(SurfaceFileError, match="points are missing"):
        read_surface(path, spacing=(1.0, 1.0))


def test_npy(tmp_path):
    np.save(tmp_path / "map.npy", np.eye(4))
    with pytest.warns(UserWarning, match="height_unit"):  # a metre high on a micrometre
        assert read_surface(tmp_path / "map.npy", spacing=(1e-6, 1e-6), detrend="none").heights[0, 0] == 1
    np.save(tmp_path / "text.npy", np.array([["a", "b"]]))
    with pytest.raises(SurfaceFileError, match="not a map"):
        read_surface(tmp_path / "text.npy", spacing=(1e-6, 1e-6))


def test_a_list_of_points_is_not_taken_for_a_map_three_points_wide(tmp_path):
    x, y = np.meshgrid(np.arange(4.0), 0.5 * np.arange(3), indexing="ij")
    file = tmp_path / "points.txt"
    np.savetxt(file, np.column_stack([x.ravel(), y.ravel(), np.sin(x * y).ravel()]))
    assert read_surface(file, spacing=(2e-6, 1e-6), height_unit="nm").heights.shape == (4, 3)
    narrow = np.random.default_rng(0).normal(size=(12, 3))
    np.savetxt(file, narrow)
    assert read_surface(file, spacing=(1e-6, 1e-6), height_unit="nm").heights.shape == (12, 3)


@pytest.mark.parametrize(
    ("text", "told"),
    [("1 2 3 4\n4 -- 6 5\n", "line 2: '--' is no number"), ("1 2 3 4\n4 6 5\n", "line 2 has 3 values")],
)
def test_a_text_with_a_gap_says_the_line_and_what_stands_for_it(tmp_path, text, told):
    (tmp_path / "a.txt").write_text(text + "1 2 3 4\n" * 3)
    with pytest.raises(SurfaceFileError, match=f"{told}.*write nan for missing points"):
        read_surface(tmp_path / "a.txt", spacing=(1e-6, 1e-6), height_unit="nm")


def test_heights_without_a_unit_that_are_no_surface_in_metres_warn(tmp_path):
    """A table in nanometres was read as metres, Sq 0.3 m, without a word; the command line refuses it."""
    heights = 300 * np.random.default_rng(0).standard_normal((16, 12))
    np.savetxt(tmp_path / "a.txt", heights)
    with pytest.warns(UserWarning, match='height_unit="nm"'):
        bare = read_surface(tmp_path / "a.txt", spacing=5e-7, detrend="none")
    assert bare.heights == pytest.approx(heights, rel=1e-12)
    pair = read_surface(tmp_path / "a.txt", spacing=(5e-7, 5e-7), height_unit="nm")  # pytest makes warnings errors
    one = read_surface(tmp_path / "a.txt", spacing=5e-7, height_unit="nm")
    assert one.spacing == pair.spacing == (5e-7, 5e-7)
    assert np.array_equal(one.heights, pair.heights)
