"""Closed forms with observed order: Hertz, Westergaard, flat punch."""

import numpy as np
import pytest
from contact_oracles import FREE, HALF_Y, PERIODIC, operator

from bem.contact import solve_contact
from bem.reference_solutions.hertz import cylinder_contact, ellipse_contact, sphere_contact
from bem.reference_solutions.punch import CircularPunch, StripPunch
from bem.reference_solutions.westergaard import SinusoidalContact


def order(sizes, errors):
    """Observed order by least squares over all sizes: areas jump by cells, so two sizes alone say little."""
    return -np.polyfit(np.log(sizes), np.log(errors), 1)[0]


def mean_error(found, expected):
    return np.abs(found - expected).sum() / np.abs(expected).sum()


def point_contact(reference, cells, half_width):
    a, b = reference.semi_axes
    op = operator((cells, cells), (2 * half_width * a / cells, 2 * half_width * b / cells), FREE)
    x, y = op.grid.x[:, None], op.grid.y[None, :]
    return op, solve_contact(reference.undeformed_gap(x, y), op, load=reference.load), reference.pressure(x, y)


@pytest.mark.parametrize("radii", [(1.0, 1.0), (1.0, 5.0), (30.0, 1.0)])
def test_hertz_point_contacts(radii):
    reference = (
        sphere_contact(radius=1.0, contact_modulus=1.0, load=1e-3)
        if radii[0] == radii[1]
        else ellipse_contact(radii=radii, contact_modulus=1.0, load=1e-3)
    )
    sizes, pressures, approaches, areas = (24, 48, 96, 192), [], [], []
    for cells in sizes:
        op, solution, expected = point_contact(reference, cells, 1.5)
        assert solution.status == "converged"
        pressures.append(mean_error(solution.pressure, expected))
        approaches.append(abs(solution.approach / reference.approach - 1))
        areas.append(abs(solution.contact_area / reference.contact_area - 1))
        # the residual is certified, so the field equals the closed form outside the contact too
        assert solution.gap.min() >= -1e-8 * op.grid.lengths[0]
    # the square-root edge limits the mean error of the pressure to order 3/2; the approach is better
    assert order(sizes, pressures) > 1.3
    assert pressures[-1] < 1.5e-3
    assert approaches[-1] < 1e-4
    assert areas[-1] < 0.01  # one row of cells along the edge is 2 %


def test_hertz_approach_control_gives_the_load():
    reference = sphere_contact(radius=1.0, contact_modulus=1.0, load=1e-3)
    errors = []
    for cells in (32, 64, 128):
        op, _, _ = point_contact(reference, cells, 1.5)
        gap = reference.undeformed_gap(op.grid.x[:, None], op.grid.y[None, :])
        errors.append(abs(solve_contact(gap, op, approach=reference.approach).load / reference.load - 1))
    assert errors[-1] < 1e-4
    assert order((32, 64, 128), errors) > 1.2


def test_hertz_line_contact_on_a_slice_periodic_along_the_axis():
    reference = cylinder_contact(radius=1.0, contact_modulus=1.0, load=1e-3)
    sizes, errors = (32, 64, 128, 256), []
    for cells in sizes:
        width = 3 * reference.half_width
        op = operator((cells, 4), (width / cells, 0.1), HALF_Y)
        x = op.grid.x[:, None]
        solution = solve_contact(x**2 / 2 + np.zeros((1, 4)), op, load=reference.load * 0.4)
        assert np.ptp(solution.pressure, axis=1).max() <= 1e-6 * solution.pressure.max()  # certified to 1e-8 of the gap
        errors.append(mean_error(solution.pressure[:, 0], reference.pressure(op.grid.x)))
    assert order(sizes, errors) > 1.3
    assert errors[-1] < 1e-3


@pytest.mark.parametrize("half_width", [1 / 32, 1 / 4, 15 / 32], ids=["light", "half", "near full"])
def test_westergaard_partial_contact(half_width):
    # these edges lie between two cells on every grid, so that the order shows without jumps
    share = np.sin(np.pi * half_width) ** 2
    sizes, pressures, areas = (64, 128, 256, 512), [], []
    for cells in sizes:
        op = operator((cells, 2), (1 / cells, 1 / cells), PERIODIC)
        full = np.pi * 0.01
        reference = SinusoidalContact(0.01, 1.0, 1.0, share * full)
        x = op.grid.x
        gap = 0.01 * (1 - np.cos(2 * np.pi * x))[:, None] + np.zeros((1, 2))
        solution = solve_contact(gap, op, load=share * full * op.grid.area)
        pressures.append(mean_error(solution.pressure[:, 0], reference.pressure(x)))
        areas.append(abs(solution.contact_area / op.grid.area - reference.contact_fraction))
    assert order(sizes, pressures) > 1.2  # square-root edges limit it to 3/2
    assert pressures[-1] < 4e-3
    assert areas[-1] <= 2 / sizes[-1]  # a cell at either edge


def test_westergaard_full_contact_is_exact():
    op = operator((64, 3), (1 / 64, 1 / 64), PERIODIC)
    reference = SinusoidalContact(0.01, 1.0, 1.0, 1.3 * np.pi * 0.01)
    gap = 0.01 * (1 - np.cos(2 * np.pi * op.grid.x))[:, None] + np.zeros((1, 3))
    solution = solve_contact(gap, op, load=reference.mean_pressure * op.grid.area, tolerance=1e-10)
    # one wave is represented exactly: only the tolerance of the solver is left, 7e-13 of the wave of 0.01, times at
    # most 32 pi (that of the shortest wave) over the least pressure of 0.3 pi 0.01
    assert np.abs(solution.pressure[:, 0] / reference.pressure(op.grid.x) - 1).max() < 1e-8
    assert solution.contact_area == pytest.approx(op.grid.area)


def test_flat_punches():
    sizes, errors = (32, 64, 128, 256), []
    for cells in sizes:
        op = operator((cells, cells), (3 / cells, 3 / cells), FREE)
        r = np.hypot(op.grid.x[:, None], op.grid.y[None, :])
        solution = solve_contact(np.where(r < 1, 0.0, 100.0), op, load=1.0)
        # the punch that was pressed is a staircase: the circle of the same area is nearest to it
        reference = CircularPunch(np.sqrt(solution.contact_area / np.pi), 1.0, 1.0)
        errors.append(abs(solution.approach / reference.approach - 1))
    # the pressure is singular at the edge: first order
    assert errors[-1] < 5e-3
    assert order(sizes, errors) > 0.8


def test_strip_punch_pressure():
    sizes, errors = (48, 96, 192), []
    for cells in sizes:
        op = operator((cells, 2), (3 / cells, 0.5), HALF_Y)
        x = op.grid.x
        solution = solve_contact(np.where(np.abs(x) < 1, 0.0, 10.0)[:, None] + np.zeros((1, 2)), op, load=1.0)
        reference = StripPunch(half_width=1.0, contact_modulus=1.0, load=1.0)
        inner = np.abs(x) < 0.9
        errors.append(mean_error(solution.pressure[inner, 0], reference.pressure(x[inner])))
    # a whole number of cells per half-width, constant pressure on each, infinite at the edge: towards first order
    assert errors[-1] < 6e-3
    assert order(sizes, errors) > 0.8
