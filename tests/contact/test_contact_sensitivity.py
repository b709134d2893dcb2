"""Derivatives of solved contacts: differences of contacts solved anew, scaling laws, closed forms."""

import numpy as np
import pytest

from bem import Body, Grid, InputError, Layer, Material, displacement_operator, generate_surface, solve_contact
from bem.contact import InputChange, contact_tangent, sensitivities

FIGURES = ("contact_area", "plastic_area", "maximum_pressure", "mean_gap", "approach", "load")
STEEL = {"youngs_modulus": 210e9, "poissons_ratio": 0.3}
SOLVER = 1e-13


def body(scale=1.0, **layer):
    thin = Layer(Material("layer", youngs_modulus=600e9 * scale, poissons_ratio=0.25), 2e-6) if layer else None
    return Body(Material("steel", **STEEL | {"youngs_modulus": 210e9 * scale}), layer=thin)


def figures(solution):
    return {name: getattr(solution, name) for name in FIGURES if name != "mean_gap"} | {
        "mean_gap": float(np.maximum(solution.gap, 0.0).mean())
    }


def differences(solve, value, step=1e-6):
    """Central differences of all figures over one input; None where a cell changes its state between both ends."""
    after, before = solve(value + step * value), solve(value - step * value)
    same = np.array_equal(after.pressure > 0, before.pressure > 0)
    if not same or np.count_nonzero(after.plastic_depth) != np.count_nonzero(before.plastic_depth):
        return None
    after, before = figures(after), figures(before)
    return {name: (after[name] - before[name]) / (2 * step * value) for name in FIGURES}


def rough(seed, periodic, cells=32):
    rng = np.random.default_rng(seed)
    grid = Grid((cells, cells - 4), (1e-6, 1.2e-6), periodic=periodic)
    heights = generate_surface(
        grid, rms_height=rng.uniform(0.02, 0.2) * 1e-6, correlation_length=rng.uniform(4, 8) * 1e-6, seed=seed
    )
    ball = 0.0 if all(periodic) else (grid.x[:, None] ** 2 + grid.y**2) / (2 * rng.uniform(100e-6, 400e-6))
    gap = ball - heights
    return grid, gap - gap.min(), heights, rng


@pytest.mark.parametrize("seed", range(8))
def test_random_contacts_against_differences(seed):
    periodic = [(False, False), (True, True), (False, True), (True, False)][seed % 4]
    grid, gap, heights, rng = rough(seed, periodic)
    load = float(rng.uniform(0.02, 0.3))
    hardness = None if seed % 2 else float(rng.uniform(1.5e9, 4e9))

    def solve(load=load, stretch=0.0, scale=1.0, hardness=hardness):
        operator = displacement_operator(grid, body(scale))
        return solve_contact(gap - stretch * heights, operator, load=load, hardness=hardness, tolerance=SOLVER)

    solution, operator = solve(), displacement_operator(grid, body())
    found = sensitivities(solution, gap, operator, hardness=hardness, roughness=-heights)
    assert found.residual < 1e-9
    modulus = operator.contact_modulus
    inputs = [
        (found.load, differences(lambda value: solve(load=value), load), load),
        (found.height, differences(lambda value: solve(stretch=value - 1), 1.0), 1.0),
        (found.modulus, differences(lambda value: solve(scale=value / modulus), modulus), modulus),
    ]
    if hardness is not None:
        inputs.append((found.hardness, differences(lambda value: solve(hardness=value), hardness), hardness))
    sizes = figures(solution)
    compared = 0
    for derivative, expected, value in inputs:
        if expected is None:
            continue
        compared += 1
        for name in FIGURES:
            size = sizes[name] / value
            assert abs(getattr(derivative, name) - expected[name]) <= 1e-5 * size, name
    assert compared >= len(inputs) - 1


@pytest.mark.parametrize("prescribed", ["approach", "mean_gap"])
def test_other_prescribed_quantities_against_differences(prescribed):
    grid, gap, _, _ = rough(11, (False, False))
    operator = displacement_operator(grid, body())
    pressed = solve_contact(gap, operator, load=0.1, tolerance=SOLVER)
    asked = {prescribed: figures(pressed)[prescribed]}

    def solve(scale=1.0, height=1.0):
        return solve_contact(
            height * gap, displacement_operator(grid, body(scale)), **asked, tolerance=SOLVER, initial_pressure=None
        )

    solution = solve()
    found = sensitivities(solution, gap, operator, prescribed=prescribed)
    assert found.load is None
    sizes = figures(solution)
    for derivative, solved, value in (
        (found.height, lambda value: solve(height=value), 1.0),
        (found.modulus, lambda value: solve(scale=value / operator.contact_modulus), operator.contact_modulus),
    ):
        expected = differences(solved, value)
        for name in FIGURES:
            assert getattr(derivative, name) * value == pytest.approx(
                expected[name] * value, rel=1e-5, abs=1e-5 * sizes[name]
            )
    moved = contact_tangent(solution, gap, operator, InputChange(**{prescribed: 1.0}), prescribed=prescribed)
    assert getattr(moved, prescribed) == pytest.approx(1.0, rel=1e-9)


