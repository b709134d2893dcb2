"""Curves and stresses beside other codes: the exact ball, stubs in place of peers, rows and the page. No network."""

import dataclasses
import json
import math
import sys
from pathlib import Path

import numpy as np
import pytest

from bem import Grid, InputError, displacement_operator, solve_contact
from bem.benchmarks.contact_cases import LOADS, POISSON, UNIT
from bem.benchmarks.measure import Point
from bem.benchmarks.record import new_run
from bem.reference_solutions.hertz import sphere_contact
from bem.stress import subsurface_stress, von_mises
from reports import beside as page
from reports.benchmarks import peer_curves, peer_stresses, peers
from reports.benchmarks.beside import (
    CURVE_HEADERS,
    MISES_HEADERS,
    STRESS_HEADERS,
    CurveBeside,
    StressBeside,
    curve_rows,
    mises_rows,
    stress_rows,
)
from reports.benchmarks.history import append_run, read_history, stored_run
from reports.benchmarks.peer_cases import (
    AXES,
    PEER_CASES,
    RADIUS,
    ball_depths,
    ball_grid,
    ball_pressure,
    exact_error,
    exact_stress,
    highest_mises,
    load_area,
)
from reports.benchmarks.run import add_peers

pytestmark = pytest.mark.internal

HERE = Path(sys.executable)


def said(words):
    pass


def point(case="peer-curve", cpu=0.1, error=0.0, **values):
    return Point(case, 64, 1, 0.0, (cpu,) * 3, (cpu,) * 3, 0.0, {"error": error, "residual": error}, {}, values, {})


CURVE = CurveBeside(
    *("other", "from nothing", 128, (2.0, 1.0, 3.0), 1e-6, 0.0, 1e-4, 1e-6, 5, 1e-7, (0.1,), 0.3),
    *(64, 0.2, (0.05,)),
)
STRESS = StressBeside(
    *("other", "free", 128, 16, (0.8,), (0.4,), 1e-15, 1e-3, 1e-3, (0.2,), (0.1,)),
    *(0.01, (0.9,), 64, 0.005, (0.03,)),
)


