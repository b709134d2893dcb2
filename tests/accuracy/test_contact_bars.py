"""Error bars of contacts: what covers, and what has none."""

from dataclasses import replace

import numpy as np
import pytest

from bem import Body, Grid, Layer, Material, displacement_operator, generate_surface, solve_contact
from bem.accuracy import ContactCase, contact_bars, figures_of, solve_coarser, stress_bars, surface_is_resolved
from bem.errors import Status
from bem.notes.accuracy import NoBar
from bem.reference_solutions.hertz import ellipse_contact
from bem.stress import summarise_stress, with_layer_depths

STEEL = Material("steel", youngs_modulus=200e9, poissons_ratio=0.3)


def case_of(gap, grid, **given):
    operator = displacement_operator(grid, Body(STEEL))
    return ContactCase(operator, gap, solve_contact(gap, operator, **given), **given)


def ball(cells, load=1.0, radius=1e-3, periodic=(False, False)):
    grid = Grid((cells, cells), (1.0e-4 / cells,) * 2, periodic=periodic)
    gap = grid.x[:, None] ** 2 / (2 * radius) + grid.y**2 / (2 * radius)
    return case_of(gap, grid, load=load)


@pytest.mark.parametrize("cells", [31, 48, 64, 101])
def test_bars_of_a_ball_cover_hertz(cells):
    case = ball(cells)
    bars = contact_bars(case, solve_coarser(case)).values
    found = figures_of(case.solution, case.grid.area)
    modulus = STEEL.plane_strain_modulus
    a = (0.75 * 1.0 * 1e-3 / modulus) ** (1 / 3)
    truth = {
        "contact_area": np.pi * a**2,
        "mean_contact_pressure": 1.0 / (np.pi * a**2),
        "max_pressure": 1.5 / (np.pi * a**2),
        "approach": a**2 / 1e-3,
    }
    for name, value in truth.items():
        assert abs(found[name] - value) <= bars[name], name
        # a bar says something: here all of these are known to some per cent
        assert bars[name] < 0.1 * value, name
    # a prescribed load has no error but the residual's
    assert bars["load"] <= 1e-8


@pytest.mark.parametrize("sides", [(0.05, 0.05), (0.05, 0.1)])
def test_cells_displace_their_centres_less_by_the_square_of_the_cell_times_the_curvature(sides):
    """A Gaussian pressure of width s pushes in its middle by sqrt(2 pi) p s / E*, bent there by 1/s^2 of that, a half
    on each axis; what is left is of third order in the cell (3 and 5 % here)."""
    width = 1e-6
    grid = Grid((201, 201), (sides[0] * width, sides[1] * width))
    pressure = 1e8 * np.exp(-(grid.x[:, None] ** 2 + grid.y**2) / (2 * width**2))
    found = displacement_operator(grid, Body(STEEL))(pressure)[100, 100]
    exact = np.sqrt(2 * np.pi) * 1e8 * width / STEEL.plane_strain_modulus
    assert found / exact - 1 == pytest.approx(-(sides[0] ** 2 + sides[1] ** 2) / 48, rel=0.08)


@pytest.mark.parametrize("given", ["load", "approach"])
def test_small_balls_anywhere_in_their_cells_are_covered(given):
    """3 to 9 cells wide, twice as long as wide in half of them. Of what bent surfaces lose in cells the edge gives back
    about two thirds; without that part of the bar three in twenty were not covered, where differences pass zero."""
    rng, shares, ratios = np.random.default_rng(15), [], []
    hertz = ellipse_contact(radii=(1e-3, 1e-3), contact_modulus=STEEL.plane_strain_modulus, load=1.0)
    for n in range(60):
        sides = np.array([1.0, 2.0 if n % 2 else 1.0])
        sides *= 2 * hertz.semi_axes[0] / rng.uniform(3, 9) / sides.max()
        grid = Grid((36, 34), (float(sides[0]), float(sides[1])))
        x, y = (axis - rng.uniform(-0.5, 0.5) * side for axis, side in zip((grid.x, grid.y), sides, strict=True))
        case = case_of((x[:, None] ** 2 + y**2) / 2e-3, grid, **{given: getattr(hertz, given)})
        name = "approach" if given == "load" else "load"
        bar = contact_bars(case, solve_coarser(case)).values[name]
        error = figures_of(case.solution, grid.area)[name] / getattr(hertz, name) - 1
        power = -1.0 if given == "load" else 1.5  # stiffness: of a load at a given approach 3/2 of it
        shares.append(error / power / ((sides**2).sum() / 24e-3 / hertz.approach))
        ratios.append(bar / abs(error * getattr(hertz, name)))
    assert 0.2 < np.mean(shares) < 0.5
    assert np.mean(np.array(ratios) >= 1) >= 0.95
    assert np.median(ratios) < 5


