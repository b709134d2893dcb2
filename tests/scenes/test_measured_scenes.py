"""Real instrument files through the kind `contact`: elastic and capped; unequal spacings; missing points."""

import json

import numpy as np
import pytest

from bem.campaigns.collect import outcome_of
from bem.errors import InputError, Status, SurfaceFileError
from bem.notes import has_code
from bem.notes.scenes import HEIGHT_UNIT_DOUBTFUL, MAP_ALTERED
from bem.runs import plan_scene
from bem.scenes import PlainContext, get_kind
from bem.scenes.checks import examine, scene_warnings

KIND = get_kind("contact")


def scene(lower, upper=None, **contact):
    data = {
        "kind": "contact",
        "grid": {"periodic": True},
        "lower": {"material": "steel-disk", "surface": {"kind": "measured", "path": str(lower)}},
        "upper": {"material": "steel-cylinder"},
        "contact": {"mean_pressure": "20 MPa"} | contact,
    }
    if upper is not None:
        data["upper"]["surface"] = {"kind": "measured", "path": str(upper)}
    return data


def run(data, settings=()):
    resolved, _ = plan_scene(data, settings)
    context = PlainContext(resolved.seed)
    return resolved, outcome_of(resolved, KIND.run(resolved, context)), context


@pytest.mark.internal
@pytest.mark.slow
def test_hard_pin_on_soft_disk_elastic_and_capped(measured):
    """`di-3` on `al3d-1`, resampled to the cells of `di-3`."""
    pair = scene(measured / "al3d-1.al3d", measured / "di-3.di")
    grid, elastic, context = run(pair)
    _, capped, _ = run(scene(measured / "al3d-1.al3d", measured / "di-3.di", behaviour="capped"))
    assert grid.grid.shape == (256, 256)
    area = grid.grid.shape[0] * grid.grid.spacing[0] * grid.grid.shape[1] * grid.grid.spacing[1]
    for outcome in (elastic, capped):
        assert outcome.status == Status.CONVERGED
        # the load is a constraint of the solver, met to round-off
        assert outcome.summary["load_N"] == pytest.approx(20e6 * area, rel=1e-9)
        assert outcome.variables["pressure"].values.min() == 0
    assert elastic.summary["max_pressure_Pa"] > 1.8e9, "the cap must matter on this pair"
    assert capped.summary["max_pressure_Pa"] == 1.8e9
    assert capped.summary["contact_area_m2"] > elastic.summary["contact_area_m2"]
    assert capped.summary["plastic_area_fraction"] > 0
    assert elastic.summary["plastic_area_fraction"] == 0
    altered = [note.where for note in scene_warnings(examine(grid)) if note.values.get("reason") == "seams-large"]
    small = [note.where for note in context.notes if has_code([note], MAP_ALTERED, reason="seams")]
    assert len(altered) + len(small) == 2  # each seam once, as a caution or as a remark


@pytest.mark.internal
@pytest.mark.slow
def test_unequal_spacings(measured):
    resolved, outcome, _ = run(scene(measured / "x3p-2.x3p"), ["grid.shape=[128, 96]", "lower.surface.mirror=both"])
    dx, dy = resolved.grid.spacing
    assert dx != dy
    assert outcome.status == Status.CONVERGED
    heights = outcome.variables["lower_height"].values
    np.testing.assert_array_equal(heights, heights[::-1])
    np.testing.assert_array_equal(heights, heights[:, ::-1])


@pytest.mark.internal
@pytest.mark.slow
def test_missing_points_are_filled_and_noted_or_refused(measured):
    _, outcome, context = run(scene(measured / "opd-1.opd"), ["grid.shape=128"])
    assert outcome.status == Status.CONVERGED
    assert any((note.code, note.values.get("reason")) == ("map-altered", "missing") for note in context.notes)
    with pytest.raises(SurfaceFileError, match="missing"):
        plan_scene(scene(measured / "opd-1.opd"), ["lower.surface.fill=false"])


