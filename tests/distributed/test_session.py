"""Runs that one process leads and others help: solutions, refusals, and failures, with threads as ranks."""

import dataclasses

import numpy as np
import pytest
from test_slab_solver import PERIODIC, STEEL, rough_gap
from thread_ranks import on_ranks

import bem.runs.scene
from bem import Grid, displacement_operator, run_scene, solve_contact
from bem.distributed.session import current_session, follow, leading
from bem.errors import InfeasibleError, InputError
from bem.runs.scene import plan_on_ranks, plan_scene

SMALL = ["grid.shape=64", "grid.lengths=25 um", "contact.friction=0", "outputs.errors=false"]
"""Settings of the built-in scene `rough-contact`."""


def led(size, function):
    """What rank 0 gets from a function, while the other ranks follow."""

    def work(ranks):
        if ranks.rank > 0:
            return follow(ranks)
        with leading(ranks) as session:
            return function(session)

    return on_ranks(size, work)[0]


def test_solution_is_certified_like_that_of_one_process():
    """All attributes of the serial solution but the counts, to the tolerance."""
    grid, gap = Grid((18, 20), (1e-6, 1e-6), periodic=PERIODIC), rough_gap((18, 20))
    operator = displacement_operator(grid, STEEL)
    settings = {"load": 5e8 * grid.area, "hardness": 5e9, "tolerance": 1e-12}
    serial = solve_contact(gap, operator, **settings)
    found = led(3, lambda session: session.solve_contact(gap, operator, **settings))
    for field in dataclasses.fields(serial):
        if field.name in ("iterations", "convolutions", "residual"):
            continue
        expected, value = getattr(serial, field.name), getattr(found, field.name)
        if isinstance(expected, np.ndarray):
            assert np.abs(value - expected).max() <= 1e-9 * np.abs(expected).max(), field.name
        elif isinstance(expected, float):
            assert value == pytest.approx(expected, rel=1e-9, abs=0), field.name
        else:
            assert value == expected, field.name
    assert 0 < found.residual <= 1e-12
    assert found.convolutions > found.iterations > 0


def test_a_refused_contact_leaves_the_ranks_ready_for_the_next():
    """A load that cannot be carried is raised on rank 0; the same ranks then solve another contact."""
    grid, gap = Grid((8, 6), (1e-6, 1e-6)), rough_gap((8, 6))
    operator = displacement_operator(grid, STEEL)

    def both(session):
        with pytest.raises(InfeasibleError, match="hardness x area"):
            session.solve_contact(gap, operator, load=1.0, hardness=1e9)
        with pytest.raises(InputError, match="no mean gap"):
            session.solve_contact(gap, operator, mean_gap=1e-8)
        return session.solve_contact(gap, operator, load=1e-3)

    assert led(2, both).load == pytest.approx(1e-3, rel=1e-8, abs=0)
    with pytest.raises(InfeasibleError):  # that ends the run, without ending the processes of the others
        led(2, lambda session: session.solve_contact(gap, operator, load=1.0, hardness=1e9))


def test_a_failed_rank_ends_all(monkeypatch, capsys):
    """The others would wait for it for ever."""
    grid, gap = Grid((8, 6), (1e-6, 1e-6)), rough_gap((8, 6))
    operator = displacement_operator(grid, STEEL)
    from bem.distributed import solve

    moments = solve._moments

    def fail(gap, grid, ranks):
        if ranks.rank == 1:
            raise MemoryError
        return moments(gap, grid, ranks)

    monkeypatch.setattr(solve, "_moments", fail)
    with pytest.raises(SystemExit, match="1"):
        led(2, lambda session: session.solve_contact(gap, operator, load=1e-3))
    assert "rank 1 of 2 failed, all processes end: out of memory" in capsys.readouterr().err


def test_scene_on_two_ranks(tmp_path):
    """Figures and fields of the same scene in one process, within the tolerance; nothing is shared afterwards."""
    serial = run_scene("rough-contact", tmp_path / "serial", settings=SMALL, figures=False)
    shared = led(2, lambda session: run_scene("rough-contact", tmp_path / "shared", settings=SMALL, figures=False))
    assert current_session() is None
    for name in ("contact_area_fraction", "mean_gap_m", "approach_m", "max_von_mises_Pa"):
        assert shared.summary[name] == pytest.approx(serial.summary[name], rel=1e-6, abs=0), name
    assert shared.summary["status"] == "converged"
    assert shared.summary["iterations"] != serial.summary["iterations"]


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        (
            ["contact.mean_pressure=", 'contact.mean_gap="5 nm"'],
            "contact.mean_gap: in one process only; allowed:",
        ),
        (['contact.adhesion={work="50 mJ/m^2", range="2 nm"}'], "contact.adhesion: in one"),
        (["contact.friction=0.1"], "contact.friction that changes the gap"),
    ],
)
def test_refused_scenes_name_what_holds(tmp_path, changes, words):
    """Before anything is computed or written."""

    def run(session):
        with pytest.raises(InputError, match=words):
            run_scene("rough-contact", tmp_path / "run", settings=SMALL + changes, figures=False)

    led(2, run)
    assert not (tmp_path / "run").exists()


def test_the_plan_on_ranks_is_that_of_one_process(tmp_path, monkeypatch):
    """Memory of 2048 x 2048 cells as measured: 260 MB (periodic) and 370 MB (free) of each of two processes. A run on
    ranks was refused for the memory that one process alone would need."""
    for periodic, measured in (("true", 260e6), ("false", 370e6)):
        large = [f"grid.periodic={periodic}", "grid.shape=2048", "outputs.von_mises=false"]
        resolved, alone = plan_scene("rough-contact", SMALL + large)
        shared = plan_on_ranks(resolved, alone, 2)
        serial, contact = (next(step for step in one.steps if step.name == "contact") for one in (alone, shared))
        assert contact.memory == pytest.approx(measured, rel=0.1)
        assert contact.transforms == pytest.approx(6.5 * serial.transforms)
        assert plan_on_ranks(resolved, alone, 8).helper_memory < alone.memory
    with pytest.raises(InputError, match='allowed: kind = "contact"'):
        plan_on_ranks(*plan_scene("flow-factors"), 2)
    checked = []
    monkeypatch.setattr(bem.runs.scene, "check_memory", checked.append)
    led(2, lambda session: run_scene("rough-contact", tmp_path / "run", settings=SMALL, figures=False))
    assert "shared by 2 processes" in next(step.why for step in checked[0].steps if step.name == "contact")


def test_other_kinds_laws_and_workers_are_refused(tmp_path):
    """One contact is shared; cases of a scene run one by one."""

    def run(session):
        with pytest.raises(InputError, match='allowed: kind = "contact"'):
            run_scene("flow-factors", tmp_path / "run", figures=False)
        with pytest.raises(InputError, match=r"shape\.conforming.*: in one process only"):
            run_scene("wheel-flange-root", tmp_path / "run", figures=False)
        with pytest.raises(InputError, match="--ranks alone"):
            run_scene("rough-contact", tmp_path / "run", figures=False, workers=2)

    led(2, run)
