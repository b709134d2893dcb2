"""Flow factors over separation: contact and flow together, the table between its separations, bad input."""

import numpy as np
import pytest

from bem import CATALOGUE, Body, Grid, InputError, Status, flow_factors, generate_surface, solve_contact
from bem.convolution import displacement_operator
from bem.flow.factor_curve import FactorCurve
from bem.reference_solutions.rough_flow import (
    PATIR_CHENG,
    patir_cheng_friction,
    patir_cheng_pressure,
    patir_cheng_shear,
    perturbed_factors,
)

STEEL = Body(CATALOGUE["steel-52100"].material)
RMS = 0.2e-6


def patch(n, seed, *, length=2e-6, gamma=1.0, cell=0.5e-6):
    """The shorter correlation length is `length`; as many of either at the sides, at most four times as many cells."""
    shape = (round(n * min(max(1, gamma), 4)), round(n * min(max(1, 1 / gamma), 4)))
    grid = Grid(shape, (cell, cell), periodic=(True, True))
    lengths = (length * max(1, gamma), length * max(1, 1 / gamma))
    return grid, generate_surface(grid, rms_height=RMS, seed=seed, correlation_length=lengths)


def test_tables_of_patir_and_cheng_are_continuous():
    """Their two branches of phi_s meet at H = 5 to the digits they print; so does phi_f at H = 3."""
    for gamma in PATIR_CHENG:
        low, high = patir_cheng_shear(np.array([5.0, 5.0 + 1e-9]), gamma)
        assert low == pytest.approx(high, rel=2e-3)
    near, far = patir_cheng_friction(np.array([3 - 1e-6, 3 + 1e-6]))[0]
    assert near == pytest.approx(far, rel=1e-5)
    with pytest.raises(InputError, match="gamma 2"):
        patir_cheng_pressure(np.array([1.0]), 2.0)


def test_isotropic_roughness_is_patir_and_chengs():
    """Heights cut off, nothing deformed, as they did; means of three patches of 24 correlation lengths a side. Beside
    their fit: phi_x within 0.05 from H = 2 on (observed 0.044, 0.02, 0.01), up to 0.15 above it at H = 1, where patches
    scatter by 0.1; phi_s within 0.04; phi_f, which depends on the cut, within a tenth."""
    ratio = np.array([1.0, 2.0, 3.0, 6.0])
    tables = [flow_factors(z, g, None, separations=ratio * RMS) for g, z in (patch(96, seed) for seed in (1, 2, 3))]
    pressure = np.mean([[t.pressure_x, t.pressure_y] for t in tables], axis=(0, 1))
    assert pressure[1:] == pytest.approx(patir_cheng_pressure(ratio[1:]), abs=0.05)
    assert 0 < pressure[0] - patir_cheng_pressure(ratio[:1])[0] < 0.15
    assert np.mean([t.shear_x for t in tables], 0) == pytest.approx(patir_cheng_shear(ratio), abs=0.04)
    sliding, gradient = patir_cheng_friction(ratio)
    assert np.mean([t.friction_sliding for t in tables], 0) == pytest.approx(sliding, rel=0.1)
    assert np.mean([t.friction_pressure for t in tables], 0)[1:] == pytest.approx(gradient[1:], abs=0.03)
    # far off both are perturbation theory; the rest is the cell's, four to a correlation length (observed 4 and 1 %)
    far = flow_factors(patch(96, 1)[1], patch(96, 1)[0], None, separations=[40 * RMS])
    phi, shear = perturbed_factors(np.array([40.0]))
    assert 0.5 * (far.pressure_x + far.pressure_y) - 1 == pytest.approx(phi - 1, rel=0.06)
    assert far.shear_x == pytest.approx(shear, rel=0.05)