@pytest.mark.parametrize("name", ["di-3.di", "al3d-1.al3d", "x3p-2.x3p", "opd-1.opd"])
def test_truncated_files_are_refused_in_one_message(measured, tmp_path, name):
    raw = (measured / name).read_bytes()
    for keep in (1, 100, len(raw) // 5):  # in the middle of the height map; some formats carry pictures after it
        path = tmp_path / name
        path.write_bytes(raw[:keep])
        with pytest.raises(InputError) as caught:
            plan_scene(scene(path))
        assert len(caught.value.messages) == 1
        assert name in caught.value.messages[0]


def test_an_empty_file_and_a_folder(tmp_path):
    (tmp_path / "empty.di").write_bytes(b"")
    for path, said in ((tmp_path / "empty.di", "empty"), (tmp_path, "no such file"), ("a\0b", "")):
        with pytest.raises(InputError) as caught:
            plan_scene(scene(path))
        (message,) = caught.value.messages
        assert message.startswith("lower.surface.path = ")
        assert said in message


@pytest.fixture
def plain_map(tmp_path):
    """A map of known heights: 40 x 30 cells of 1 um x 2 um, a wave and a tilt."""
    from bem.surfaces import Surface, write_surface

    x, y = np.arange(40)[:, None], np.arange(30)[None, :]
    heights = 1e-7 * np.sin(2 * np.pi * x / 20) * np.cos(2 * np.pi * y / 15) + 1e-8 * x
    path = tmp_path / "map.npz"
    write_surface(path, Surface(heights, (1e-6, 2e-6)))
    return path


@pytest.mark.internal
def test_grid_from_the_measured_map(plain_map):
    resolved, outcome, _ = run(scene(plain_map))
    assert resolved.grid.shape == (40, 30)
    assert resolved.grid.spacing == (1e-6, 2e-6)
    assert outcome.variables["lower_height"].values.shape == (40, 30)
    # the tilt is levelled away, but for the part of it that the wave looks like: half a wavelength short of two
    slope = np.polyfit(np.arange(40), outcome.variables["lower_height"].values.mean(axis=1), 1)[0]
    assert abs(slope) < 1e-17


@pytest.mark.internal
def test_grid_from_two_maps_is_the_finer_spacing_and_the_common_area(plain_map, tmp_path):
    from bem.surfaces import Surface, write_surface

    rng = np.random.default_rng(3)
    write_surface(tmp_path / "fine.npz", Surface(1e-7 * rng.standard_normal((60, 60)), (0.5e-6, 0.5e-6)))
    resolved, outcome, _ = run(scene(plain_map, tmp_path / "fine.npz"))
    assert resolved.grid.spacing == (0.5e-6, 0.5e-6)
    assert resolved.grid.shape == (60, 60)
    assert outcome.variables["lower_height"].values.shape == (60, 60)


@pytest.mark.internal
def test_mirrored_grid_is_twice_the_map_and_has_no_seam(plain_map):
    resolved, _, context = run(scene(plain_map), ["lower.surface.mirror=x"])
    assert resolved.grid.shape == (80, 30)
    assert any((note.code, note.values.get("reason")) == ("map-altered", "mirror") for note in context.notes)
    # a step at the seam was once left as it is, and the highest pressures lay on it
    assert any((note.code, note.values.get("reason")) == ("map-altered", "seams") for note in context.notes)
    with pytest.raises(InputError, match="even numbers of cells"):
        run(scene(plain_map), ["lower.surface.mirror=x", "grid.shape=[41, 30]", "grid.spacing=[1e-6, 2e-6]"])


@pytest.mark.internal
def test_a_grid_larger_than_the_map_is_refused(plain_map):
    with pytest.raises(InputError, match="the map"):
        run(scene(plain_map), ["grid.shape=64", "grid.spacing=1 um"])


@pytest.mark.internal
@pytest.mark.parametrize(
    ("mirror", "side", "said"),
    [
        ("none", 64, 'the map only 40 um; use 40 um or less along x, or mirror = "x" or "both" in its surface'),
        ("none", 100, "the map only 40 um; use 40 um or less along x"),
        ("y", 100, "the map only 40 um; use 40 um or less along x"),
        ("both", 100, "the mirrored map only 80 um; use 80 um or less along x"),
    ],
)
def test_a_grid_longer_than_a_map_is_told_the_longest(plain_map, mirror, side, said):
    """A mirrored map was told of half the grid, and to be mirrored."""
    data = scene(plain_map)
    data["lower"]["surface"]["mirror"] = mirror
    with pytest.raises(InputError) as caught:
        run(data, [f"grid.shape=[{side}, 32]", "grid.spacing=1 um"])
    assert list(caught.value.messages) == [f"map.npz: the grid is {side} um long along x, {said}"]


@pytest.mark.internal
def test_particles_take_the_keys_of_their_map(tmp_path):
    """Spacing and height unit of the table `map` were not read: the run refused what its plan had accepted."""
    heights = np.zeros((60, 50))
    heights[10:15, 20:30] = 100  # nm
    heights[40:44, 5:9] = 120
    heights[50, 40] = 4000
    np.savetxt(tmp_path / "plate.txt", heights)
    table = {"path": str(tmp_path / "plate.txt"), "spacing": ["20 nm", "25 nm"], "height_unit": "nm"}

    def found(**more):
        resolved, _ = plan_scene({"kind": "particles", "map": table | more, "separation": {"background": "none"}})
        kind = get_kind("particles")
        context = PlainContext(resolved.seed)
        return outcome_of(resolved, kind.run(resolved, context)), context.notes

    outcome, notes = found()
    assert outcome.variables["particle_volume"].values == pytest.approx([2.5e-21, 0.96e-21, 2e-21], rel=1e-9, abs=0)
    assert not has_code(notes, HEIGHT_UNIT_DOUBTFUL)
    assert found(crop=["1.2 um", "400 nm"])[0].summary["count"] == 1
    for wrong in ({"mirror": "x"}, {"detrend": "curvature"}, {"rms_height": "50 nm"}):
        with pytest.raises(InputError, match="particles"):
            found(**wrong)
    metres, doubts = found(height_unit=None)
    assert metres.summary["count"] == 3
    assert has_code(doubts, HEIGHT_UNIT_DOUBTFUL)


@pytest.mark.internal
def test_scaled_cropped_and_filtered(plain_map):
    _, outcome, _ = run(scene(plain_map), ["lower.surface.rms_height=50 nm", "lower.surface.crop=20 um"])
    heights = outcome.variables["lower_height"].values
    assert heights.shape == (20, 10)
    assert np.sqrt(np.mean(heights**2)) == pytest.approx(50e-9, rel=1e-12)
    _, smooth, _ = run(scene(plain_map), ["lower.surface.low_pass=100 um"])
    _, full, _ = run(scene(plain_map))
    assert smooth.variables["lower_height"].values.std() < 0.5 * full.variables["lower_height"].values.std()


@pytest.mark.internal
def test_not_a_number_heights_are_filled_or_refused(tmp_path):
    heights = np.zeros((20, 20))
    heights[3, 4] = np.nan
    heights[10, :] = 1e-8
    np.savez(tmp_path / "holes.npz", heights=heights, spacing=np.array([1e-6, 1e-6]))
    _, _, context = run(scene(tmp_path / "holes.npz"))
    assert any((note.code, note.values.get("reason")) == ("map-altered", "missing") for note in context.notes)
    with pytest.raises(InputError, match="1 of 400 points are missing"):
        plan_scene(scene(tmp_path / "holes.npz"), ["lower.surface.fill=false"])


def test_scene_with_paths_is_rerunnable_from_elsewhere(plain_map, tmp_path, monkeypatch):
    from bem.scenes import dump_scene, load_scene

    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path)
    resolved, _ = plan_scene(scene("map.npz"))
    (tmp_path / "here" / "scene.toml").write_text(dump_scene(resolved))
    monkeypatch.chdir(tmp_path / "here")
    assert load_scene("scene.toml") == resolved
    assert json.loads(json.dumps(resolved.lower.surface.path)) == str(plain_map)
