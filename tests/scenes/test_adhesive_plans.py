"""Plans of adhesive contacts: their time follows Tabor's parameter, and says where it is unknown."""

import math

from bem.adhesion.laws import ExponentialAdhesion
from bem.adhesion.zone import FEWEST_CELLS, adhesive_zone, cells_in_zone, resolved_range, zone_notes
from bem.grid import Grid
from bem.notes import Level
from bem.reference_solutions.adhesive_sphere import dmt_pull_off_force, jkr_pull_off_force, tabor_parameter
from bem.runs import plan_scene


def contact_step(*settings):
    _, planned = plan_scene("adhesive-sphere", settings)
    steps = {step.name: step for step in planned.steps}
    return steps["contact"], steps["error bars"]


def test_the_range_that_the_note_proposes_has_as_many_cells_as_are_needed():
    law, grid, modulus = ExponentialAdhesion(work=0.05, range=100e-9), Grid((256, 1), (1.2e-6, 7e-6)), 2.6e6
    assert cells_in_zone(law, modulus, grid) < 1
    longer = ExponentialAdhesion(work=0.05, range=resolved_range(law, modulus, grid))
    assert math.isclose(cells_in_zone(longer, modulus, grid), FEWEST_CELLS, rel_tol=1e-12)
    assert math.isclose(adhesive_zone(law, modulus), math.pi * modulus * 1e-14 / 0.2, rel_tol=1e-12)


def test_no_grid_is_recommended_that_cannot_be_solved():
    """For a range of 1 nm the note recommended 774028 x 774028 cells, at two levels before and after the run."""
    grid = Grid((96, 96), (4e-7, 4e-7))
    for reach, grids in ((1e-9, False), (5e-8, True)):
        law = ExponentialAdhesion(work=0.05, range=reach)
        both = [zone_notes(law, 3.3e6, grid, reason)[0] for reason in ("foreseen", "solved")]
        assert all(("grid.shape" in note.line) is grids for note in both)
        assert all("contact.adhesion.range to" in note.line for note in both)
        assert {note.level for note in both} == {Level.OUTSIDE_MODEL}


def test_limits_of_the_pull_off_force_are_those_of_tabors_parameter():
    assert math.isclose(dmt_pull_off_force(0.05, 1e-3) / jkr_pull_off_force(0.05, 1e-3), 4 / 3, rel_tol=1e-12)
    assert math.isclose(tabor_parameter(0.05, 1e-3, 1e6, 1e-7), (1e-3 * 2.5e-3 / 1e12 / 1e-21) ** (1 / 3), rel_tol=1e-9)


def test_plans_of_adhesive_paths_follow_tabors_parameter_and_count_the_coarser_path():
    contact, bars = contact_step()
    softer, _ = contact_step('lower.material.youngs_modulus="2 MPa"')
    assert softer.transforms > 1.5 * contact.transforms
    assert 0.9 * contact.transforms < bars.transforms < 1.1 * contact.transforms
    assert bars.points < 0.3 * contact.points
    assert "within a factor" in contact.why


def test_a_plan_proposes_the_grid_that_the_note_on_the_adhesive_zone_proposes():
    """With 78 cells, two in the zone, the time is known; 155 were needed where the error bars' grid counted."""
    resolved, _ = contact_step("grid.shape=78")
    coarse, _ = contact_step("grid.shape=77")
    assert "within a factor" in resolved.why
    assert "set grid.shape to 78 x 78 or more, for which this step takes about" in coarse.why
    short, _ = contact_step('contact.adhesion.range="1 nm"')
    assert "set contact.adhesion.range to" in short.why