@pytest.mark.parametrize(("periodic", "fill"), [(False, 0.25), (False, 0.6), (True, 0.4), (True, 0.7), (True, 0.8)])
def test_at_a_given_mean_gap_load_and_approach_have_the_error_of_the_mean(periodic, fill):
    """Balls and cylinders (one axis periodic) over so much of a grid along x, against four times finer ones at a load.
    The midpoint rule's error of the mean gap moved load and approach up to 1.8 times as far as their bars."""
    across, found, known = 1e-4, [], []
    for cells in (32, 128):
        grid = Grid((cells, cells), (across / cells,) * 2, periodic=(False, periodic))
        x, y = grid.x[:, None], 0.0 if periodic else 1.0
        gap = (x**2 + y * grid.y**2) / 2e-3 + 0 * grid.y
        load = STEEL.plane_strain_modulus * (fill * across / 2) ** 2 / 1e-3
        load *= np.pi / 4 * across if periodic else 4 / 3 * fill * across / 2
        case = case_of(gap, grid, load=load)
        known.append(figures_of(case.solution, grid.area))
        found.append(case)
    case = case_of(found[0].undeformed, found[0].grid, mean_gap=known[1]["mean_gap"])
    bars = contact_bars(case, solve_coarser(case)).values
    own = figures_of(case.solution, case.grid.area)
    for name in ("load", "approach", "contact_area", "mean_contact_pressure"):
        error = abs(own[name] - known[1][name])
        assert error <= bars[name], name
        assert bars[name] < 0.1 * known[1][name], name


def test_bars_shrink_with_the_cell():
    bars = [contact_bars(case, solve_coarser(case)).values for case in (ball(32), ball(128))]
    for name in ("contact_area", "max_pressure", "approach"):
        assert bars[1][name] < 0.5 * bars[0][name], name


def test_the_coarser_contact_costs_a_fraction():
    case = ball(128)
    before = case.operator.count.weighted
    assert solve_coarser(case).solution.status is Status.CONVERGED
    assert case.operator.count.weighted - before < 0.5 * case.solution.convolutions


def test_a_punch_has_no_bar_for_its_highest_pressure():
    grid = Grid((64, 64), (1e-6, 1e-6))
    x, y = grid.x[:, None], grid.y
    gap = np.where((abs(x) < 12e-6) & (abs(y) < 12e-6), 0.0, 1e-3)
    case = case_of(gap, grid, load=1.0)
    bars = contact_bars(case, solve_coarser(case))
    assert bars.values["max_pressure"] is None
    assert any(note.values["reason"] == "sharp-pressure" for note in bars.notes)
    assert bars.values["approach"] > 0


@pytest.mark.parametrize("given", ["load", "approach", "mean_gap"])
def test_what_is_prescribed_has_no_error_whatever_the_residual(given):
    """The residual of an approach was shown as its error bar."""
    known = ball(32)
    value = figures_of(known.solution, known.grid.area)[given]
    case = case_of(known.undeformed, known.grid, **{given: value})
    case = replace(case, solution=replace(case.solution, residual=1e-4))
    bars = contact_bars(case, solve_coarser(case))
    names = {"load", "approach", "mean_gap"}
    assert {name for name in names if bars.values[name] == 0} == {given}
    assert {part[given] for part in bars.parts.values()} == {0.0}


def test_a_contact_at_a_free_edge_has_no_bars():
    grid = Grid((32, 32), (1e-6, 1e-6))
    case = case_of(np.zeros(grid.shape), grid, load=1.0)
    bars = contact_bars(case, solve_coarser(case))
    assert {name for name, value in bars.values.items() if value is not None} == {"load"}
    (note,) = bars.notes
    assert note.values["reason"] == "free-edge"


def test_the_free_edge_is_seen_from_the_pressure_and_not_from_the_words_of_notes():
    case = ball(32, load=40.0)
    silent = replace(case, solution=replace(case.solution, notes=()))
    assert solve_coarser(silent).solution is None
    assert solve_coarser(silent).why == solve_coarser(case).why != ""
    within = ball(32)
    noisy = replace(within, solution=replace(within.solution, notes=case.solution.notes))
    assert solve_coarser(noisy).solution is not None


