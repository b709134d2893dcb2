"""The stress table: every contact converges to 1e-8, verified from the pressure by means other than the solver's.

Surface, grid, cell shape, boundaries, control, cap and bodies are combined pairwise; limits that have a closed form are
tested beside. The independent product agrees with the operator's to about 1e-13 of the largest displacement.
"""

import numpy as np
import pytest
from contact_oracles import FREE, HALF_X, HALF_Y, PERIODIC, dense, displacement, operator, rough, violation
from hypothesis import given, settings
from hypothesis import strategies as st
from pairwise import pairwise

from bem import Body, Grid, InfeasibleError, Layer, Material, displacement_operator, solve_contact

TOLERANCE = 1e-8
N = 48
HEIGHT = 0.01
BOUNDARIES = {"free": FREE, "periodic x": HALF_X, "periodic y": HALF_Y, "periodic": PERIODIC}
EVERY_BOUNDARY = pytest.mark.parametrize("periodic", BOUNDARIES.values(), ids=BOUNDARIES)


def check(gap, op, *, hardness=None, **control):
    """Solve a contact and verify it."""
    solution = solve_contact(gap, op, hardness=hardness, tolerance=TOLERANCE, **control)
    verify(solution, gap, op, hardness, control)
    return solution


def verify(solution, gap, op, hardness, control):
    """Verify complementarity and the control from the pressure and the independent product."""
    assert solution.status == "converged"
    assert solution.residual <= TOLERANCE
    reach = np.abs(solution.displacement).max()
    roughness = gap.std() if gap.std() > 1e-6 * reach else reach
    cap = np.inf if hardness is None else hardness
    assert violation(op, gap, solution, cap) <= TOLERANCE * roughness + 1e-12 * (reach + np.abs(gap).max())
    if "load" in control:
        assert solution.load == pytest.approx(control["load"], rel=TOLERANCE, abs=0)
    if "approach" in control:
        assert solution.approach == pytest.approx(control["approach"], rel=1e-12)
    if "mean_gap" in control:
        opening = gap + displacement(op, solution.pressure) - solution.approach
        mean = np.maximum(opening, 0)[solution.pressure == 0].sum() / gap.size
        assert mean == pytest.approx(control["mean_gap"], abs=TOLERANCE * gap.std() + 1e-12 * reach)


def _spikes(u, v):
    gap = np.ones((u.size, v.size))
    for place, height in ((0.1, 0.0), (0.5, 0.2), (0.93, 0.9)):
        gap[int(place * u.size), int((1 - place) * v.size)] = height
    return gap


def _along(u, v):
    """Coordinate along the longer side, from 0 to 1, on the whole grid."""
    return u + 0 * v if u.size >= v.size else 0 * u + v


