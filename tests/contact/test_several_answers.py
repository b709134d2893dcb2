"""Mean gaps that several loads give are said to be such, and others are not."""

import numpy as np
import pytest

from bem import Body, Grid, Layer, Material, displacement_operator, solve_contact
from bem.errors import Status

GRID = Grid((48, 48), (1e-6, 1e-6))
GAP = 0.5 * (GRID.x[:, None] ** 2 + GRID.y[None, :] ** 2) / 1e-3
SOFT = Material("soft", youngs_modulus=1e9, poissons_ratio=0.4)
STIFF = Material("stiff", youngs_modulus=400e9, poissons_ratio=0.25)
LAYERED = displacement_operator(GRID, Body(SOFT, layers=(Layer(STIFF, 4e-6),)))


def mean_gap_under(load):
    return float(np.maximum(solve_contact(GAP, LAYERED, load=load, tolerance=1e-6).gap, 0.0).mean())


@pytest.mark.parametrize("light", [0.0, 0.02, 0.06])
def test_two_loads_of_one_mean_gap_are_told(light):
    """Under a stiff layer the mean gap of 0.02 N comes again between 0.3 and 1 N; that without contact at 1 N."""
    wanted = mean_gap_under(light) if light else float(GAP.mean() - GAP.min())
    wanted *= 1 if light else 1.02
    found = solve_contact(GAP, LAYERED, mean_gap=wanted)
    assert found.status is Status.CONVERGED
    assert found.load == pytest.approx(light, rel=1e-3)  # the smallest load of all answers
    (note,) = [note for note in found.notes if note.code == "mean-gap-ambiguous"]
    assert "a larger load" in note
    assert mean_gap_under(0.15) < wanted < mean_gap_under(1.2)


def test_the_answer_beside_the_least_mean_gap_is_told():
    """There all other loads tried have larger mean gaps."""
    thick = displacement_operator(GRID, Body(SOFT, layers=(Layer(STIFF, 10e-6),)))
    found = solve_contact(GAP, thick, mean_gap=3e-9)
    assert found.status is Status.CONVERGED
    assert any(note.code == "mean-gap-ambiguous" for note in found.notes)
    heavier = solve_contact(GAP, thick, load=4 * found.load, tolerance=1e-6)
    lighter = solve_contact(GAP, thick, load=found.load / 4, tolerance=1e-6)
    assert np.maximum(heavier.gap, 0).mean() > 3e-9 < np.maximum(lighter.gap, 0).mean()


def test_a_half_space_and_a_periodic_contact_have_one_answer():
    half_space = displacement_operator(GRID, Body(SOFT))
    for wanted in (1e-7, 3e-8):
        assert not any(
            note.code == "mean-gap-ambiguous" for note in solve_contact(GAP, half_space, mean_gap=wanted).notes
        )
    periodic = Grid((48, 48), (1e-6, 1e-6), periodic=(True, True))
    layered = displacement_operator(periodic, Body(SOFT, layers=(Layer(STIFF, 4e-6),)))
    assert not any(note.code == "mean-gap-ambiguous" for note in solve_contact(GAP, layered, mean_gap=1e-7).notes)
