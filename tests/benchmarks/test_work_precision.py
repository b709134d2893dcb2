"""Errors of physical figures over grids and the time they take: kinds at their smallest, arithmetic on made-up runs."""

import dataclasses

import numpy as np
import pytest

from bem import InputError
from bem.benchmarks.measure import Point
from bem.benchmarks.physical_cases import PHYSICAL, RAW, rough_surface, size_and_digits
from bem.benchmarks.record import new_run
from bem.benchmarks.show import draw_reach
from bem.benchmarks.work_precision import (
    CELLS_ALONE,
    OURS,
    TARGETS,
    Curve,
    Reach,
    best,
    check_kinds,
    reach_rows,
    reference,
    time_to_reach,
)
from reports.benchmarks.history import stored_run
from reports.benchmarks.peer_figures import curves_with_peers
from reports.benchmarks.tables import draw_errors

pytestmark = pytest.mark.internal


@pytest.mark.parametrize("kind", PHYSICAL)
def test_a_kind_at_its_smallest_gives_figures(kind):
    case = PHYSICAL[kind]
    timed = case.prepare(case.points(quick=True)[0])
    figures = timed.judge(timed.solve()).values
    assert np.isfinite(list(figures.values())).all()
    assert {name.removeprefix(RAW) for name in figures} == {name for name in figures if not name.startswith(RAW)}
    assert all(value > 0 for value in figures.values())


def test_sizes_carry_digits_and_the_finest_grid_only_the_reference():
    case = PHYSICAL["contact"]
    pairs = [size_and_digits(code) for code in case.points(quick=False)]
    assert [d for n, d in pairs if n == case.sizes[-1]] == [case.digits[-1]]
    assert {n for n, _ in pairs} == set(case.sizes)
    assert set(pairs) >= {size_and_digits(code) for code in case.points(quick=True)[:-1]}


def test_all_grids_see_the_same_surface():
    fine, coarse = rough_surface(512), rough_surface(128)
    assert np.array_equal(fine[::4, ::4], coarse)
    spectrum = np.abs(np.fft.rfft2(coarse))
    assert spectrum[:, 49:].max() < 1e-9 * spectrum.max()


def made_up(kind="contact", limit=2.0, constant=40.0):
    """A run whose figure has an error of constant / n^2, of cells alone 8 / n, and takes n^2 / 1e5 seconds."""
    case = PHYSICAL[kind]
    points = []
    for code in case.points(quick=False):
        n, digits = size_and_digits(code)
        values = {"contact_area": limit * (1 + constant / n**2), RAW + "contact_area": limit * (1 + 8 / n)}
        cpu = (n**2 * digits / 8e5,)
        points.append(Point(case.name, code, 1, 0.0, cpu, cpu, 1e6, {}, {}, values, {}))
    sizes = (128, 256)
    peers = [
        {
            "peer": "other",
            "cells": n,
            "cpu": [n**2 / 1e4],
            "memory": 1e6,
            "figures": {"contact_area": limit * (1 + 8 / n)},
        }
        for n in sizes
    ]
    return stored_run(new_run(points), peers)


def test_references_and_errors_are_those_of_the_order():
    run = made_up()
    assert reference(PHYSICAL["contact"], run.points)["contact_area"] == pytest.approx(2.0, rel=1e-12)
    found = curves_with_peers(run)
    ours = [c for c in found if c.solver == OURS]
    assert {c.digits for c in ours} == set(PHYSICAL["contact"].digits)
    assert all(c.sizes == (128, 256, 512, 1024) for c in ours)  # the finest is the reference's
    assert ours[0].errors == pytest.approx([40 / n**2 for n in ours[0].sizes])
    (peer,) = [c for c in found if c.solver == "other"]
    assert peer.errors == pytest.approx([8 / 128, 8 / 256])


def test_time_to_an_error_is_measured_or_drawn_on():
    found = curves_with_peers(made_up())
    ours = best(found, "contact", "contact_area", OURS)
    # the coarsest grid and loosest tolerance have 0.24 %: enough for all
    assert ours == [Reach(128**2 * 3 / 8e5, True)] * len(TARGETS)
    cells = best(found, "contact", "contact_area", CELLS_ALONE)
    assert [reach.measured for reach in cells] == [True, True, True, False]
    # 0.3 % of 8 / n needs n = 2667; the last two grids say so
    assert cells[3].time == pytest.approx((8 / 0.003) ** 2 * 3 / 8e5)
    rows = reach_rows(found)
    assert {row[2] for row in rows} == {OURS, CELLS_ALONE, "other"}
    assert rows[1][-1].startswith("(")


def test_an_error_that_comes_back_on_a_finer_grid_was_not_reached():
    curve = Curve("contact", "x", OURS, 8, (1, 2, 4), (1.0, 2.0, 4.0), (0.0,) * 3, (0.001, 0.05, 0.02))
    assert time_to_reach(curve, 0.03) == Reach(4.0, True)
    assert time_to_reach(curve, 0.1) == Reach(1.0, True)
    assert not time_to_reach(curve, 0.003).measured
    flat = dataclasses.replace(curve, errors=(0.02, 0.02, 0.02))
    assert time_to_reach(flat, 0.003) is None


def test_unknown_kinds_are_named():
    with pytest.raises(InputError, match="nearest: wear"):
        check_kinds(["waer"])
    assert check_kinds(["all"]) == list(PHYSICAL)
    assert check_kinds(["film", "film"]) == ["film"]


def test_pictures_of_a_run():
    found = curves_with_peers(made_up())
    assert draw_reach(found).axes[0].get_xscale() == "log"
    assert len(draw_errors(found, "contact").axes) == 1  # all grids took as much memory: it says nothing


def test_memory_is_drawn_where_the_grid_tells_it():
    """Less than a mebibyte fitted into what the process held from before: that is not what a solve needs."""
    run = made_up()
    told = {128: 0.0, 256: 8e6, 512: 3e7, 1024: 1.2e8, 2048: 5e8}
    points = [dataclasses.replace(p, memory=told[size_and_digits(p.size)[0]]) for p in run.points]
    time, memory = draw_errors(curves_with_peers(dataclasses.replace(run, points=tuple(points))), "contact").axes
    assert len(memory.lines) == len(time.lines) - 1  # the peer's did not rise
    assert all(np.isnan(line.get_xdata()[0]) and line.get_xdata()[-1] > 100 for line in memory.lines)
