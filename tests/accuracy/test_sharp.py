"""Sharp surfaces have no highest pressure, and the run says so; smooth and rough ones keep its bar."""

import numpy as np
import pytest

from bem import Body, Grid, Material, displacement_operator, solve_contact
from bem.accuracy import ContactCase, contact_bars, solve_coarser, stress_bars
from bem.accuracy.sharp import is_sharp
from bem.stress import summarise_stress
from bem.surfaces import generate_surface

STEEL = Material("steel", youngs_modulus=200e9, poissons_ratio=0.3)
GRID = Grid((64, 64), (1.5e-6, 1.5e-6))


def cut(radius, x, y, inside):
    return np.where(np.hypot(x, y) < radius, inside, 0.0)


SHAPES = {
    "punch": lambda x, y: 1e-3 - cut(30e-6, x, y, 1e-3),
    "bevelled punch": lambda x, y: 0.01 * np.maximum(np.hypot(x, y) - 30e-6, 0),
    "cone": lambda x, y: 0.05 * np.hypot(x, y),
    "cone between cells": lambda x, y: 0.05 * np.hypot(x - 0.3e-6, y - 0.2e-6),
    "pyramid": lambda x, y: 0.05 * np.maximum(abs(x), abs(y)),
    "roof": lambda x, y: 0.05 * abs(x) + y**2 / 5e-4,
    "truncated ball": lambda x, y: np.maximum((x**2 + y**2) / 2e-3 - 0.11e-6, 0),
    "drilled ball": lambda x, y: (x**2 + y**2) / 2e-3 + cut(7e-6, x, y, 1e-6),
    "grooved ball": lambda x, y: (x**2 + y**2) / 2e-3 + np.where(abs(x - 3e-6) < 4e-6, 1e-6, 0),
    "ball with a step": lambda x, y: (x**2 + y**2) / 2e-3 - cut(4e-6, x - 9e-6, y, 0.05e-6),
}
SMOOTH = {
    "ball": lambda x, y: (x**2 + y**2) / 2e-3,
    "ball with a round bump": lambda x, y: (
        (x**2 + y**2) / 2e-3 - 0.05e-6 * np.exp(-((x - 9e-6) ** 2 + y**2) / (2 * (6e-6) ** 2))
    ),
    "ball with a kink that does not touch": lambda x, y: np.minimum((x**2 + y**2) / 2e-3, 0.5e-6),
}


def pressed(shape, load=0.5, hardness=None):
    gap = shape(GRID.x[:, None], GRID.y[None, :] + 0 * GRID.x[:, None])
    operator = displacement_operator(GRID, Body(STEEL))
    return ContactCase(
        operator, gap, solve_contact(gap, operator, load=load, hardness=hardness), load, hardness=hardness
    )


@pytest.mark.parametrize("shape", SHAPES)
def test_a_sharp_contact_has_no_bar_of_its_highest_pressure_and_says_why(shape):
    """On cells four times finer it is 1.2 to 2.7 times as high, under bars of 4 to 40 % of that before."""
    case = pressed(SHAPES[shape])
    bars = contact_bars(case, solve_coarser(case))
    assert bars.values["max_pressure"] is None
    assert any(note.values["reason"] == "sharp-pressure" for note in bars.notes)
    assert bars.values["contact_area"] > 0


@pytest.mark.internal
@pytest.mark.parametrize("cells", [12, 16, 20, 24])
def test_a_cone_is_sharp_on_few_cells_wherever_its_tip_lies(cells):
    """Its curvature, the inverse distance, is nowhere small there; of a ball, and of rough surfaces, it is even."""
    grid, rng = Grid((cells, cells), (1e-6, 1e-6)), np.random.default_rng(6)
    for tip in [(0.0, 0.0), (0.5e-6, 0.5e-6), *rng.uniform(-1e-6, 1e-6, (10, 2))]:
        away = np.hypot(grid.x[:, None] - tip[0], grid.y[None, :] - tip[1])
        assert is_sharp(0.05 * away, (away < 4e-6).astype(np.float64), grid)
        assert not is_sharp(away**2, (away < 4e-6).astype(np.float64), grid)
    periodic = Grid((cells, cells), (1e-7, 1e-7), periodic=(True, True))
    for seed in range(10):
        heights = generate_surface(periodic, seed=seed, hurst=0.8, cutoff_wavelength=4e-7, rms_slope=0.05)
        assert not is_sharp(-heights, np.ones(grid.shape), periodic)


@pytest.mark.parametrize("shape", SMOOTH)
def test_a_smooth_contact_keeps_the_bar(shape):
    case = pressed(SMOOTH[shape])
    assert contact_bars(case, solve_coarser(case)).values["max_pressure"] > 0


@pytest.mark.internal
def test_a_ridge_far_below_the_highest_pressure_does_not_count():
    """Its own rises on finer cells, from 0.7 of the highest, which stays."""

    def ridged(x, y):
        return (x**2 + y**2) / 2e-3 - 30e-9 * np.maximum(0, 1 - abs(x - 26.25e-6) / 4.5e-6)

    case = pressed(ridged, load=6.0)
    assert is_sharp(case.undeformed, case.solution.pressure, case.grid)
    bar = contact_bars(case, solve_coarser(case)).values["max_pressure"]
    finer = Grid((256, 256), (0.375e-6, 0.375e-6))
    gap, operator = ridged(finer.x[:, None], finer.y), displacement_operator(finer, Body(STEEL))
    error = abs(solve_contact(gap, operator, load=6.0).maximum_pressure - case.solution.maximum_pressure)
    assert error <= bar < 0.05 * case.solution.maximum_pressure


@pytest.mark.internal
@pytest.mark.parametrize("cutoff", [2.0, 4.0, 8.0])
def test_rough_surfaces_are_not_sharp_by_chance(cutoff):
    """Of forty surfaces of 64 x 64 cells with waves down to so many cells, one at most (of two hundred each 1, 2
    and 0 were); all of them touches."""
    grid = Grid((64, 64), (1e-7, 1e-7), periodic=(True, True))
    sharp = 0
    for seed in range(40):
        heights = generate_surface(grid, seed=seed, hurst=0.8, cutoff_wavelength=cutoff * 1e-7, rms_slope=0.05)
        sharp += is_sharp(-heights, np.ones(grid.shape), grid)
    assert sharp <= 1


def test_under_a_cap_a_sharp_contact_may_reach_it():
    """The cap is the limit that finer cells come to: what is missing of it is the bar."""
    free = pressed(SHAPES["cone"])
    hardness = 1.5 * float(free.solution.maximum_pressure)
    below = pressed(SHAPES["cone"], hardness=hardness)
    bar = contact_bars(below, solve_coarser(below)).values["max_pressure"]
    assert bar == pytest.approx(hardness - below.solution.maximum_pressure, rel=1e-3)
    at = pressed(SHAPES["cone"], hardness=0.5 * float(free.solution.maximum_pressure))
    assert contact_bars(at, solve_coarser(at)).values["max_pressure"] < 1e-3 * at.hardness


def test_stress_at_a_sharp_edge_has_no_bar():
    def bars(shape, depths):
        case = pressed(SHAPES[shape])
        below = summarise_stress(case.solution.pressure, GRID, Body(STEEL), np.array(depths))
        return stress_bars(case, solve_coarser(case), Body(STEEL), below)

    at_surface = bars("punch", np.linspace(0, 40e-6, 9))
    assert at_surface.values["max_von_mises"] is None
    assert at_surface.notes[0].values["reason"] == "stress-of-sharp"
    # two cells and more below it has a limit
    assert bars("punch", [20e-6]).values["max_von_mises"] > 0
