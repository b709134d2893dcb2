"""First scenes on measured surfaces: they plan without a caution and run to an end inside the model."""

import math
import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from bem.campaigns import campaign_of, compute
from bem.cli import build as command_line
from bem.errors import InputError
from bem.grid import Grid
from bem.notes import Level
from bem.runs import plan_scene
from bem.scenes import build
from bem.scenes.checks import examine, outcome_warnings, scene_warnings
from bem.scenes.starts import start_scene
from bem.scenes.template import scene_template
from bem.surfaces import Surface, generate_surface, write_surface
from bem.surfaces.examples import FOLDER

FILES = {"lower": "example/ground-disk.al3d", "upper": "example/polished-pin.x3p"}


@pytest.mark.parametrize("kind", ["contact", "friction", "running-in", "running-in-life", "wear"])
def test_a_scene_on_own_surfaces_plans_without_a_caution(kind, tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(scene_template(kind, surfaces=FILES, folder=tmp_path))
    scene, _ = plan_scene(path)
    assert scene.lower.surface.path.endswith("ground-disk.al3d")
    assert scene.lower.surface.despike == 6
    assert not [
        note for note in scene_warnings(examine(scene)) if note.level != Level.INFO and note.code != "patch-short"
    ]


def test_the_mesh_has_the_cells_of_the_coarser_map_and_holds_the_contact(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(scene_template("running-in", surfaces=FILES, folder=tmp_path))
    grid = build.grid_of(plan_scene(path)[0].grid)
    assert grid.spacing == pytest.approx((0.8e-6, 0.8e-6))
    assert 102.4e-6 > grid.lengths[0] > 4 * 13.8e-6  # Hertz radius of the first scene


@pytest.mark.parametrize("kind", ["running-in", "running-in-life", "wear"])
def test_cells_larger_than_the_points_of_the_maps_have_a_comment(kind, tmp_path, monkeypatch):
    """The guide said that the first scene has the cells of the coarser map: 0.4 um maps had cells of 0.5 um."""
    monkeypatch.setattr("bem.scenes.own_surfaces._MOST_CELLS", 64)
    text = " ".join(scene_template(kind, surfaces=FILES, folder=tmp_path).replace("#", " ").split())
    assert "Larger than the points of the maps, 0.8 um, to keep the run short" in text
    assert ("domain.cells = 124" if kind == "wear" else "grid.shape = 124, grid.spacing = 0.8 um") in text


@pytest.mark.parametrize("kind", ["running-in", "friction"])
def test_summits_within_three_rms_heights_lie_on_the_grid(kind, tmp_path):
    """With an Sq of three Hertz approaches summits touched at the ends of a grid of 3.4 lengths of Hertz' contact."""
    path = tmp_path / "mine.toml"
    path.write_text(scene_template(kind, surfaces=FILES, folder=tmp_path))
    scene, _ = plan_scene(path)
    facts = examine(scene)
    end, radius = 0.5 * build.grid_of(scene.grid).lengths[0], scene.contact.ball
    both = math.hypot(*(surface.rms_height for _, surface in facts.surfaces[:2]))
    assert end**2 / (2 * radius) - facts.cases[0].smooth.semi_axes[0] ** 2 / (2 * radius) > 3.0 * both


def test_a_contact_larger_than_the_maps_shrinks_at_the_same_pressure(tmp_path):
    """The first friction scene has a contact of 139 um, larger than the maps of 102 um."""
    path = tmp_path / "mine.toml"
    path.write_text(scene_template("friction", surfaces=FILES, folder=tmp_path))
    scene, usual = plan_scene(path)[0], plan_scene(start_scene("friction"))[0]
    (smaller,), (larger,) = (
        [case.smooth for case in examine(one).cases[:1] if case.smooth is not None] for one in (scene, usual)
    )
    assert smaller.maximum_pressure == pytest.approx(larger.maximum_pressure, rel=0.05)
    assert 2 * smaller.semi_axes[0] < build.grid_of(scene.grid).lengths[0] <= 102.4e-6


def test_a_life_on_own_surfaces_keeps_the_pressure_and_slides_as_its_patch_passes(tmp_path):
    """`--lower` was refused for lives."""
    path = tmp_path / "mine.toml"
    path.write_text(scene_template("running-in-life", surfaces=FILES, folder=tmp_path))
    scene, usual = plan_scene(path)[0], plan_scene(start_scene("running-in-life"))[0]
    smaller, larger = (examine(one).cases[0].smooth for one in (scene, usual))
    assert smaller.maximum_pressure == pytest.approx(larger.maximum_pressure, rel=0.05)
    grid = build.grid_of(scene.grid)
    assert 2 * smaller.semi_axes[0] < grid.lengths[0] <= 102.4e-6
    assert grid.spacing == pytest.approx((0.8e-6, 0.8e-6))
    # a place of either body slides while it crosses the patch at its own speed, not at the mean of both
    (lower, upper), wear = *scene.speeds.build(), scene.wear
    slid = [grid.lengths[0] * abs(lower - upper) / own for own in (lower, upper)]
    assert wear.distance == pytest.approx(slid[0], rel=1e-3, abs=0)  # written in four digits
    rates = wear.rates((scene.lower.build(), scene.upper.build()), 0.1)
    assert rates[1] / rates[0] == pytest.approx(slid[1] / slid[0], rel=1e-5)


def test_own_surfaces_run_in_inside_the_model_with_particles(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(scene_template("running-in", surfaces=FILES, folder=tmp_path))
    cycles = plan_scene(path)[0].cycles
    assert (cycles.averaged, cycles.settled) == (41, 41)  # 124 cells at 3 a cycle: a whole turn of the roughness
    few = ["cycles.count=12", "cycles.settled=4", "cycles.averaged=10", "cycles.coarser_grid=false"]
    campaign = campaign_of(plan_scene(path, few)[0])
    outcome = compute(campaign).outcome
    summary = outcome.summary
    assert 0 < summary["Sq_final_nm"][0] < summary["Sq_initial_nm"][0]
    assert summary["particle_equivalent_radius_nm"][0] > 0
    assert summary["particles_per_cycle"][0] > 0
    roughness = outcome.variables["Sq_over_cycles"].values.ravel()
    assert roughness.size == 12
    assert 1e9 * roughness[-1] == pytest.approx(summary["Sq_final_nm"][0], rel=1e-12)  # one definition
    assert 1e9 * roughness[0] == pytest.approx(summary["Sq_initial_nm"][0], rel=0.02)  # smooth from cycle to cycle
    scene = campaign.scene
    slid = scene.wear.criterion.distance_per_cycle(0.0)
    (per_metre,) = summary["particles_per_distance_per_m"]
    assert per_metre == pytest.approx(summary["particles_per_cycle"][0] / slid, rel=1e-12)
    worn = summary["criterion_wear_rate_mm3_Nm"][0] * scene.load  # mm3 a metre
    assert summary["particles_per_volume_per_mm3"][0] == pytest.approx(per_metre / worn, rel=1e-9)
    notes = outcome_warnings(examine(campaign.scene), outcome)
    assert [note for note in notes if note.level == Level.OUTSIDE_MODEL] == []


def test_the_command_writes_paths_from_the_folder_of_the_scene(tmp_path, monkeypatch):
    shutil.copy(FOLDER / "ground-disk.al3d", tmp_path / "disk.al3d")
    (tmp_path / "runs").mkdir()
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(command_line(), ["new", "contact", "runs/mine.toml", "--lower", "disk.al3d"])
    assert done.exit_code == 0, done.output
    scene, _ = plan_scene(tmp_path / "runs" / "mine.toml")
    assert scene.lower.surface.kind == "measured"
    assert 'path = "../disk.al3d"' in (tmp_path / "runs" / "mine.toml").read_text()


def _map(path, heights, spacing):
    return str(write_surface(path, Surface(heights, spacing)))


def test_maps_that_are_too_small_or_full_of_holes_are_refused_with_what_to_do(tmp_path, monkeypatch):
    grid = Grid((32, 32), (0.4e-6, 0.4e-6), periodic=(True, True))
    heights = generate_surface(grid, rms_height=50e-9, correlation_length=1e-6, seed=1)
    small = _map(tmp_path / "small.npz", heights, grid.spacing)
    with pytest.raises(InputError, match=r"30 points of 400 nm across the contact.*larger maps"):
        scene_template("running-in", surfaces={"lower": small}, folder=tmp_path)
    monkeypatch.syspath_prepend(str(Path(__file__).parents[1] / "surfaces"))
    import make_examples

    cells = make_examples.CELLS
    heights = 1e-7 * np.random.default_rng(1).standard_normal((cells, cells)).astype(np.float32)
    heights[:, :40] = np.nan
    make_examples.write_al3d(tmp_path / "holes.al3d", heights)
    with pytest.raises(InputError, match=r"31 % of the points are missing.*measure again"):
        scene_template("running-in", surfaces={"lower": str(tmp_path / "holes.al3d")}, folder=tmp_path)
    with pytest.raises(InputError, match="traction"):
        scene_template("traction", surfaces=FILES, folder=tmp_path)


def plain_table(folder, ending, unit):
    """A map of 128 x 128 points 0.5 um apart as numbers alone, and its heights [m]."""
    heights = generate_surface(
        Grid((128, 128), (0.5e-6, 0.5e-6), periodic=(True, True)), rms_height=1e-7, seed=3, correlation_length=8e-6
    )
    path = folder / f"disk{ending}"
    np.save(path, heights / unit) if ending == ".npy" else np.savetxt(
        path, heights / unit, delimiter=";" if ending == ".csv" else " "
    )
    return path, heights


@pytest.mark.parametrize("ending", [".txt", ".csv", ".npy"])
def test_files_of_plain_numbers_take_spacing_and_unit(ending, tmp_path):
    path, heights = plain_table(tmp_path, ending, 1e-9)
    scene = tmp_path / "mine.toml"
    given = ["new", "contact", str(scene), "--lower", str(path)]
    for options, missing in (
        ([], 'give --spacing and --height-unit, such as --spacing "0.5 um"'),
        (["--spacing", "0.5 um"], "give --height-unit, such as nm"),
        (["--height-unit", "nm"], 'apart; give --spacing, such as --spacing "0.5 um"'),
        (["--spacing", "1", "--height-unit", "nm"], "a number alone is in metres); allowed: up to 1 mm, with its unit"),
        (["--spacing", "0.5 um", "--height-unit", "yards"], '--height-unit "yards": allowed: m,'),
    ):
        result = CliRunner().invoke(command_line(), [*given, *options])
        assert result.exit_code != 0
        assert missing in str(result.exception) + result.output
    result = CliRunner().invoke(command_line(), [*given, "--spacing", "0.5 um", "--height-unit", "nm"])
    assert result.exit_code == 0, result.output
    planned, _ = plan_scene(scene)
    grid = build.grid_of(planned.grid)
    assert grid.shape == (128, 128)
    assert grid.spacing == pytest.approx((0.5e-6, 0.5e-6), rel=1e-9, abs=0)
    assert planned.lower.surface.height_unit == "nm"
    found = build.heights_of(planned.lower.surface, grid, 0, lambda note: None)
    assert found.std() == pytest.approx(heights.std(), rel=0.2, abs=0)  # form is removed


def test_one_height_unit_for_two_files_is_doubted(tmp_path):
    """A map in metres read in nm had "the size of an atom", and nothing said that one option held for both files."""
    disk, _ = plain_table(tmp_path, ".txt", 1e-9)
    pin, _ = plain_table(tmp_path, ".npy", 1.0)
    given = ["new", "contact", str(tmp_path / "mine.toml"), "--lower", str(disk), "--upper", str(pin)]
    result = CliRunner().invoke(command_line(), [*given, "--spacing", "0.5 um", "--height-unit", "nm"])
    assert result.exit_code == 0, result.output
    assert "nm; an atom is 0.2 nm wide" in result.output
    assert "--height-unit held for both files." in result.output


def test_a_scale_is_for_the_file_that_does_not_say_it(tmp_path):
    """The other body's file keeps its own; where both files say it, a scale is refused."""
    path, _ = plain_table(tmp_path, ".txt", 1e-6)
    scale = ["--spacing", "0.5 um,0.5 um", "--height-unit", "um"]
    scene = tmp_path / "mine.toml"
    both = ["new", "contact", str(scene), "--upper", "example/polished-pin.x3p"]
    refused = CliRunner().invoke(command_line(), [*both, *scale])
    assert "the files say both" in str(refused.exception) + refused.output
    assert CliRunner().invoke(command_line(), [*both, "--lower", str(path), *scale]).exit_code == 0
    planned, _ = plan_scene(scene)
    assert planned.lower.surface.spacing == pytest.approx((0.5e-6, 0.5e-6), rel=1e-9, abs=0)
    assert planned.upper.surface.spacing is None


def test_a_contact_of_maps_of_unequal_spacing_has_the_cells_of_the_coarser(tmp_path):
    """0.5 um beside 0.2 um: nothing of the coarser map is interpolated, and the plan has no caution on it."""
    write_surface(tmp_path / "fine.npz", Surface.generate(
        Grid((256, 256), (0.2e-6, 0.2e-6), periodic=(True, True)), rms_height=5e-8, seed=4, correlation_length=2e-6
    ))  # fmt: skip
    write_surface(tmp_path / "coarse.npz", Surface.generate(
        Grid((160, 160), (0.5e-6, 0.5e-6), periodic=(True, True)), rms_height=1e-7, seed=5, correlation_length=4e-6
    ))  # fmt: skip
    files = {"lower": str(tmp_path / "coarse.npz"), "upper": str(tmp_path / "fine.npz")}
    scene = tmp_path / "mine.toml"
    scene.write_text(scene_template("contact", surfaces=files, folder=tmp_path))
    planned, _ = plan_scene(scene)
    grid = build.grid_of(planned.grid)
    assert grid.spacing == pytest.approx((0.5e-6, 0.5e-6), rel=1e-3, abs=0)
    assert grid.shape == (204, 204)  # 51.2 um of the smaller map, and its mirror image
    assert "map-coarse" not in {note.code for note in scene_warnings(examine(planned))}


@pytest.mark.parametrize("sides", [(0.80376e-6, 0.438052e-6), (0.684449e-6, 0.43129e-6), (1 / 3 * 1e-6, 0.1e-6)])
def test_a_grid_on_two_maps_does_not_reach_beyond_the_smaller(sides, tmp_path):
    """Cells of 0.438052 um, rounded up to four digits, were longer than the map, and the scene did not plan."""
    files = {}
    for body, side, cells in zip(("lower", "upper"), sides, (100, 151), strict=True):
        grid = Grid((cells, cells + 7), (side, side), periodic=(True, True))
        heights = generate_surface(grid, rms_height=5e-8, seed=4, correlation_length=4e-6)
        files[body] = _map(tmp_path / f"{body}.npz", heights, grid.spacing)
    scene = tmp_path / "mine.toml"
    scene.write_text(scene_template("contact", surfaces=files, folder=tmp_path))
    planned, _ = plan_scene(scene)
    assert build.grid_of(planned.grid).spacing == pytest.approx((max(sides),) * 2, rel=1e-10, abs=0)
    assert len(examine(planned).surfaces) == 2  # heights on the grid


@pytest.mark.parametrize("kind", ["contact", "running-in"])
def test_repetitions_of_measured_surfaces_are_refused(kind, tmp_path):
    """They would be equal, with a scatter of zero; beside a generated surface they differ."""
    path = tmp_path / "mine.toml"
    path.write_text(scene_template(kind, surfaces=FILES, folder=tmp_path))
    with pytest.raises(InputError, match=r"repetitions: all surfaces are measured.*lower\.surface\.path="):
        plan_scene(path, ["repetitions=3"])
    generated = 'upper.surface={ kind = "generated", rms_height = "50 nm", correlation_length = "5 um" }'
    assert plan_scene(path, ["repetitions=3", generated])[0].repetitions == 3


def seam_notes(path, *settings):
    notes = scene_warnings(examine(plan_scene(path, settings)[0]))
    return [note for note in notes if (note.code, note.values.get("reason")) == ("map-altered", "seams-large")]


def test_a_map_bent_to_be_periodic_has_a_caution_with_what_to_do(tmp_path):
    """Roughness of 20 nm on a cubic form of 200 nm, which removal of curvature leaves; odd cells cannot be mirrored."""
    grid = Grid((97, 96), (0.5e-6, 0.5e-6), periodic=(True, True))
    heights = generate_surface(grid, rms_height=20e-9, correlation_length=2e-6, seed=1)
    form = 200e-9 * np.linspace(-1, 1, 97)[:, None] ** 3
    scene = tmp_path / "mine.toml"
    for bent, files in ((0, heights), (1, heights + form)):
        file = _map(tmp_path / f"map{bent}.npz", files, grid.spacing)
        scene.write_text(scene_template("contact", surfaces={"lower": file}, folder=tmp_path))
        plain = ["lower.surface.mirror=none", "lower.surface.crop=", "grid.shape=[97,96]", "grid.spacing=0.5 um"]
        found = seam_notes(scene, *plain)
        assert [note.level for note in found] == [Level.CAUTION] * bent
    assert 'mirror = "both"' in found[0]
    assert "a grid of twice the size along x and y" in found[0], "on this grid mirrors keep a quarter of the map"
    assert "detrend" not in found[0]  # the curvature is removed already
    assert not seam_notes(scene, *plain[1:], "lower.surface.mirror=both", "grid.shape=96")


def test_a_map_whose_ends_do_not_meet_is_mirrored_along_these_axes_with_the_reason(tmp_path):
    """`new` advised to mirror what had an odd number of cells, which is refused. The form's step is along x alone."""
    grid = Grid((97, 131), (0.5e-6, 0.5e-6), periodic=(True, True))
    heights = generate_surface(grid, rms_height=20e-9, correlation_length=2e-6, seed=1)
    bent = _map(tmp_path / "bent.npz", heights + 200e-9 * np.linspace(-1, 1, 97)[:, None] ** 3, grid.spacing)
    scene = tmp_path / "mine.toml"
    scene.write_text(text := scene_template("contact", surfaces={"lower": bent}, folder=tmp_path))
    planned, _ = plan_scene(scene)
    assert planned.lower.surface.mirror == "x"
    assert build.grid_of(planned.grid).shape == (192, 130)
    said = " ".join(text.replace("#", "").split())
    assert "Chosen because the ends of this map do not meet" in said
    assert not seam_notes(scene)


def test_the_reason_of_a_mirror_says_whose_ends_do_not_meet(tmp_path):
    """Of two maps on a patch, both had the larger number of the two."""
    grid = Grid((96, 96), (0.5e-6, 0.5e-6), periodic=(True, True))
    maps = [generate_surface(grid, rms_height=20e-9, correlation_length=2e-6, seed=seed) for seed in (1, 2)]
    maps[1] = maps[1] + 200e-9 * np.linspace(-1, 1, 96)[:, None] ** 3
    files = {
        body: _map(tmp_path / f"{body}.npz", heights, grid.spacing)
        for body, heights in zip(("lower", "upper"), maps, strict=True)
    }
    text = scene_template("contact", surfaces=files, folder=tmp_path)
    lower, upper = (" ".join(part.replace("#", "").split()) for part in text.split("[upper]"))
    assert "the ends of the map of upper.surface do not meet" in lower
    assert "the ends of this map do not meet" in upper
    changes = [re.search(r"change its heights by ([\d.]+) % of Sq", part)[1] for part in (lower, upper)]
    assert changes[0] == changes[1]
    assert float(changes[0]) > 30
    assert float(re.search(r"this map \(change ([\d.]+) %\)", lower)[1]) < 30


def test_a_loop_of_wear_mirrors_the_map_that_its_seams_would_bend(tmp_path):
    """The cylinder's grid wraps along y alone."""
    grid = Grid((200, 200), (0.5e-6, 0.5e-6), periodic=(True, True))
    heights = generate_surface(grid, rms_height=20e-9, correlation_length=2e-6, seed=1)
    files = {"upper": _map(tmp_path / "plain.npz", heights, grid.spacing)}
    files["lower"] = _map(tmp_path / "bent.npz", heights + 400e-9 * np.linspace(-1, 1, 200) ** 3, grid.spacing)
    scene = tmp_path / "mine.toml"
    scene.write_text(scene_template("wear", surfaces=files, folder=tmp_path))
    planned, _ = plan_scene(scene)
    assert (planned.lower.surface.mirror, planned.upper.surface.mirror) == ("y", "none")
    assert not seam_notes(scene)
    assert seam_notes(scene, "lower.surface.mirror=none")


def test_cells_of_odd_maps_are_cut_off_and_not_interpolated(tmp_path):
    """189 x 151 of 201 x 151 points lay half a cell off, which smoothed the map along x."""
    rng = np.random.default_rng(2)
    files, heights = {}, {}
    for body, shape in (("lower", (201, 151)), ("upper", (189, 160))):
        heights[body] = 1e-8 * rng.standard_normal(shape)
        files[body] = _map(tmp_path / f"{body}.npz", heights[body], (1e-6, 1e-6))
    scene = tmp_path / "mine.toml"
    scene.write_text(scene_template("contact", surfaces=files, folder=tmp_path))
    planned, _ = plan_scene(scene, ["lower.surface.detrend=none"])
    grid = build.grid_of(planned.grid)
    assert grid.shape == (188, 150)
    found = build.heights_of(planned.lower.surface, grid, 0)
    whole = heights["lower"]
    part = max((whole[i : i + 188, j : j + 150] for i in (6, 7) for j in (0, 1)), key=lambda one: (one * found).sum())
    assert np.corrcoef(part.ravel(), found.ravel())[0, 1] > 0.97  # closing the seams changes the edges


def test_maps_that_make_a_poor_pair_are_told_before_the_scene_is_written(tmp_path):
    def points(name, cells, side):
        return _map(tmp_path / name, 5e-8 * np.random.default_rng(4).standard_normal((cells, cells)), (side, side))

    tiny, coarse, fine = points("tiny.npz", 10, 1e-6), points("coarse.npz", 64, 5e-6), points("fine.npz", 600, 0.3e-6)
    for lower, upper, said in (
        (tiny, coarse, "the map has 10 x 10 points"),
        (coarse, points("less.npz", 100, 1e-6), "20 x 20 points of the coarser one"),
        (coarse, fine, "17 times those of the upper map"),
        (points("large.npz", 400, 1e-6), points("part.npz", 100, 1e-6), "of the lower map is used"),
    ):
        scene = tmp_path / "mine.toml"
        done = CliRunner().invoke(command_line(), ["new", "contact", str(scene), "--lower", lower, "--upper", upper])
        assert said in str(done.exception) + done.output
        assert scene.exists() == (done.exit_code == 0)
        scene.unlink(missing_ok=True)


def test_cells_finer_than_the_map_have_a_remark(tmp_path):
    scene = tmp_path / "mine.toml"
    scene.write_text(scene_template("contact", surfaces={"lower": FILES["lower"]}, folder=tmp_path))
    levels = []
    for spacing in ("0.8 um", "0.5 um", "0.3 um"):
        facts = examine(plan_scene(scene, ["grid.shape=96", f"grid.spacing={spacing}"])[0])
        levels.append([note.level for note in scene_warnings(facts) if note.code == "map-coarse"])
    assert levels == [[], [Level.INFO], [Level.CAUTION]]