def test_the_exact_array_of_balls_is_in_equilibrium_and_almost_the_ball_alone_close_by():
    """Two sources: a series summed here, Hamilton's closed form. Their difference is smooth: that of far balls."""
    n, depth = 64, RADIUS / 2
    array, alone = exact_stress(n, depth, "periodic"), exact_stress(n, depth, "free")
    mean = ball_pressure(256).mean()
    assert array[2].mean() == pytest.approx(-mean, rel=2e-4)  # the ball's mean from cells
    assert array[0].mean() == pytest.approx(-mean * POISSON / (1 - POISSON), rel=2e-4)
    middle = slice(n // 2 - 8, n // 2 + 9)
    near = np.abs(array - alone)[:, middle, middle]
    assert near[3:].max() < 0.02  # shears of far balls cancel in the middle
    assert near[2].max() < 0.02  # what far balls press this deep falls as depth^3 / distance^5
    assert np.abs(array[:, n // 2, n // 2] - array[[1, 0, 2, 4, 3, 5], n // 2, n // 2]).max() < 1e-14
    # equilibrium: d(xz)/dx + d(yz)/dy + d(zz)/dz = 0, by the series' own derivatives along x and y
    waves = 2j * np.pi * np.fft.fftfreq(n, 1 / n)
    step = 1e-4
    below, above = (exact_stress(n, depth + sign * step, "periodic")[2] for sign in (1, -1))
    shear = np.fft.ifft2(waves[:, None] * np.fft.fft2(array[4]) + waves[None, :] * np.fft.fft2(array[3])).real
    assert np.abs(shear + (below - above) / (2 * step)).max() < 1e-5 * np.abs(shear).max()


@pytest.mark.parametrize("axes", AXES)
def test_stresses_of_the_ball_converge_to_the_exact_ones(axes):
    errors = [
        exact_error(subsurface_stress(ball_pressure(n), ball_grid(n, axes), UNIT, ball_depths(n, axes)), n, axes)
        for n in (64, 128)
    ]
    assert errors[1] < 0.4 * errors[0]  # 0.31 and 0.28: the pressure ends like a root
    assert errors[1] < 2e-3


def test_the_highest_stress_of_a_ball_is_hertzs():
    assert highest_mises("free") == pytest.approx(0.62, abs=1e-3)  # Johnson, Contact Mechanics, 4.2, nu 0.3
    depths = RADIUS * np.linspace(0.42, 0.56, 15)
    field = [von_mises(exact_stress(32, float(z), "periodic")[:, 16:17, 16:17]).max() for z in depths]
    assert highest_mises("periodic") == pytest.approx(max(field), rel=1e-4)


ROOT = Path(__file__).resolve().parents[2]
OURS = """
import sys
sys.path.insert(0, {root!r})
from bem.benchmarks.contact_cases import UNIT
from reports.benchmarks.peer_cases import ball_depths, ball_grid
from bem.stress import summarise_stress, subsurface_stress
axes = "{axes}"
def stresses():
    return subsurface_stress(gap, ball_grid(n, axes), UNIT, ball_depths(n, axes)){change}
def highest():
    return summarise_stress(gap, ball_grid(n, axes), UNIT, ball_depths(n, axes)).max_von_mises_of_points
keep(stresses, mises=highest)
"""


def stub(monkeypatch, change="", **times):
    """bem in place of tamaas, and points that are not measured: errors fall with the square of the cells."""
    monkeypatch.setattr(
        peer_stresses, "SCRIPTS", {"tamaas": OURS.format(axes="periodic", change=change, root=str(ROOT))}
    )
    monkeypatch.setattr(peer_stresses, "_ORDERED", {"tamaas": lambda stress: stress})
    asked = []

    def measured(case, cells, threads, repeats):
        asked.append((case, cells))
        return point(case, cpu=cells / 1000, error=10.0 / cells**2)

    monkeypatch.setattr(peer_stresses, "measure_beside", measured)
    return asked


def test_a_peer_with_the_same_stresses_agrees_and_is_met_by_the_coarsest_grid(monkeypatch):
    asked, found, failures = stub(monkeypatch), [], {}
    peer_stresses.stresses_beside({"tamaas": HERE}, True, 2, said, found, failures)
    assert not failures
    (row,) = found
    assert row.difference < 1e-12
    assert (row.cells, row.depths, row.axes, row.kept_cpu) == (64, 8, "periodic", ())
    assert len(row.cpu) == len(row.mises_cpu) == 2
    assert row.error < 0.01
    assert row.bem_mises_cells in (32, 64)  # errors are 0.98 and 0.24 %, its points' 2.1
    assert row.bem_mises_error <= row.mises_error
    assert row.ratio == pytest.approx(np.median(row.cpu) / 0.064)
    assert len(asked) == len(set(asked))  # nothing is measured twice


@pytest.mark.parametrize("change", ["[[1, 0, 2, 4, 3, 5]]", " * 1.01"])
def test_a_peer_with_other_stresses_is_seen(change, monkeypatch):
    stub(monkeypatch, change)
    found = []
    peer_stresses.stresses_beside({"tamaas": HERE}, True, 1, said, found, {})
    assert found[0].difference > (5e-3 if "*" in change else -1.0)
    assert found[0].error > 5e-3


def test_a_peer_that_fails_is_named_and_the_others_go_on(monkeypatch):
    stub(monkeypatch)
    monkeypatch.setitem(peer_stresses.SCRIPTS, "slippy", "raise ImportError('no such code')")
    found, failures = [], {}
    peer_stresses.stresses_beside({"slippy": HERE, "tamaas": HERE}, True, 1, said, found, failures)
    assert [row.peer for row in found] == ["tamaas"]
    assert "no such code" in failures["slippy, stresses, 64"]


CURVE_STUB = """
from bem.benchmarks.contact_cases import PERIODIC, UNIT, solve_curve
from bem.convolution import displacement_operator
from bem.grid import Grid
operator = displacement_operator(Grid((n, n), (1 / n, 1 / n), periodic=PERIODIC), UNIT)
def solve():
    curve = solve_curve(gap, operator, 1e-5)
    assert len(curve) == len(loads)
    return [one.pressure for one in curve]
keep(solve)
"""


def test_a_peers_curve_is_judged_by_its_pressures_and_met_twice(monkeypatch):
    """bem to five digits as the peer: the same areas as bem's, eight digits of which are the measure."""
    known = {}

    def measured(case, code, threads, repeats):
        assert case == "peer-curve"
        cells, digits = int(code), round(100 * (code - int(code)))
        if (cells, digits) not in known:
            timed = load_area(min(cells, 64) + digits / 100)  # finer ones take too long here: errors are made up below
            outcome = timed.judge(timed.solve())
            shift = 2.0 / cells
            values = {k: v * (1 + shift) if k.startswith("area") else v for k, v in outcome.values.items()}
            errors = {"residual": outcome.errors["residual"]}
            known[cells, digits] = dataclasses.replace(point(), errors=errors, values=values)
        return known[cells, digits]

    monkeypatch.setattr(peer_curves, "measure_beside", measured)
    monkeypatch.setattr(peer_curves, "SCRIPTS", {("other", "as bem"): CURVE_STUB, ("none", "at all"): "exit(3)"})
    monkeypatch.setattr(peer_curves, "QUICK", (32, 64))
    for tolerances in ("TOLERANCES", "AREA_TOLERANCES"):
        monkeypatch.setattr(peer_curves, tolerances, {"other": 1e-5, "none": 1.0})
    found, failures = [], {}
    peer_curves.curves_beside(HERE, True, 1, said, found, failures)
    assert list(failures) == ["none, curve at all, 32", "none, curve at all, 64"]
    coarse, row = found
    assert coarse.limit_apart is None
    assert abs(row.limit_apart) < 1.0  # of 32 cells, fewer than the surface has waves
    assert row.residual < 1e-5
    assert row.load_error < 1e-9
    assert row.gap_difference < 1e-4
    assert row.area_difference < 0.02
    assert row.bem_residual <= row.residual
    # the loosest tolerance that is as good: one digit less is not
    assert row.bem_digits == 2 or known[64, row.bem_digits - 1].errors["residual"] > row.residual
    assert row.counted_error > 0.03  # against areas whose edge lies inside of cells
    assert len(row.area_cpu) == len(row.cpu) == 1
    assert row.bem_area_cells in (32, 64, 128)
    assert row.bem_area_error <= row.area_error


def test_a_peers_area_is_as_good_as_its_cells_allow():
    """Of balls anywhere, pressed by solutions on cells, against Hertz: all cells in contact are too many, to first
    order."""
    n, exact = 40, sphere_contact(radius=1.0, contact_modulus=1.0, load=1e-3)
    grid = Grid((n, n), (2.6 * exact.semi_axes[0] / n,) * 2)
    operator, rng = displacement_operator(grid, UNIT), np.random.default_rng(4)
    counted, without = [], []
    for dx, dy in rng.uniform(-0.5, 0.5, (12, 2)) * grid.spacing[0]:
        gap = exact.undeformed_gap(grid.x[:, None] - dx, grid.y[None, :] - dy)
        pressure = solve_contact(gap, operator, load=exact.load).pressure
        counted.append((pressure > 0).mean() * grid.area / exact.contact_area)
        without.append(peer_curves.area_of_steps(pressure) * grid.area / exact.contact_area)
    assert np.mean(counted) > 1.01  # 15 cells from the middle to the edge
    assert abs(np.mean(without) - 1) < 0.5 * (np.mean(counted) - 1)


def test_a_residual_that_bem_does_not_have_is_no_equal_one():
    assert dataclasses.replace(CURVE, bem_residual=1e-5).ratio is None
    assert "not reached" in curve_rows([dataclasses.replace(CURVE, bem_residual=1e-5)])[0]


@pytest.mark.parametrize(("wanted", "digits"), [(1.0, 2), (2e-5, 4), (1.1e-7, 6), (1e-13, 11), (0.0, 11)])
def test_the_loosest_tolerance_that_is_as_good(wanted, digits):
    asked = []

    def residual_of(number):
        asked.append(number)
        return 10.0 ** -(number + 1)

    assert peer_curves.loosest(wanted, residual_of) == digits
    assert len(asked) <= 4


def test_the_coarsest_grid_is_one_that_finer_ones_do_not_take_back():
    errors = [(64, 0.01), (128, 0.05), (256, 0.02), (512, 0.001)]
    assert peer_curves.coarsest(errors, 0.03) == 256
    assert peer_curves.coarsest(errors, 0.06) == 64
    assert peer_curves.coarsest(errors, 1e-4) is None
    assert peer_curves.coarsest([(64, math.nan)], 1.0) is None


def test_the_limit_of_areas_follows_from_two_grids():
    exact = np.linspace(0.01, 0.4, len(LOADS))
    two = [
        point(**{f"area_{k}": a * (1 + 8.0 / n**2) for k, a in enumerate(exact)})  # second order
        for n in (256, 512)
    ]
    limit = peer_curves.limit_areas(two, (256, 512))
    assert limit == pytest.approx(exact, rel=1e-12)
    assert peer_curves.area_error(1.1 * exact, limit) == pytest.approx(0.1)
    cells = [exact * (1.02 + 20.0 / n) for n in (256, 512)]  # first order, to 2 % too much
    assert peer_curves.drawn_on(*cells, limit) == pytest.approx(0.02)


def test_a_run_keeps_what_is_beside_and_older_runs_have_none(tmp_path):
    path = tmp_path / "history.json"
    append_run(path, stored_run(new_run([]), curves=[CURVE], stresses=[STRESS]))
    (run,) = read_history(path)
    assert run.peer_curves == (CURVE,)
    assert run.peer_stresses == (STRESS,)
    old = path.read_text().replace('"peer_curves"', '"was_curves"')
    data = json.loads(old)
    del data["runs"][0]["was_curves"], data["runs"][0]["peer_stresses"]
    path.write_text(json.dumps(data))
    assert read_history(path)[0].peer_curves == ()


def test_rows_have_their_headers_and_the_page_shows_them():
    assert (CURVE.ratio, CURVE.area_ratio) == (20.0, 40.0)
    assert (STRESS.ratio, STRESS.kept_ratio, STRESS.mises_ratio) == pytest.approx((4.0, 4.0, 30.0))
    assert dataclasses.replace(CURVE, area_cpu=(1.0,)).area_ratio == 20.0
    nowhere = dataclasses.replace(CURVE, bem_area_cells=0, bem_area_cpu=())
    hardly = dataclasses.replace(STRESS, bem_mises_cells=0, bem_mises_cpu=(), kept_cpu=())
    for headers, rows in (
        (CURVE_HEADERS, curve_rows([CURVE, nowhere])),
        (STRESS_HEADERS, stress_rows([STRESS, hardly])),
        (MISES_HEADERS, mises_rows([STRESS, hardly])),
    ):
        assert all(len(row) == len(headers) for row in rows)
    assert "not reached" in curve_rows([nowhere])[0]
    assert "not reached" in mises_rows([hardly])[0]
    assert "nothing" in stress_rows([hardly])[0]
    body = "".join(
        section.body for section in page.sections(stored_run(new_run([]), curves=[CURVE], stresses=[STRESS]))
    )
    assert "from nothing" in body
    assert body.count("<table") == 3
    missing = "".join(section.body for section in page.sections(stored_run(new_run([]))))
    assert missing.count("Not in the stored run") == 2


def test_a_run_with_peers_has_contacts_curves_and_stresses_in_one(monkeypatch, tmp_path):
    monkeypatch.setattr("reports.benchmarks.run.compare_with_peers", lambda *given: given[4].append({"peer": "other"}))
    monkeypatch.setattr(peer_curves, "curves_beside", lambda *given: given[4].append(CURVE))
    monkeypatch.setattr(peer_stresses, "stresses_beside", lambda *given: given[4].append(STRESS))

    def refuse(*given):
        raise InputError("no such package")

    monkeypatch.setattr(peer_stresses, "environment", refuse)
    run = add_peers(new_run([]), tmp_path, HERE, [64], quick=True, repeats=1, say=said)
    assert [row["peer"] for row in run.peers] == ["other"]
    assert (run.peer_curves, run.peer_stresses) == ((CURVE,), (STRESS,))
    assert run.failures == {"slippy": "no such package"}  # an environment that cannot be made ends nothing


def test_packages_that_stand_alone_are_installed_without_what_they_ask_for(monkeypatch, tmp_path):
    commands = []

    class Done:
        returncode = 0

    monkeypatch.setattr(peers.subprocess, "run", lambda command, **more: commands.append(command) or Done())
    monkeypatch.setattr(peers.shutil, "which", lambda *given, **more: "uv")
    peers.environment(tmp_path, said, ("numpy<2",), ("slippy",))
    assert [command[-2:] for command in commands[1:]] == [
        [str(tmp_path / "bin" / "python"), "numpy<2"],
        ["--no-deps", "slippy"],
    ]


def test_all_that_is_measured_beside_peers_is_a_case():
    for axes in set(peer_stresses.AXES.values()):
        assert {f"peer-stress-{axes}", f"peer-stress-{axes}-kept", f"peer-mises-{axes}"} <= set(PEER_CASES)
        timed = PEER_CASES[f"peer-mises-{axes}"].prepare(64)
        assert timed.judge(timed.solve()).errors["mises_error"] < 0.01
