"""Roughness that is short against a cylinder's contact: the patch that the kind friction chooses, and its refusals."""

import pytest

from bem.errors import InputError
from bem.runs import plan_scene, run_scene
from bem.scenes.checks.facts import examine
from bem.scenes.checks.overview import differing
from bem.scenes.load import load_scene
from bem.surfaces.generate import check_statistics

ROLLER = {
    "kind": "friction",
    "lower": {"material": "steel-52100", "surface": {"process": "ground", "rms_height": "0.4 um"}},
    "upper": {"material": "peek"},
    "contact": {"cylinder": "20 mm", "width": "20 mm", "loads": ["500 N"], "boundary_friction": 0.2},
    "oil": {"viscosity": "0.89 mPa*s"},
    "speeds": {"values": ["1 mm/s", "100 m/s"], "slide_roll_ratio": 2},
}
"""A polymer roller on a ground shaft in water: half-width 384 um, correlation length 6.5 um across the grooves."""


def with_surface(**surface):
    return ROLLER | {"lower": ROLLER["lower"] | {"surface": surface}}


def planned(scene):
    return plan_scene(scene, [])[0]


def test_a_scene_without_grid_has_a_patch_that_repeats():
    scene = planned(ROLLER)
    assert scene.grid.periodic == (True, True)
    assert scene.cell_repeats
    assert scene.thermal == "off"
    assert scene.grid.shape == (192, 192)
    along = scene.lower.surface.correlation_lengths
    assert scene.grid.spacing == pytest.approx([length / 6 for length in along])
    check_statistics(scene.curve_setup("off").grid, rms_height=4e-7, correlation_length=along)


def test_the_plan_gives_the_load_of_the_whole_contact():
    """Its row had the load of a slice as wide as the patch, under "load on the grid", though it has no grid."""
    names, rows = differing(examine(planned(ROLLER)))
    patch, whole = (dict(zip(names, row, strict=True)) for row in rows)
    assert (patch["case"], whole["case"]) == ("rough patch", "whole contact")
    assert (patch["load"], whole["load"]) == ("", "500 N")
    assert patch["load on the grid"]
    assert not whole["load on the grid"]


def test_two_surfaces_share_a_patch_of_the_longer_and_cells_of_the_shorter():
    both = with_surface(kind="generated", rms_height="0.2 um", correlation_length="20 um")
    scene = planned(
        both | {"upper": {"material": "peek", "surface": both["lower"]["surface"] | {"correlation_length": "10 um"}}}
    )
    assert scene.grid.spacing[0] == pytest.approx(10e-6 / 6)
    assert scene.grid.shape[0] * scene.grid.spacing[0] == pytest.approx(32 * 20e-6)


def test_self_affine_roughness_decides_by_its_longest_and_shortest_wave():
    scene = planned(
        with_surface(
            kind="generated", rms_height="0.4 um", hurst=0.8, rolloff_wavelength="40 um", cutoff_wavelength="10 um"
        )
    )
    assert scene.grid.shape[0] * scene.grid.spacing[0] == pytest.approx(320e-6)
    assert scene.grid.spacing[0] == pytest.approx(10e-6 / 6)


def test_long_roughness_has_a_patch_that_holds_the_contact():
    scene = planned(with_surface(kind="generated", rms_height="0.4 um", correlation_length="100 um"))
    assert scene.grid.periodic == (False, True)
    assert scene.thermal == "off"  # an oil of a viscosity alone
    assert scene.grid.shape[0] * scene.grid.spacing[0] == pytest.approx(4 * 384e-6, rel=1e-3)
    assert scene.grid.shape[1] * scene.grid.spacing[1] == pytest.approx(16 * 100e-6, rel=1e-3)


def test_a_measured_map_smaller_than_the_contact_repeats():
    scene = planned(with_surface(path="example/ground-disk.al3d", despike=6))
    assert scene.grid.periodic == (True, True)
    assert scene.grid.shape == (128, 128)
    small = planned(
        with_surface(path="example/ground-disk.al3d", despike=6)
        | {"contact": ROLLER["contact"] | {"loads": ["5 N"], "cylinder": "2 mm"}}
    )
    assert small.grid.periodic == (False, True)