SURFACES = {
    "Hurst 0.1": lambda u, v: -rough(u.size, v.size, hurst=0.1),
    "Hurst 1": lambda u, v: -rough(u.size, v.size, seed=2, hurst=1.0),
    "white noise": lambda u, v: np.random.default_rng(0).standard_normal((u.size, v.size)),
    "wave": lambda u, v: np.cos(2 * np.pi * _along(u, v)),
    "crossed waves": lambda u, v: np.cos(2 * np.pi * (u + 2 * v)) * np.cos(2 * np.pi * (v - u)),
    "spikes": _spikes,
    "steps": lambda u, v: (u > 0.4) * 1.0 + (v > 0.6) * 1.0 + (_along(u, v) > 0.4),
    "wedge": lambda u, v: np.abs(_along(u, v) - 0.5),
    "pit": lambda u, v: np.where(np.hypot(u - 0.5, v - 0.5) < 0.2, 1.0, 0.0),
    "punch": lambda u, v: np.where(np.maximum(np.abs(u - 0.5), np.abs(v - 0.5)) < 0.2, 0.0, 1.0),
    "one low cell": lambda u, v: np.where(
        np.arange(u.size * v.size).reshape(u.size, v.size) == u.size * 2 // 5, 0, 1.0
    ),
}
UNIT = Material("unit", youngs_modulus=1.0, poissons_ratio=0.0)
RUBBER = Material("rubber", youngs_modulus=1e-3, poissons_ratio=0.3)
DIAMOND = Material("diamond", youngs_modulus=1e3, poissons_ratio=0.3)
STEEL = Material("steel", youngs_modulus=2.0, poissons_ratio=0.3)
BODIES = {  # bodies with thicknesses in parts of the longest side, and friction
    "unit": ((UNIT, None), 0.0),
    "friction 0.1": ((UNIT, None), 0.1),
    "friction 1": ((UNIT, None), 1.0),  # Dundurs' beta of 1/2, the largest there is
    "friction -1": ((UNIT, None), -1.0),
    "diamond film": ((STEEL, (DIAMOND, 0.3 / 24)), 0.0),
    "thick rubber": ((STEEL, (RUBBER, 1.25)), 0.0),
    "thin rubber and friction": ((STEEL, (RUBBER, 1e-5)), 0.5),
}
AXES = {
    "surface": list(SURFACES),
    "control": [
        *(("load", factor) for factor in (1e-12, 1e-6, 1e-3, 0.1, 1.0, 100.0)),
        *(("approach", share) for share in (-0.1, 1e-6, 0.3, 0.95, 1.8)),
        *(("mean_gap", share) for share in (0.0, 0.03, 0.9)),
    ],
    "bodies": list(BODIES),
    "shape": [(N, N), (37, 41), (61, 67), (24, 45), (97, 3), (3, 64), (96, 1), (1, 128)],
    "cap": [None, 1.0, 1.001, 2.0, 10.0, 1e3, 1e6],
    "boundaries": list(BOUNDARIES),
    "aspect": [1.0, 0.1, 10.0],
}


def grid_of(row):
    side = max(row["shape"])
    return Grid(row["shape"], (1 / side, row["aspect"] / side), periodic=BOUNDARIES[row["boundaries"]])


def operator_of(row):
    (material, layer), friction = BODIES[row["bodies"]]
    body = Body(material, layer=layer and Layer(*layer))
    return displacement_operator(grid_of(row), body, friction=friction)


def gap_of(row):
    nx, ny = row["shape"]
    gap = SURFACES[row["surface"]]((np.arange(nx)[:, None] + 0.5) / nx, (np.arange(ny)[None, :] + 0.5) / ny)
    return HEIGHT * gap / gap.std()


@pytest.mark.drawn(2)
@pytest.mark.parametrize("row", pairwise(AXES), ids=lambda row: "-".join(str(value) for value in row.values()))
def test_every_pair_of_surface_control_bodies_grid_and_cap(row):
    op, gap = operator_of(row), gap_of(row)
    modulus, area = op.modulus_at(2 * np.pi), op.grid.area
    control, value = row["control"]
    drop = gap.mean() - gap.min()
    if control == "load":
        value *= modulus * HEIGHT * area
        # a softer cap displaces less than the round-off of the gap, and the load of its last cell is not resolved
        hardness = row["cap"] and max(row["cap"] * value / area, 1e-8 * modulus * HEIGHT)
    else:
        hardness = row["cap"] and row["cap"] * 0.1 * modulus * HEIGHT
        if control == "approach":
            # on a doubly periodic grid contact is full before the approach has reached the mean of the gap
            value = gap.min() + drop * (min(value, 0.999) if row["boundaries"] == "periodic" else value)
        else:
            value *= drop
    if hardness:
        hardness *= 1 + 1e-12  # a sum over the cells may round the load that the cap carries
    solution = solve_contact(gap, op, hardness=hardness, tolerance=TOLERANCE, **{control: float(value)})
    if solution.status == "infeasible":
        # under a stiff film even a uniform displacement needs tension somewhere, so that no pressure closes the gap
        assert (control, value, hardness) == ("mean_gap", 0.0, None)
        assert np.linalg.solve(dense(op), np.ones(gap.size)).min() < 0
        return
    verify(solution, gap, op, hardness, {control: float(value)})
    assert (solution.plastic_depth >= 0).all()
    assert solution.plastic_area <= solution.contact_area