@pytest.mark.parametrize("gamma", [1 / 6, 6.0])
def test_elongated_roughness_is_patir_and_chengs(gamma):
    """Lays across and along, where contact is rare. Across the flow the fit itself leaves perturbation theory by 0.02
    at H = 6 and 0.07 at H = 3 for 1/6; ours are near it (observed 0.02 and 0.064; along 0.037, phi_s 0.19)."""
    ratio = np.array([3.0, 6.0, 20.0])
    tables = [
        flow_factors(z, g, None, separations=ratio * RMS) for g, z in (patch(96, seed, gamma=gamma) for seed in (1, 2))
    ]
    pressure, shear = (np.mean([getattr(t, name) for t in tables], 0) for name in ("pressure_x", "shear_x"))
    assert pressure[:2] == pytest.approx(patir_cheng_pressure(ratio[:2], gamma), abs=0.07)
    assert pressure[1] == pytest.approx(patir_cheng_pressure(ratio[1:2], gamma)[0], abs=0.025)
    assert shear[:2] == pytest.approx(patir_cheng_shear(ratio[:2], gamma), rel=0.25)
    # the fourth order is 1/H^2 of the second: 0.5 % of phi_x - 1 and more of phi_s; the cell and the patch the rest
    phi, dragged = perturbed_factors(ratio, gamma)
    assert pressure[2] - 1 == pytest.approx(phi[2] - 1, rel=0.12)
    assert shear[2] == pytest.approx(dragged[2], rel=0.12)


def test_separation_is_that_of_the_mean_planes():
    """Elastic: the mean of the deformed gap is the separation, as the periodic deflection has no mean. Capped: it is
    the separation and the mean plastic depth. The contact's area is the solver's."""
    grid, z = patch(64, 5)
    operator = displacement_operator(grid, (STEEL, STEEL))
    for hardness in (None, 6e9):
        table = flow_factors(
            z, grid, (STEEL, STEEL), separations=[0.8 * RMS, 2 * RMS], hardness=hardness, tolerance=1e-8
        )
        assert table.status is Status.CONVERGED
        for row, d in enumerate(table.separations):
            contact = solve_contact(-(z - z.mean()), operator, approach=-d, hardness=hardness)
            assert table.contact_area_fraction[row] == pytest.approx(contact.contact_area / grid.area, rel=1e-6)
            # gaps under 1e-4 of the rms height are left out of the mean
            assert table.mean_gap[row] == pytest.approx(d + contact.plastic_depth.mean(), rel=1e-5)
        if hardness is not None:
            assert table.mean_gap[0] > 1.01 * table.separations[0]


def test_elastic_bodies_close_what_overlap_leaves_open():
    """At the same separation deformed roughness lets less through: its displaced volume stays in the gap's mean."""
    grid, z = patch(64, 6)
    apart = np.array([0.3, 0.6, 6.0]) * RMS
    cut, pressed = (flow_factors(z, grid, b, separations=apart) for b in (None, STEEL))
    assert (pressed.pressure_x[:2] < 0.8 * cut.pressure_x[:2]).all()
    assert pressed.pressure_x[2] == cut.pressure_x[2]  # no contact, the same gap


def test_no_flow_below_percolation():
    """Pressed until contact surrounds all fluid: exactly nothing flows, and a note says so."""
    grid, z = patch(48, 2, length=3e-6)
    table = flow_factors(z, grid, STEEL, separations=[0.02 * RMS, 3 * RMS])
    assert table.contact_area_fraction[0] > 0.5
    assert not table.flows_through_x[0]
    assert table.pressure_x[0] == 0
    assert table.pressure_x[1] > 0.5
    assert any((note.code, note.values.get("reason")) == ("flow-factors-limit", "table") for note in table.notes)
    value, slope = table.pressure_x_curve(np.array([0.01, 0.02, 0.5]) * RMS)
    assert (value[:2] == 0).all()
    assert value[2] > 0
    assert slope[2] > 0
    # what cannot flow goes with the rough wall
    assert table.shear_x[0] * RMS == pytest.approx(table.mean_gap[0], rel=1e-9)


def test_transposed_and_in_other_units():
    grid, z = patch(48, 7, gamma=2.0)
    table = flow_factors(z, grid, STEEL, separations=[RMS])
    across = Grid(grid.shape[::-1], grid.spacing[::-1], periodic=(True, True))
    turned = flow_factors(np.ascontiguousarray(z.T), across, STEEL, separations=[RMS])
    assert turned.pressure_x == pytest.approx(table.pressure_y, rel=1e-5)
    large = Grid(grid.shape, (2 * grid.spacing[0], 2 * grid.spacing[1]), periodic=grid.periodic)
    # all lengths doubled, and nothing has changed but the separation
    doubled = flow_factors(2 * z, large, STEEL, separations=[2 * RMS])
    assert doubled.pressure_x == pytest.approx(table.pressure_x, rel=1e-9)
    assert doubled.shear_x == pytest.approx(table.shear_x, rel=1e-9)
    again = flow_factors(z, grid, STEEL, separations=[RMS])
    assert (again.pressure_x == table.pressure_x).all()