def test_an_approach_that_other_cells_cannot_meet_has_no_bars():
    """In full contact a doubly periodic body comes no closer than its mean gap, which the coarser grid's is not."""
    grid = Grid((32, 32), (1e-6, 1e-6), periodic=(True, True))
    gap = 1e-9 * np.random.default_rng(4).random(grid.shape)
    gap[1, 1] = -0.5e-9  # of the cells that the coarser grid leaves out
    gap -= gap.min()
    case = replace(case_of(gap, grid, load=100.0), load=None, from_touch=True)
    case = replace(case, approach=case.solution.approach)
    coarser = solve_coarser(case)
    assert coarser.solution is None
    bars = contact_bars(case, coarser)
    assert {name: value for name, value in bars.values.items() if value is not None} == {"approach": 0.0}
    assert bars.notes[0].values["reason"] == "impossible"


def test_perimeters_of_capped_balls_are_covered():
    """Anywhere in their cells, 16 to 28 cells wide, against four times finer ones: three of 24 were not with half the
    share at the edge, where the difference to the grid of twice the cell passes zero."""
    rng, covered = np.random.default_rng(3), []
    for _ in range(24):
        radius = rng.uniform(8, 14) * 1e-7
        modulus, bend = STEEL.plane_strain_modulus, 0.05 / radius
        hardness = rng.uniform(0.5, 0.9) * 2 * modulus * radius * bend / np.pi
        given, centre = {"load": 4 / 3 * modulus * radius**3 * bend, "hardness": hardness}, rng.uniform(-5e-8, 5e-8, 2)
        cases = []
        for finer in (1, 4):
            grid = Grid((40 * finer, 40 * finer), (1e-7 / finer, 1e-7 / finer))
            x, y = grid.x[:, None] - centre[0], grid.y - centre[1]
            cases.append(case_of(bend / 2 * (x**2 + y**2), grid, **given))
        bar = contact_bars(cases[0], solve_coarser(cases[0])).values["contact_perimeter"]
        own, truth = (case.solution.contact_perimeter for case in cases)
        assert bar < 0.05 * own
        covered.append(abs(own - truth) <= bar)
    assert np.mean(covered) >= 0.95


def test_plastic_area_has_the_error_of_its_own_edge():
    """A few cells at the hardness in a large contact: their edge is most of them, the contact's a little of it."""
    grid = Grid((64, 64), (1e-6, 1e-6))
    gap = (grid.x[:, None] ** 2 + grid.y**2) / 2e-3
    operator = displacement_operator(grid, Body(STEEL))
    free = solve_contact(gap, operator, load=0.3)
    hardness = 0.95 * float(free.pressure.max())
    case = ContactCase(operator, gap, solve_contact(gap, operator, load=0.3, hardness=hardness), 0.3, hardness=hardness)
    bars, found = contact_bars(case, solve_coarser(case)), figures_of(case.solution, grid.area)
    plastic, area = (bars.values[n] / found[n] for n in ("plastic_area_fraction", "contact_area_fraction"))
    assert 0.01 < plastic < 0.5
    assert plastic > 2 * area


def ball_on_coat():
    """Contact of a ball with a stiff coat of 3.7 um, its grid and the coated body."""
    coat = Layer(Material("coat", youngs_modulus=600e9, poissons_ratio=0.25), 3.7e-6)
    body = Body(STEEL, layers=(coat,))
    grid = Grid((48, 48), (1e-6, 1e-6))
    gap = (grid.x[:, None] ** 2 + grid.y**2) / 1e-3
    operator = displacement_operator(grid, body)
    case = ContactCase(operator, gap, solve_contact(gap, operator, load=0.5), load=0.5)
    return case, grid, body


def test_a_stress_that_jumps_at_an_interface_may_be_higher_there():
    case, grid, body = ball_on_coat()
    coarse, fine = np.linspace(0, 12e-6, 9), np.linspace(0, 12e-6, 121)
    found, truth = (summarise_stress(case.solution.pressure, grid, body, depths) for depths in (coarse, fine))
    bars = stress_bars(case, solve_coarser(case), body, found)
    missed = truth.highest.max() - found.max_von_mises
    assert missed > 0.02 * truth.highest.max()
    assert missed <= bars.parts["depths"]["max_von_mises"]


