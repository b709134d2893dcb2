"""`converged` is said of what is returned: everything asked for is recomputed here from the pressure alone."""

import math
from dataclasses import dataclass

import numpy as np
import pytest
from contact_oracles import FREE, HALF_X, HALF_Y, PERIODIC, body, operator, rough

from bem import Body, Grid, Layer, Material, Status, displacement_operator, solve_contact
from bem.contact.certificate import certify, free_edges_reached
from bem.contact.grid_workspace import GridResult
from bem.contact.problem import Request, Units
from bem.convolution import DisplacementOperator
from bem.plausibility import without_argument_notes


@dataclass(frozen=True)
class Problem:
    gap: np.ndarray
    operator: DisplacementOperator
    hardness: float | None
    control: dict[str, float]
    tolerance: float


def random_problem(seed, largest=40):
    """Any grid, half of them coated, half with friction; elastic or capped; loads down to 1e-16 of hardness x area."""
    rng = np.random.default_rng(seed)
    shape = tuple(int(v) for v in rng.integers(3, largest, 2))
    periodic = tuple(bool(v) for v in rng.integers(0, 2, 2))
    grid = Grid(shape, (1 / max(shape), 10 ** rng.uniform(-0.5, 0.5) / max(shape)), periodic=periodic)
    base = Material("base", youngs_modulus=1.0, poissons_ratio=rng.uniform(0, 0.49))
    film = Material("film", youngs_modulus=10 ** rng.uniform(-1.3, 1.3), poissons_ratio=rng.uniform(0, 0.49))
    layer = Layer(film, 10 ** rng.uniform(-2, 0)) if rng.random() < 0.5 else None
    friction = float(rng.choice([0.0, 0.0, 0.1, 0.3]))
    op = displacement_operator(grid, Body(base, layer=layer), friction=friction)
    gap = -rough(*shape, seed=seed, hurst=rng.uniform(0.1, 1), rolloff=rng.uniform(1, 6))
    if rng.random() < 0.3:
        gap = gap + 20 * np.linspace(-1, 1, shape[0])[:, None] ** 2
    gap = gap * 10 ** rng.uniform(-4, -1)
    hardness = 10 ** rng.uniform(-3, 2) * gap.std() if rng.random() < 0.6 else None
    drop = gap.mean() - gap.min()
    asked = ("load", "approach", "mean_gap")[rng.integers(0, 3)]
    if asked == "load":
        share = 1 - 10 ** rng.uniform(-3, 0) if rng.random() < 0.2 else 10 ** rng.uniform(-16, 0)
        value = share * grid.area * (hardness or 3 * gap.std())
    elif asked == "approach":
        deep = 1 if all(periodic) and hardness is None else 2
        value = gap.min() + drop * (10 ** rng.uniform(-12, 0) if rng.random() < 0.5 else rng.uniform(0, deep))
    else:
        value = drop * 10 ** rng.uniform(-4, 0.1)
    return Problem(gap, op, hardness, {asked: float(value)}, 10 ** rng.uniform(-9, -4))


def check(problem, solution):
    """Every condition, from the returned pressure; its product is good to 1e-13 of what it is made of."""
    cap = math.inf if problem.hardness is None else problem.hardness
    fresh = displacement_operator(
        problem.operator.grid, problem.operator.bodies, friction=problem.operator.friction
    )  # no buffers shared with the solver
    pressure = solution.pressure
    displacement = fresh(pressure)
    reach = max(np.abs(displacement).max(), np.abs(problem.gap).max())
    allowed = problem.tolerance * problem.gap.std() + 1e-13 * reach
    assert pressure.min() >= 0
    assert pressure.max() <= cap
    opening = problem.gap + displacement - solution.approach
    inside = (pressure > 0) & (pressure < cap)
    assert np.abs(opening[inside]).max(initial=0) <= allowed
    assert (-opening[pressure == 0]).max(initial=0) <= allowed
    assert opening[pressure >= cap].max(initial=0) <= allowed
    np.testing.assert_allclose(solution.displacement, displacement, rtol=0, atol=1e-13 * reach)
    load = pressure.sum() * problem.operator.grid.cell_area
    assert solution.load == pytest.approx(load, rel=1e-13, abs=0)
    (name, value) = next(iter(problem.control.items()))
    if name == "load":
        assert load == pytest.approx(value, rel=problem.tolerance, abs=0)
    elif name == "approach":
        assert solution.approach == pytest.approx(value, abs=allowed, rel=0)
    else:
        volume = np.maximum(opening, 0)[pressure == 0].sum()
        assert volume / pressure.size == pytest.approx(value, abs=allowed, rel=0)


@pytest.mark.internal
@pytest.mark.parametrize("block", range(3))
def test_converged_is_confirmed_by_the_returned_pressure(block):
    """120 problems; 240 of this generator were run, and 1,200 distinct ones of a sibling."""
    for seed in range(40 * block, 40 * (block + 1)):
        problem = random_problem(seed)
        solution = solve_contact(
            problem.gap,
            problem.operator,
            hardness=problem.hardness,
            tolerance=problem.tolerance,
            **problem.control,
        )
        assert solution.status == Status.CONVERGED, (seed, solution.status, solution.residual)
        check(problem, solution)