@pytest.mark.parametrize("shape", [(1, 1), (1, 2), (2, 1), (2, 2), (5, 5)])
@pytest.mark.parametrize(
    ("periodic", "control"),
    [(FREE, {"load": 1e-6}), (HALF_X, {"load": 1.0}), (HALF_Y, {"approach": 0.05}), (PERIODIC, {"load": 0.01})],
)
def test_grids_of_a_few_cells(shape, periodic, control):
    gap = 0.01 * np.arange(shape[0] * shape[1]).reshape(shape)
    check(gap, operator(shape, (1 / max(shape), 1 / max(shape)), periodic), **control)


@EVERY_BOUNDARY
def test_a_vanishing_load_is_carried_by_one_cell(periodic):
    op = operator((N, N), (1 / N, 1 / N), periodic)
    assert check(-0.01 * rough(N, N), op, load=1e-12).counted_area == pytest.approx(op.grid.cell_area)


@EVERY_BOUNDARY
@pytest.mark.parametrize("ratio", [1e-3, 1e3])
def test_a_contact_below_and_above_a_cap_is_plastic_and_elastic(periodic, ratio):
    op = operator((32, 36), (1 / 36, 1 / 36), periodic)
    gap = -0.01 * rough(32, 36)
    elastic = check(gap, op, load=1e-2)
    hardness = ratio * 1e-2 / elastic.contact_area
    carried = min(1e-2, 0.5 * hardness * op.grid.area)
    solution = check(gap, op, load=carried, hardness=hardness)
    if ratio < 1:
        assert solution.plastic_area > 0.8 * solution.contact_area
    else:
        assert solution.plastic_area == 0
        # both certified to 1e-8 of the roughness; pressures follow with the condition of the contact, below 1e3
        assert np.abs(solution.pressure - elastic.pressure).max() <= 1e-5 * elastic.pressure.max()
    with pytest.raises(InfeasibleError):
        solve_contact(gap, op, load=1.001 * hardness * op.grid.area, hardness=hardness)


@EVERY_BOUNDARY
@pytest.mark.parametrize("share", [0.999, 1.0])
def test_all_cells_at_the_cap(periodic, share):
    op = operator((24, 24), (1 / 24, 1 / 24), periodic)
    solution = check(-0.01 * rough(24, 24), op, load=share * 0.02 * op.grid.area, hardness=0.02)
    assert solution.plastic_area >= 0.99 * op.grid.area


@EVERY_BOUNDARY
@pytest.mark.parametrize(("offset", "hardness"), [(0.0, 1 / 600), (3.3, None)])
def test_flat_on_flat(periodic, offset, hardness):
    op = operator((32, 32), (1.0, 1.0), periodic)
    solution = check(np.full((32, 32), offset), op, load=1.0, hardness=hardness)
    assert solution.contact_area == pytest.approx(op.grid.area)


@pytest.mark.parametrize("share", [0.99, 0.9999, 1.0, 1.01, 10.0])
@pytest.mark.parametrize("crossed", [False, True])
def test_sinusoids_to_full_contact_and_beyond(share, crossed):
    """Full contact (Johnson 1985, 13.2): the pressure is the mean plus E* q/2 times the height of the wave."""
    x, y = (2 * np.pi * axis for axis in np.meshgrid(*(np.arange(N) / N,) * 2, indexing="ij"))
    wave = np.cos(x) * (np.cos(y) if crossed else 1.0)
    full = np.pi * 0.01 * (np.sqrt(2) if crossed else 1.0)
    op = operator((N, N), (1 / N, 1 / N), PERIODIC)
    solution = check(0.01 * (1 - wave), op, load=share * full)
    if share > 1:
        assert solution.counted_area == pytest.approx(op.grid.area)
        assert np.abs(solution.pressure - full * (share + wave)).max() <= 1e-7 * full
    elif share < 1:
        assert solution.counted_area < op.grid.area


@EVERY_BOUNDARY
def test_a_wide_mean_gap_leaves_the_bodies_apart(periodic):
    assert check(-0.01 * rough(N, N), operator((N, N), (1 / N, 1 / N), periodic), mean_gap=0.05).load == 0