def test_little_flow_through_a_self_affine_surface():
    """Shut but for a few throats beside pools 1e8 times as open: converged, and good to less than the tolerance."""
    grid = Grid((128, 128), (1e-6, 1e-6), periodic=(True, True))
    z = generate_surface(grid, rms_height=RMS, seed=1, hurst=0.8, rolloff_wavelength=16e-6, cutoff_wavelength=4e-6)
    found, finer = (flow_factors(z, grid, STEEL, separations=[0.3 * RMS], tolerance=t) for t in (1e-6, 1e-8))
    assert found.status is Status.CONVERGED
    assert 0 < found.pressure_x[0] < 0.05
    assert found.pressure_x == pytest.approx(finer.pressure_x, rel=1e-6)


def test_error_of_the_cell():
    """The bar from cells twice as large holds the difference from cells half as large."""
    grid, z = patch(128, 8, length=4e-6, cell=0.25e-6)
    half = Grid((64, 64), (0.5e-6, 0.5e-6), periodic=(True, True))
    apart = np.array([1.0, 3.0]) * RMS
    fine = flow_factors(z, grid, STEEL, separations=apart)
    coarse = flow_factors(np.ascontiguousarray(z[::2, ::2]), half, STEEL, separations=apart, errors=True)
    assert (np.abs(fine.pressure_x - coarse.pressure_x) < 2 * coarse.pressure_x_error + 0.002).all()
    assert np.isnan(fine.pressure_x_error).all()


def test_smooth_surfaces():
    grid = Grid((8, 8), (1e-6, 1e-6), periodic=(True, True))
    table = flow_factors(np.full(grid.shape, 3e-9), grid, STEEL, separations=[1e-8, 1e-6])
    assert table.pressure_x == pytest.approx(1, abs=1e-12)
    assert (table.shear_x == 0).all()


def test_a_grid_that_ends_is_taken_to_repeat():
    grid, z = patch(32, 2)
    ending, repeating = (
        flow_factors(z, one, STEEL, separations=[2 * RMS]) for one in (Grid(grid.shape, grid.spacing), grid)
    )
    assert np.array_equal(ending.pressure_x, repeating.pressure_x)


def test_bad_input_one_message_each():
    grid, z = patch(32, 2)
    with pytest.raises(InputError) as caught:
        flow_factors(z[:5], grid, None, separations=[0.0, 1e-7], hardness=1e9)
    assert len(caught.value.messages) == 3
    with pytest.raises(InputError, match="separations none"):
        flow_factors(z, grid, STEEL, separations=[])


@pytest.mark.internal
@pytest.mark.parametrize("zeros", [0, 2])
def test_curve(zeros):
    """Through its points, monotone between them, its slope that of differences, limits beyond."""
    h = np.array([0.5, 0.8, 1.0, 1.5, 3.0, 6.0])
    values = 1 - 0.9 * np.exp(-0.56 * h)
    values[:zeros] = 0
    curve = FactorCurve(h, values, 1.0, 2.0)
    assert curve(h)[0] == pytest.approx(values, rel=1e-12)
    x = np.linspace(0.1, 30, 4001)
    value, slope = curve(x)
    assert (np.diff(value) >= -1e-15).all()
    step = 1e-6
    # not at a knot: there only the first derivative is continuous
    away = np.abs(x[:, None] - h).min(axis=1) > 1e-3
    difference = (curve(x + step)[0] - curve(x - step)[0]) / (2 * step)
    assert slope[away] == pytest.approx(difference[away], abs=1e-6)
    assert 1 - curve(np.array([60.0]))[0][0] == pytest.approx(0.01 * (1 - values[-1]), rel=1e-9)
    assert curve(np.array([1e-3]))[0][0] == pytest.approx(0, abs=0.1)


@pytest.mark.internal
def test_curve_of_grooves_along_does_not_run_off():
    """phi_x > 1 rises as surfaces near; below the table it stays."""
    curve = FactorCurve(np.array([1.0, 2.0, 4.0]), np.array([2.0, 1.5, 1.1]), 1.0, 2.0)
    value, slope = curve(np.array([0.01, 0.5]))
    assert (value == pytest.approx([2.0, 2.0]), (slope == 0).all()) == (True, True)
