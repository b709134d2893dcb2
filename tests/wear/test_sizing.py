"""Sizes of particles beside a wear law: those of the stress criterion, from the contact that the law wears."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from small_scenes import WEAR

from bem.campaigns import campaign_of, compute
from bem.errors import InputError
from bem.grid import Grid
from bem.runs import plan_scene
from bem.scenes import wearing
from bem.scenes.checks import examine, outcome_warnings
from bem.scenes.checks.cycles import _cells_for_particles
from bem.wear.criterion.averaged import AveragedVonMises

ARCHARD = '[wear]\ncriterion = { kind = "archard", specific_wear_rate = "1e-7 mm^3/(N*m)", distance = "%s" }\n'
SIZES = 'particle_criterion = "von_mises"\n'


def run(tmp_path, text):
    path = tmp_path / "scene.toml"
    path.write_text(text)
    campaign = campaign_of(plan_scene(path)[0])
    return campaign, compute(campaign).outcome


def test_particles_of_the_first_contact_are_those_of_the_criterion_and_nothing_more_leaves(tmp_path):
    short = WEAR.replace("count = 12\nsettled = 4", "count = 1\nsettled = 1")
    _, alone = run(tmp_path, short)
    _, plain = run(tmp_path, short + ARCHARD % "1 nm")
    _, beside = run(tmp_path, short + ARCHARD % "1 nm" + SIZES)
    assert (beside.variables["height_after"].values == plain.variables["height_after"].values).all()
    assert beside.variables["volume"].values == plain.variables["volume"].values > 0
    volumes = [np.sort(one.variables["particle_volume"].values) for one in (alone, beside)]
    assert volumes[0].size > 3
    assert volumes[1] == pytest.approx(volumes[0], rel=1e-3)
    assert plain.variables["particle_volume"].values.size == 0
    assert beside.summary["particle_equivalent_radius_nm"] == pytest.approx(
        alone.summary["particle_equivalent_radius_nm"], rel=1e-3
    )


def test_the_number_of_particles_is_the_volume_of_the_law_over_their_mean_volume(tmp_path):
    _, found = run(tmp_path, WEAR + ARCHARD % "1 mm" + SIZES)
    volume, cycle = (found.variables[f"particle_{name}"].values.ravel() for name in ("volume", "cycle"))
    number, worn = (found.variables[name].values.ravel() for name in ("particles", "volume"))
    for first in (0, 4, 8):  # three stretches of cycles.settled
        mean = volume[(cycle > first) & (cycle <= first + 4)].mean()
        assert number[first : first + 4] == pytest.approx(worn[first : first + 4] / mean, rel=1e-12)
    assert found.summary["particles_per_cycle"] == pytest.approx(worn[-4:].mean() / volume[cycle > 8].mean(), rel=1e-12)
    assert found.summary["particles_all_cycles"] == pytest.approx(number.sum(), rel=1e-12)


def loop_with_few_particles(volumes, cycles, settled=3):
    """A scene and its loop of seven cycles, in each of which Archard's law wears 1 um^3 and third bodies cut 2 um^3."""
    rows = np.zeros(7, dtype=[("cycle", int), ("volume", float), ("cut_volume", float)])
    rows["cycle"], rows["volume"], rows["cut_volume"] = np.arange(1, 8), 3e-18, 2e-18
    particles = np.zeros(len(volumes), dtype=[("cycle", int), ("volume", float)])
    particles["cycle"], particles["volume"] = cycles, volumes
    law = SimpleNamespace(wears_by_pressure=False)
    wear = SimpleNamespace(
        particle_criterion="von_mises",
        finds_particles=law,
        criterion=SimpleNamespace(distance_per_cycle=lambda shift: 0.5),
        shift=1,
    )
    sizes = SimpleNamespace(particles=lambda result: particles)
    scene: Any = SimpleNamespace(wear=wear, sizes=sizes, cycles=SimpleNamespace(settled=settled))
    result: Any = SimpleNamespace(cycles=rows, wearing=(0,))
    return scene, result


def test_the_number_of_all_particles_is_the_sum_over_stretches():
    """Stretches of 1, 3 and 3 cycles, in the first of which none is found: it has the mean volume of all."""
    scene, found = loop_with_few_particles([2e-18, 4e-18, 6e-18], [3, 6, 7])
    assert wearing.all_particles(scene, found) == pytest.approx(1 / 4 + 3 / 2 + 3 / 5, rel=1e-12)
    scene, found = loop_with_few_particles([], [])
    assert wearing.all_particles(scene, found) is None