@pytest.mark.parametrize(("periodic", "size", "modulus"), [(FREE, 1e-9, 1e12), (PERIODIC, 1e-4, 1e3), (FREE, 1.0, 1e3)])
def test_units_leave_the_solution_alone(periodic, size, modulus):
    gap = -0.01 * rough(N, N)
    reference = check(gap, operator((N, N), (1 / N, 1 / N), periodic), load=1e-3, hardness=0.05)
    op = operator((N, N), (size / N, size / N), periodic, modulus)
    solution = check(gap * size, op, load=1e-3 * modulus * size**2, hardness=0.05 * modulus)
    # rounding of scaled input may tip a cell's state once in a while
    assert abs(solution.iterations - reference.iterations) <= 3
    assert np.abs(solution.pressure / modulus - reference.pressure).max() <= 1e-5 * reference.pressure.max()


def test_powers_of_two_leave_the_bits_alone():
    gap = -0.01 * rough(N, N)
    reference = check(gap, operator((N, N), (1 / N, 1 / N), PERIODIC), load=1e-3)
    op = operator((N, N), (2.0**-20 / N, 2.0**-20 / N), PERIODIC, 2.0**30)
    solution = check(gap * 2.0**-20, op, load=1e-3 * 2.0**-10)
    assert np.array_equal(solution.pressure, reference.pressure * 2.0**30)
    assert solution.iterations == reference.iterations


@pytest.mark.parametrize("periodic", [FREE, PERIODIC])
@pytest.mark.parametrize("load", [1e-8, 1.0, 1e4])
def test_roughness_below_the_round_off_of_the_gap_converges_or_stalls(periodic, load):
    """The gap holds 1e-10 of round-off, a hundredth of its roughness: no answer to 1e-8 need exist."""
    op = operator((29, 29), (1.0, 1.0), periodic)
    gap = 1e6 + 1e-6 * rough(29, 29)
    solution = solve_contact(gap, op, load=load, tolerance=TOLERANCE)
    if solution.status == "stalled":
        assert solution.residual > TOLERANCE
    else:
        assert solution.status == "converged"
        reach = np.abs(solution.displacement).max()
        assert (
            violation(op, gap, solution) <= TOLERANCE * gap.std() + 1e-11 * reach + 2.0**-46 * solution.pressure.mean()
        )


@settings(max_examples=30, deadline=None)
@given(
    shape=st.tuples(st.integers(1, 33), st.integers(1, 33)),
    periodic=st.tuples(st.booleans(), st.booleans()),
    exponent=st.floats(-10, 2),
    nu=st.floats(0, 0.5, exclude_max=True),
    friction=st.floats(-1, 1),
    cap=st.one_of(st.none(), st.floats(-3, 3)),
    hurst=st.floats(0.1, 1.0),
    seed=st.integers(0, 999),
)
def test_anything_ends_certified_or_is_refused(shape, periodic, exponent, nu, friction, cap, hurst, seed):
    body = Body(Material("body", youngs_modulus=1.0, poissons_ratio=nu))
    op = displacement_operator(Grid(shape, (1 / max(shape),) * 2, periodic=periodic), body, friction=friction)
    gap = -0.01 * rough(max(shape[0], 3), max(shape[1], 3), seed, hurst)[: shape[0], : shape[1]]
    load = 10.0**exponent
    hardness = None if cap is None else 10.0**cap * load / op.grid.area
    # a load equal to what the hardness carries is none too many, whatever way round it was multiplied out
    if hardness is not None and load > hardness * op.grid.area * (1 + 1e-12):
        with pytest.raises(InfeasibleError):
            solve_contact(gap, op, load=load, hardness=hardness)
        return
    solution = solve_contact(gap, op, load=load, hardness=hardness, tolerance=TOLERANCE)
    assert solution.status == "converged"
    reach = np.abs(solution.displacement).max()
    # round-off of the product where displacements exceed the roughness, and of an even pressure on a doubly periodic
    # grid, which displaces nothing and is rounded as if by a cell's spacing over the modulus, of 1 here
    rounded = 2.0**-46 * solution.pressure.mean() * max(op.grid.spacing)
    allowed = TOLERANCE * gap.std() + 1e-11 * max(gap.std(), reach) + rounded
    assert violation(op, gap, solution, np.inf if hardness is None else hardness) <= allowed