@pytest.mark.parametrize("layered", [False, True])
def test_layers_and_friction_in_the_gap_against_differences(layered):
    grid, gap, _, _ = rough(5, (False, False))
    if layered:
        grid = Grid((16, 14), (1e-6, 1e-6))
        gap = ((grid.x[:, None] - 0.3e-6) ** 2 + grid.y**2) / 400e-6
    step, load = 1e-4, 0.15

    def operator_of(scale):
        if layered:
            return displacement_operator(grid, body(scale, layer=True))
        return displacement_operator(grid, body(scale), friction=0.3)

    def solve(scale):
        return solve_contact(gap, operator_of(scale), load=load, tolerance=SOLVER)

    solution, operator, more, less = solve(1.0), operator_of(1.0), operator_of(1 + step), operator_of(1 - step)
    assert layered or not operator.symmetric
    change = InputChange(displacement=(more(solution.pressure) - less(solution.pressure)) / (2 * step), modulus=1.0)
    found = contact_tangent(solution, gap, operator, change).figures()
    expected, sizes = differences(solve, 1.0), figures(solution)
    for name in FIGURES:
        assert abs(getattr(found, name) - expected[name]) <= 1e-5 * sizes[name], name


def test_ball_against_hertz():
    """Hertz: area ~ load^(2/3), pressure ~ load^(1/3), approach ~ load^(2/3).

    Cells keep their states, so that the powers scatter by the place of the ball in its cell: measured, 18 cells across,
    up to 0.027, 0.004 and 0.004.
    """
    powers = []
    for seed in range(8):
        shift = np.random.default_rng(seed).uniform(-0.5, 0.5, 2)
        grid = Grid((32, 32), (1e-6, 1e-6))
        gap = ((grid.x[:, None] - shift[0] * 1e-6) ** 2 + (grid.y - shift[1] * 1e-6) ** 2) / (2 * 500e-6)
        operator = displacement_operator(grid, body())
        load = 4 / 3 * operator.contact_modulus * (9e-6) ** 3 / 500e-6
        solution = solve_contact(gap, operator, load=load)
        found = sensitivities(solution, gap, operator).load
        powers.append(
            [load * getattr(found, name) / getattr(solution, name) for name in ("contact_area", "maximum_pressure")]
            + [load * found.approach / solution.approach]
        )
    errors = np.array(powers) - (2 / 3, 1 / 3, 2 / 3)
    assert (np.abs(errors).max(axis=0) < (0.04, 0.006, 0.006)).all()
    assert (np.abs(errors.mean(axis=0)) < (0.02, 0.003, 0.003)).all()


def test_height_and_modulus_by_scaling_are_those_of_their_own_solutions():
    grid, gap, _, _ = rough(2, (False, False))
    operator = displacement_operator(grid, body())
    solution = solve_contact(gap, operator, load=0.2, hardness=2e9, tolerance=SOLVER)
    assert solution.plastic_area > 0
    scaled = sensitivities(solution, gap, operator, hardness=2e9)
    solved = {
        "height": contact_tangent(solution, gap, operator, InputChange(gap=gap), hardness=2e9).figures(),
        "modulus": contact_tangent(
            solution, gap, operator, InputChange(modulus=1 / operator.contact_modulus), hardness=2e9
        ).figures(),
    }
    sizes = figures(solution)
    for name, one in solved.items():
        per = operator.contact_modulus if name == "modulus" else 1.0
        for figure in FIGURES:
            assert abs(getattr(one, figure) - getattr(getattr(scaled, name), figure)) * per <= 1e-7 * sizes[figure]


def test_cost_is_that_of_one_linear_solution():
    grid, gap, _, _ = rough(4, (False, False), cells=64)
    operator = displacement_operator(grid, body())
    solution = solve_contact(gap, operator, load=0.3)
    assert sensitivities(solution, gap, operator).convolutions <= 40


def test_refusals():
    grid, gap, _, _ = rough(3, (True, True))
    operator = displacement_operator(grid, body())
    solution = solve_contact(gap, operator, load=0.1)
    with pytest.raises(InputError, match="choose from load, approach, mean_gap"):
        contact_tangent(solution, gap, operator, InputChange(), prescribed="volume")
    full = solve_contact(gap, operator, load=1e3)
    assert (full.pressure > 0).all()
    with pytest.raises(InputError, match="does not depend on the load"):
        contact_tangent(full, gap, operator, InputChange(approach=1.0), prescribed="approach")
    with pytest.raises(InputError, match="homogeneous bodies"):
        sensitivities(solution, gap, displacement_operator(grid, body(layer=True)))
    yielded = solve_contact(gap, operator, load=1e5 * grid.area, hardness=1e5)
    with pytest.raises(InputError, match="no cell"):
        contact_tangent(yielded, gap, operator, InputChange(load=1.0), hardness=1e5)