@pytest.mark.internal
def test_cycles_without_a_particle_wear_all_the_same():
    """Each counted as a cycle without wear: 0.068 particles of 2.36 um^3 a cycle stood beside 0.064 um^3 worn."""
    scene, result = loop_with_few_particles([2e-18, 4e-18, 1e-18, 1e-18, 4e-18], [2, 4, 6, 6, 7])
    number = wearing.sizes_over_cycles(scene, result)[1]
    # stretches of cycles 1, 2 to 4 and 5 to 7, with mean volumes of 3 and 2 um^3 in the last two
    assert number[1:] == pytest.approx([1 / 3] * 3 + [1 / 2] * 3, rel=1e-12)
    assert np.isnan(number[0])
    assert wearing.particle_number(scene, result, result.cycles[-3:]) == pytest.approx(3 / 2, rel=1e-12)
    assert wearing.particle_number(scene, result, result.cycles) == pytest.approx(7 / (12 / 5), rel=1e-12)
    rates = wearing.particle_rates(scene, result, Grid((4, 4), (1e-6, 1e-6)))
    assert rates["particles_per_distance"] == pytest.approx(1 / 2 / 0.5, rel=1e-12)
    assert rates["particles_per_volume"] == pytest.approx(1 / 2e-18, rel=1e-12)


@pytest.mark.internal
def test_wear_without_any_particle_has_no_number_of_them():
    scene, result = loop_with_few_particles([2e-18], [1])
    assert wearing.particle_number(scene, result, result.cycles[-3:]) is None
    assert wearing.particle_rates(scene, result, Grid((4, 4), (1e-6, 1e-6))) == {
        "particles_per_distance": None,
        "particles_per_volume": None,
    }
    assert np.isnan(wearing.sizes_over_cycles(scene, result)[1][1:]).all()
    result.cycles["volume"] = 2e-18  # cuts alone
    assert wearing.particle_number(scene, result, result.cycles[-3:]) == 0
    assert (wearing.sizes_over_cycles(scene, result)[1] == 0).all()


def test_cuts_of_third_bodies_come_off_without_particles_of_the_criterion(tmp_path):
    """The number of particles was that of all that wore, cuts of both bodies included."""
    bodies = '\n[wear.third_bodies]\ndiameter = "300 nm"\nnumber_per_area = 1e11\nremoved = 0.5\n'
    law = ARCHARD.replace("1e-7", "1e-12") % "100 nm" + SIZES
    _, cut = run(tmp_path, WEAR + law + bodies)
    _, plain = run(tmp_path, WEAR + law + bodies.replace("0.5", "0.0"))
    worn, alone = (one.variables["volume"].values.flat[0] for one in (cut, plain))
    assert worn > 10 * alone > 0
    # the first contact is the same, and so are what the law takes in it and its particles
    number, same = (one.variables["particles"].values.flat[0] for one in (cut, plain))
    assert number == pytest.approx(same, rel=1e-6)
    assert number > 0


def test_a_boundary_film_changes_the_volume_and_not_the_sizes(tmp_path):
    """The defect of the film is a factor on the law; the sizing criterion, which has none, refused it after a cycle."""
    film = '\n[wear.film_defect]\nadsorption_energy = "1e-19 J"\ntemperature = "60 degC"\nsliding_speed = "0.1 m/s"\n'
    law = ARCHARD % "1 nm" + SIZES
    _, covered = run(tmp_path, WEAR + law + film)
    _, bare = run(tmp_path, WEAR + law)
    volumes = [one.variables["volume"].values.flat[0] for one in (covered, bare)]
    assert 0 < volumes[0] < volumes[1]
    sizes = [np.sort(one.variables["particle_volume"].values[:4]) for one in (covered, bare)]
    assert sizes[0] == pytest.approx(sizes[1], rel=1e-3)


def test_a_law_without_sizes_says_how_to_have_them(tmp_path):
    for text, told in ((ARCHARD % "1 mm", 1), (ARCHARD % "1 mm" + SIZES, 0), ("", 0)):
        campaign, found = run(tmp_path, WEAR + text)
        codes = [note.code for note in outcome_warnings(examine(campaign.scene), found)]
        assert codes.count("no-particle-sizes") == told


@pytest.mark.internal
def test_the_criterion_that_is_recommended_is_resolved_by_the_cells(tmp_path):
    """ "averaged_von_mises" of 300 nm was recommended on cells of 2.1 um x 3.75 um, and answered by finer cells."""
    campaign, _ = run(tmp_path, WEAR + ARCHARD % "1 mm")
    facts = examine(campaign.scene)
    for grid, words in (
        (Grid((192, 64), (2.1e-6, 3.75e-6)), "grid.shape = [192, 128] and "),
        (Grid((64, 64), (2e-6, 2.5e-6)), ""),
    ):
        of_grid: Any = SimpleNamespace(scene=SimpleNamespace(grid=SimpleNamespace(shape=grid.shape)))
        said, length = _cells_for_particles(of_grid, grid)
        assert said == words
        finest = Grid((192, 128), (2.1e-6, 1.875e-6)) if words else grid
        assert AveragedVonMises(averaging_length=length).resolved(facts.cases[0].wearing[0], finest)


@pytest.mark.parametrize(
    ("wear", "refused"),
    [
        (SIZES, "particle_criterion beside the criterion von_mises"),
        (ARCHARD % "1 mm" + 'particle_criterion = "junction"\n', "junction as particle_criterion"),
    ],
)
def test_what_cannot_give_sizes_is_refused(tmp_path, wear, refused):
    path = tmp_path / "scene.toml"
    path.write_text(WEAR + ("[wear]\n" if "criterion = {" not in wear else "") + wear)
    with pytest.raises(InputError, match=refused):
        plan_scene(path)
