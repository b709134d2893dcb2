"""Highest von Mises stress of sliding contacts at the edge, and its error bar, against Hamilton's closed form."""

import math

import numpy as np
import pytest

from bem import Body, Grid, Layer, Material, displacement_operator, solve_contact
from bem.accuracy import ContactCase, coating_bars, solve_coarser, stress_bars
from bem.reference_solutions.hamilton import sphere_stress
from bem.stress import summarise_stress, von_mises

STEEL = Material("steel", youngs_modulus=220e9, poissons_ratio=0.3)
PLAIN, COATED_WITH_ITSELF = Body(STEEL), Body(STEEL, layers=(Layer(STEEL, 3.0),))
CURVATURE = 1e-3
DEPTHS = np.array([0.0, 1.0, 3.0, 3.1, 6.0])


def ball(cells):
    """A ball of so many cells to the radius of contact, pressed without an effect of friction on the pressure."""
    wide = 4 * math.ceil(0.8 * cells)
    grid = Grid((wide, wide), (1.0, 1.0))
    gap = 0.5 * CURVATURE * ((grid.x[:, None] - 0.1) ** 2 + (grid.y + 0.3) ** 2)
    load = 4 / 3 * STEEL.plane_strain_modulus * CURVATURE * cells**3
    operator = displacement_operator(grid, PLAIN)
    return ContactCase(operator, gap, solve_contact(gap, operator, load=load, tolerance=1e-9), load=load)


def exact(cells, friction):
    """Highest von Mises stress at the surface: at the trailing edge, on the axis of sliding."""
    top = 2 * STEEL.plane_strain_modulus * CURVATURE * cells / math.pi
    stress = sphere_stress(
        -cells, 0.0, 0.0, contact_radius=cells, maximum_pressure=top, poissons_ratio=0.3, friction=friction
    )
    return float(von_mises(stress))


@pytest.mark.parametrize("friction", [0.4, 0.5])
def test_the_von_mises_stress_at_the_edge_has_its_closed_form_and_is_within_its_bar(friction):
    errors = []
    for cells in (10, 20):
        case, truth = ball(cells), exact(cells, friction)
        below = summarise_stress(case.solution.pressure, case.grid, PLAIN, DEPTHS, friction=friction)
        assert below.highest_at_edge
        assert below.max_von_mises_depth == 0
        bar = stress_bars(case, solve_coarser(case), PLAIN, below, friction).values["max_von_mises"]
        errors.append(abs(below.max_von_mises / truth - 1))
        assert errors[-1] < min(0.01, bar / truth)
        assert bar < 0.08 * truth
        assert truth - below.max_von_mises_of_points > 0.03 * truth
    assert errors[0] > 2 * errors[1]  # first order at least


def test_a_traction_that_slips_is_the_friction_and_one_that_sticks_has_no_edge():
    case, friction = ball(10), 0.5
    pressure, grid = case.solution.pressure, case.grid
    plain = summarise_stress(pressure, grid, PLAIN, DEPTHS, friction=friction)
    turned = np.array([np.zeros_like(pressure), friction * pressure])
    slips = summarise_stress(pressure, grid, PLAIN, DEPTHS, traction=np.array([turned[1], turned[0]]))
    assert slips.max_von_mises == pytest.approx(plain.max_von_mises, rel=1e-9)
    across = summarise_stress(pressure, grid, PLAIN, DEPTHS, traction=turned)
    assert across.max_von_mises == pytest.approx(plain.max_von_mises, rel=0.02)
    sticks = summarise_stress(pressure, grid, PLAIN, DEPTHS, traction=np.array([1e9 * (pressure > 0), turned[0]]))
    assert not sticks.highest_at_edge


def test_a_layer_has_the_stress_of_its_edge_and_its_bar():
    """A layer of the substrate's material: its closed form is that of the half-space."""
    cells, friction = 10, 0.5
    case, truth = ball(cells), exact(cells, friction)
    below = summarise_stress(
        case.solution.pressure, case.grid, COATED_WITH_ITSELF, DEPTHS, friction=friction, components=True
    )
    coarser = solve_coarser(case)
    bars = coating_bars(case, coarser, COATED_WITH_ITSELF, below, friction).values["layer_max_von_mises"]
    assert abs(below.max_von_mises - truth) < bars[0] < 0.1 * truth
    whole = stress_bars(case, coarser, COATED_WITH_ITSELF, below, friction).values["max_von_mises"]
    assert whole == pytest.approx(bars[0], rel=1e-9)


def test_friction_on_a_rigid_ball_raises_the_stress_at_the_trailing_edge():
    """Hamilton's pressure is Hertz', which friction leaves alone between equal materials. Under a rigid ball it moves
    the pressure: the edge is 4 % above the closed form at friction 0.3, and converges to that."""
    rigid, found = Body(Material("rigid", youngs_modulus=1e20, poissons_ratio=0.3)), []
    for cells in (10, 20):
        case, truth = ball(cells), exact(cells, 0.3)
        operator = displacement_operator(case.grid, (PLAIN, rigid), friction=0.3)
        pressure = solve_contact(case.undeformed, operator, load=case.load, tolerance=1e-8).pressure
        found.append(summarise_stress(pressure, case.grid, PLAIN, DEPTHS[:1], friction=0.3).max_von_mises / truth)
    assert found[1] == pytest.approx(1.04, abs=0.01)
    assert found[0] == pytest.approx(found[1], rel=0.03)