def test_the_curve_runs_from_boundary_friction_to_a_full_film(tmp_path):
    scene = with_surface(kind="generated", rms_height="0.4 um", correlation_length="20 um")
    grid = {"shape": 64, "lengths": "320 um", "periodic": True}
    run = run_scene(scene | {"grid": grid, "film": {"points": 400}}, tmp_path, figures=False)
    found = run.summary
    assert found["status"] == "converged"
    assert found["friction"][0] == pytest.approx(0.2, rel=1e-3)
    assert found["contact_load_N"][1] < 0.05 * 500
    assert 0 < found["friction_error"][0] < 0.01 * 0.2
    assert not [note for note in found["notes"] if note["code"] == "repeated-patch"]


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"grid": {"shape": 64, "lengths": "240 um"}}, r"grid\.periodic = true, a patch of the roughness that repeats"),
        ({"sharing": {"models": ["capped", "uncoupled"]}}, "no size is given"),
        ({"grid": {"periodic": [False, True]}}, "no size is given"),
        ({"lower": {"material": "steel-52100", "surface": {"process": "polished"}}}, "allowed: both in lower.surface"),
        ({"upper": {"material": "peek", "surface": {"process": "ground", "correlation_length": "2 mm"}}}, "1024 along"),
        ({"grid": {"shape": 64, "lengths": "240 um", "periodic": True}, "sharing": {"oil_volume": "patch"}}, "repeats"),
    ],
)
def test_what_a_repeating_patch_has_not_is_said(changes, said):
    with pytest.raises(InputError, match=said):
        planned(ROLLER | changes)


def test_a_path_alone_means_a_measured_surface():
    assert load_scene(with_surface(path="example/ground-disk.al3d")).lower.surface.kind == "measured"


def test_a_repeating_patch_has_the_heat_of_film_and_contact(tmp_path):
    oil = {"oil": {"grade": "ISO VG 32", "temperature": "40 degC"}}
    assert planned(ROLLER | oil).thermal == "lumped"
    short = with_surface(kind="generated", rms_height="0.4 um", correlation_length="20 um")
    grid = {"shape": 64, "lengths": "320 um", "periodic": True}
    changes = oil | {"grid": grid, "speeds": {"values": [0.1], "slide_roll_ratio": 2}, "outputs": {"errors": False}}
    found = run_scene(short | changes | {"film": {"points": 400}}, tmp_path / "hot", figures=False).summary
    cold = run_scene(short | changes | {"thermal": "off", "film": {"points": 400}}, tmp_path / "cold", figures=False)
    assert found["status"] == "converged"
    assert 40 < found["contact_temperature_C"][0] < found["flash_temperature_C"][0] < 60
    assert found["friction"][0] == pytest.approx(cold.summary["friction"][0], rel=0.02)
    assert [note["text"] for note in found["notes"] if "flashes of single asperities" in note["text"]]


def test_the_film_may_have_a_modulus_of_its_own(tmp_path):
    """That of the bodies changes nothing; another one scales contact and film, and needs a patch that repeats."""
    bare = planned(ROLLER)
    given = ROLLER | {"sharing": {"film_modulus": bare.modulus}, "outputs": {"errors": False}}
    stiff = given | {"sharing": {"film_modulus": 4 * bare.modulus}}
    assert planned(stiff).smooth_contact().semi_axes[0] == pytest.approx(0.5 * bare.smooth_contact().semi_axes[0])
    stiffer = {
        name: given[name]
        | {"material": {"catalogue": given[name]["material"], "youngs_modulus": 4 * body.material.youngs_modulus}}
        for name, body in zip(("lower", "upper"), bare.bodies, strict=True)
    }
    runs = [
        run_scene(scene, tmp_path / str(number), figures=False).summary
        for number, scene in enumerate((given | {"sharing": {}}, given, stiff, given | stiffer | {"sharing": {}}))
    ]
    assert runs[1]["friction"] == runs[0]["friction"]
    # the film under the whole load is that between bodies of four times the modulus
    films = [run["lambda_ratio"][1] for run in runs]
    assert films[2] == pytest.approx(films[3], rel=1e-3)
    assert films[2] < 0.7 * films[0]
    # while asperities are as soft as before
    assert runs[2]["contact_load_N"][1] != pytest.approx(runs[3]["contact_load_N"][1], rel=0.01)
    holds = stiff | {"grid": {"shape": [1024, 32], "lengths": ["2 mm", "300 um"], "periodic": [False, True]}}
    with pytest.raises(InputError, match="film_modulus: a patch that holds the contact"):
        run_scene(holds, tmp_path / "holds", figures=False)