@pytest.mark.internal
@pytest.mark.parametrize("periodic", [FREE, PERIODIC, HALF_X, HALF_Y])
@pytest.mark.parametrize("share", [1e-6, 1e-10, 1e-12, 1e-14, 1e-16, 1e-20])
def test_capped_contact_carries_a_tiny_load(share, periodic):
    """One shift of all pressures, counted from zero, could not resolve such loads: 20 % were missed at 1e-16."""
    op = operator((40, 18), (1.0, 1.0), periodic)
    gap = -rough(40, 18, seed=263)
    hardness = 0.05
    load = share * hardness * op.grid.area
    problem = Problem(gap, op, hardness, {"load": load}, 1e-9)
    solution = solve_contact(gap, op, load=load, hardness=hardness, tolerance=1e-9)
    assert solution.status == Status.CONVERGED
    check(problem, solution)


def judged(pressure, *, displacement=0.0, at=-1.0, cap=math.inf, fresh=True, **asked):
    """The certificate of a scaled pressure on a gap of 0 with one cell of 1, approach -1: without pressure, open."""
    grid = Grid((4, 6), (1.0, 1.0), periodic=PERIODIC)
    op = displacement_operator(grid, body())
    gap = np.zeros(grid.shape)
    gap[0, 0] = 1.0
    request = Request(
        gap, op, cap=cap / op.unit, tolerance=1e-6, **({"load": None, "approach": None, "mean_gap": None} | asked)
    )
    level = GridResult(np.full(24, pressure), np.full(24, displacement), at, 0.0, True, fresh)
    return certify(
        request,
        Units(1.0, 1 / op.unit, 0.0),
        float(gap.std()),
        level,
        status_if_unmet=Status.STALLED,
        iterations=1,
        convolutions_before=op.count.weighted,
    )


@pytest.mark.internal
def test_the_certificate_counts_what_was_asked_for_and_not_met():
    rms = math.sqrt(23) / 24
    mean = 1 + 1 / 24
    assert judged(0.0, load=0.0).status == Status.CONVERGED
    assert judged(0.0, load=1e-30).residual == 1.0
    assert judged(1e-30, at=0.0, load=0.0).residual == math.inf
    assert judged(0.0, approach=-1.0).status == Status.CONVERGED
    assert judged(0.0, approach=-1.1).residual == pytest.approx(0.1 / rms)
    assert judged(0.0, mean_gap=mean).status == Status.CONVERGED
    assert judged(0.0, mean_gap=mean + 0.1).residual == pytest.approx(0.1 / rms)


@pytest.mark.internal
def test_the_certificate_counts_bounds_numbers_that_are_none_and_displacements_of_other_pressures():
    assert judged(-1e-3, load=0.0).residual == math.inf
    assert judged(2.0, at=1.0, cap=1.0, approach=1.0).residual == math.inf
    assert judged(math.nan, approach=-1.0).status == Status.STALLED
    # a displacement that is not the operator's is believed only where it was the operator that wrote it
    believed, recomputed = (judged(0.0, displacement=-1.0, fresh=fresh, approach=-1.0) for fresh in (True, False))
    assert believed.convolutions == 0
    np.testing.assert_array_equal(believed.displacement, -1.0)
    assert recomputed.convolutions == 1
    np.testing.assert_array_equal(recomputed.displacement, 0.0)


def test_a_contact_at_the_edge_of_a_free_axis_is_noted():
    for periodic, axes in ((FREE, ["x and y"]), (HALF_X, ["y"]), (HALF_Y, ["x"]), (PERIODIC, [])):
        op = operator((12, 10), (1.0, 1.0), periodic)
        everywhere = solve_contact(np.zeros((12, 10)), op, load=1.0)
        notes = without_argument_notes(everywhere.notes)  # cells of a metre
        assert [note.values["axes"] for note in notes] == axes
        ball = op.grid.x[:, None] ** 2 + op.grid.y[None, :] ** 2
        assert without_argument_notes(solve_contact(ball, op, load=1e-2).notes) == ()


@pytest.mark.internal
@pytest.mark.parametrize(
    ("cell", "periodic", "reached"),
    [
        ((0, 3), (False, False), (0,)),
        ((-1, 3), (False, False), (0,)),
        ((2, 0), (False, False), (1,)),
        ((2, -1), (False, False), (1,)),
        ((-1, -1), (False, False), (0, 1)),
        ((-1, -1), (True, False), (1,)),
        ((2, 3), (False, False), ()),
    ],
)
def test_free_edges_are_reached_from_either_end(cell, periodic, reached):
    pressure = np.zeros((6, 8))
    pressure[cell] = 1.0
    assert free_edges_reached(periodic, pressure) == reached