def test_depths_on_both_sides_of_an_interface_leave_little_open():
    """The jump there is no slope of the stress: a parabola across it rose to twenty times the highest stress."""
    case, grid, body = ball_on_coat()
    few = np.array(with_layer_depths(tuple(np.linspace(0, 12e-6, 9)), body))
    fine = np.array(with_layer_depths(tuple(np.linspace(0, 12e-6, 121)), body))
    found, truth = (summarise_stress(case.solution.pressure, grid, body, depths) for depths in (few, fine))
    bars = stress_bars(case, solve_coarser(case), body, found)
    left = bars.parts["depths"]["max_von_mises"]
    assert abs(truth.max_von_mises - found.max_von_mises) <= left + 1e-3 * found.max_von_mises
    assert left < 0.02 * found.max_von_mises


def bars_below(case, depths):
    below = summarise_stress(case.solution.pressure, case.grid, Body(STEEL), depths)
    return stress_bars(case, solve_coarser(case), Body(STEEL), below)


def test_highest_stress_of_a_ball_is_covered():
    case = ball(64)
    a = (0.75 * 1.0 * 1e-3 / STEEL.plane_strain_modulus) ** (1 / 3)
    depths = np.linspace(0, 2 * a, 15)
    below = summarise_stress(case.solution.pressure, case.grid, Body(STEEL), depths)
    bars = stress_bars(case, solve_coarser(case), Body(STEEL), below).values
    # Johnson, Contact Mechanics, section 3.4: for nu = 0.3 the largest shear stress, half of it, is 0.310 p0 at 0.48 a
    p0 = 1.5 / (np.pi * a**2)
    assert abs(below.max_von_mises - 0.620 * p0) <= bars["max_von_mises"] + 0.0005 * p0
    assert abs(below.max_von_mises_depth - 0.481 * a) <= bars["max_von_mises_depth"]
    assert bars["max_von_mises"] < 0.05 * p0
    deep = bars_below(case, depths[:3])
    assert deep.values["max_von_mises"] is None
    assert deep.notes[0].values["reason"] == "deepest-depth"
    # one depth that is asked for is no search for the deepest
    single = bars_below(case, depths[3:4])
    assert not single.notes
    assert 0 < single.values["max_von_mises"] < 0.05 * p0


def test_the_volume_that_yields_below_a_ball_is_covered():
    case = ball(64)
    a = (0.75 * 1.0 * 1e-3 / STEEL.plane_strain_modulus) ** (1 / 3)
    p0, depths = 1.5 / (np.pi * a**2), 2 * a * np.linspace(0, 1, 24) ** 2

    def below(strength):
        elastic = {"youngs_modulus": STEEL.youngs_modulus, "poissons_ratio": STEEL.poissons_ratio}
        body = Body(Material("steel", **elastic, yield_stress=strength))
        found = summarise_stress(case.solution.pressure, case.grid, body, depths)
        return found.yielded_volume, stress_bars(case, solve_coarser(case), body, found).values

    volume, bars = below(0.55 * p0)
    # Hamilton's closed form, see tests/stress/test_stress_summary.py
    assert abs(volume - 0.36835 * a**3) <= bars["yielded_volume"] < 0.3 * volume
    assert below(2 * p0)[1]["yielded_volume"] == 0
    assert "yielded_volume" not in bars_below(case, depths).values  # steel without a yield stress


def test_what_a_grid_of_twice_the_cell_resolves():
    grid = Grid((120, 120), (1.0, 1.0), periodic=(True, True))
    for cells, resolved in ((4, False), (6, False), (12, True), (30, True)):
        waves = np.sin(2 * np.pi * grid.x / cells)[:, None] + 0 * grid.y
        assert surface_is_resolved(waves, grid) is resolved
    assert surface_is_resolved(grid.x[:, None] ** 2 + grid.y**2, grid)
    # small waves on a large ball are still seen
    assert not surface_is_resolved(grid.x[:, None] ** 2 * 1e-3 + (-1.0) ** np.arange(120), grid)


@pytest.mark.parametrize(("load", "known"), [(1e-9, False), (3e-6, False), (3e-2, True)])
def test_a_contact_of_one_or_two_cells_has_no_bars(load, known):
    # four cells on either grid: the highest pressure was 94 % low under a bar of 0.04 %
    case = ball(64, load=load)
    across = int((case.solution.pressure > 0).any(axis=1).sum())
    assert (across > 2) == known
    coarser = solve_coarser(case)
    bars = contact_bars(case, coarser).values
    assert (bars["max_pressure"] is not None) == known
    assert (coarser.why is NoBar.FEW_CELLS_WIDE) != known


@pytest.mark.parametrize(("share", "known"), [(0.5, True), (1.0005, False)])
def test_the_highest_pressure_is_the_hardness_where_more_than_the_bar_is_at_it(share, known):
    """Its bar was that of a pressure that follows the edge of contact, of what is known exactly."""
    free = ball(64)
    hardness = share * float(free.solution.pressure.max())
    case = case_of(free.undeformed, free.grid, load=1.0, hardness=hardness)
    bars, found = contact_bars(case, solve_coarser(case)), figures_of(case.solution, case.grid.area)
    assert (found["plastic_area_fraction"] > bars.values["plastic_area_fraction"]) is known
    assert (bars.values["max_pressure"] < 1e-6 * hardness) is known


def test_bodies_that_do_not_touch_stand_off_by_what_the_mean_gap_is_off():
    """A cylinder at a mean gap greater than that of first touch: the midpoint rule's mean is h^2 / 24 R off."""
    radius, across, cells = 1e-3, 1e-4, 64
    grid = Grid((cells, cells), (across / cells,) * 2, periodic=(False, True))
    gap = grid.x[:, None] ** 2 / (2 * radius) + 0 * grid.y
    mean_gap = across**2 / (24 * radius) * 1.5
    case = case_of(gap, grid, mean_gap=mean_gap)
    bars = contact_bars(case, solve_coarser(case)).values
    assert not case.solution.pressure.any()
    error = abs(case.solution.approach - (across**2 / (24 * radius) - mean_gap))
    assert error > 1e-5 * mean_gap
    assert error <= bars["approach"] * (1 + 1e-6) < 3 * error  # exact but for round-off


def test_mean_gaps_of_waves_at_a_load_are_covered():
    """Crossed waves from a fifth to nine tenths of what closes them, against grids four times finer. Displacements have
    no mean there, so the mean gap is as far off as the approach; taken as a share of itself it was covered 4 times in
    15."""
    side, amplitude, ratios = 1e-4, 1e-7, []
    for share in (0.2, 0.5, 0.7, 0.8, 0.9):
        load = share * np.pi * STEEL.plane_strain_modulus * amplitude * side

        def wave(cells, load=load):
            grid = Grid((cells, cells), (side / cells,) * 2, periodic=(True, True))
            along, across = (np.cos(2 * np.pi * axis / side) for axis in (grid.x, grid.y))
            return case_of(amplitude * (1 - along[:, None] * across), grid, load=load)

        finer = wave(256)
        known = figures_of(finer.solution, finer.grid.area)["mean_gap"]
        for cells in (33, 48, 64):
            case = wave(cells)
            bar = contact_bars(case, solve_coarser(case)).values["mean_gap"]
            ratios.append(bar / abs(figures_of(case.solution, case.grid.area)["mean_gap"] - known))
    assert np.mean(np.array(ratios) >= 1) >= 0.85
    assert np.median(ratios) < 10


def test_balls_on_generated_surfaces_are_covered_by_four_times_the_cells():
    """Waves stood still under the grid's corner, and so moved under the ball by half a cell with the cell: of sixteen
    such contacts three had a highest pressure beyond its bar and ten a mean gap, by up to 4.6 bars."""
    ratios = []
    for seed in range(1, 9):
        cases = []
        for cells in (64, 256):
            grid = Grid((cells, cells), (1e-4 / cells,) * 2)
            rough = generate_surface(
                grid, rms_height=60e-9, hurst=0.8, rolloff_wavelength=40e-6, cutoff_wavelength=10e-6, seed=seed
            )
            cases.append(case_of((grid.x[:, None] ** 2 + grid.y**2) / 1e-2 - rough, grid, load=0.4))
        coarse, fine = cases
        bars, there = contact_bars(coarse, solve_coarser(coarse)).values, figures_of(fine.solution, fine.grid.area)
        ratios += [
            abs(found - there[name]) / bar
            for name, found in figures_of(coarse.solution, coarse.grid.area).items()
            if (bar := bars.get(name) or 0.0) > 1e-6 * abs(found)
        ]
    assert len(ratios) > 40
    assert np.mean(np.array(ratios) > 1) < 0.05
    assert max(ratios) < 2
