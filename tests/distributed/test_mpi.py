"""Ranks of MPI as processes: the same bits as in one process, the command line, and what ends them."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from test_slab_solver import FREE, STEEL, rough_gap

from bem import Grid, run_scene
from bem.distributed.ranks import OneRank
from bem.distributed.solve import solve_slabs

MPIEXEC = shutil.which("mpiexec", path=Path(sys.executable).parent) or shutil.which("mpiexec")
SETTINGS = ["grid.shape=64", "grid.lengths=25 um", "contact.friction=0", "outputs.errors=false"]
"""Of the built-in scene `rough-contact`."""
BLOCKED = "import sys; sys.modules['mpi4py'] = None; sys.argv = ['bem', 'run', 'sinusoid', '--ranks']\n"

ROWS = """
import sys
import numpy as np
from test_slab_solver import FREE, STEEL, rough_gap
from bem import Grid
from bem.distributed.mpi import world
from bem.distributed.ranks import own_slice
from bem.distributed.solve import solve_slabs

ranks = world()
grid, gap = Grid((17, 12), (1e-6, 2e-6), periodic=FREE), rough_gap((17, 12))
rows = np.ascontiguousarray(gap[own_slice(17, ranks)])
solution = solve_slabs(rows, grid, STEEL, ranks, load=0.1, hardness=2e9)
np.save(f"{sys.argv[1]}/{ranks.rank}.npy", solution.pressure)
assert ranks.count.transposes == 2 * solution.convolutions + 1
"""

DIES = """
import os
from bem.distributed import session, solve
from bem.distributed.mpi import world

if world().rank == 1:
    solve._moments = lambda *arguments: os._exit(9)
import sys
sys.argv = ["bem", "run", "sinusoid", "--set", "grid.shape=[16, 16]", "--ranks", "--no-figures", "--out", sys.argv[1]]
from bem.cli import main
main()
"""


def run(command, **variables):
    """Run a command beside the tests' helpers; return code, output and errors."""
    paths = os.pathsep.join([str(Path(__file__).parent), *filter(None, sys.path)])
    own = {"PYTHONPATH": paths, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    own["PRTE_MCA_rmaps_default_mapping_policy"] = own["OMPI_MCA_rmaps_base_oversubscribe"] = "1"
    done = subprocess.run(
        command, capture_output=True, text=True, timeout=120, check=False, env={**os.environ, **own, **variables}
    )
    return done.returncode, done.stdout, done.stderr


@pytest.fixture
def mpiexec():
    """Start of a command on a number of ranks; the test is skipped where mpi4py or mpiexec is missing."""
    pytest.importorskip("mpi4py")
    if MPIEXEC is None:
        pytest.skip("no mpiexec")
    return lambda number: [MPIEXEC, "-n", str(number), sys.executable]


@pytest.mark.slow
@pytest.mark.drawn(2)
@pytest.mark.parametrize("number", [1, 2, 3, 4])
def test_processes_give_the_bits_of_one(mpiexec, tmp_path, number):
    """Pressures of a free contact with a hardness, by slabs of 17 rows."""
    grid, gap = Grid((17, 12), (1e-6, 2e-6), periodic=FREE), rough_gap((17, 12))
    expected = solve_slabs(gap, grid, STEEL, OneRank(), load=0.1, hardness=2e9).pressure
    code, _, errors = run([*mpiexec(number), "-c", ROWS, str(tmp_path)])
    assert code == 0, errors
    assert np.array_equal(np.concatenate([np.load(tmp_path / f"{rank}.npy") for rank in range(number)]), expected)
    assert (expected == 2e9).any()


@pytest.mark.slow
def test_command_line_on_three_ranks(mpiexec, tmp_path):
    """One report from rank 0, and the figures of one process."""
    asked = ["rough-contact", "--no-figures", "--ranks", "--out", str(tmp_path / "shared")]
    for setting in SETTINGS:
        asked += ["--set", setting]
    code, output, errors = run([*mpiexec(3), "-m", "bem", "run", *asked])
    assert code == 0, errors
    assert output.count("converged") == 1
    shared = json.loads((tmp_path / "shared" / "summary.json").read_text())
    serial = run_scene("rough-contact", tmp_path / "serial", settings=SETTINGS, figures=False).summary
    for name in ("contact_area_fraction", "approach_m", "mean_gap_m"):
        assert shared[name] == pytest.approx(serial[name], rel=1e-6, abs=0), name


@pytest.mark.slow
def test_a_mistake_is_one_line_of_one_rank(mpiexec):
    """Exit code 2, as without ranks."""
    code, _, errors = run([*mpiexec(2), "-m", "bem", "run", "flow-factors", "--ranks"])
    lines = [line for line in errors.splitlines() if line.startswith("bem:")]
    assert lines == ['bem: --ranks: scenes of kind "flow-factors" run in one process; allowed: kind = "contact"']
    assert code == 2


@pytest.mark.slow
def test_a_dead_process_ends_the_others(mpiexec, tmp_path):
    """Rank 1 dies within a contact; mpiexec ends rank 0, which leaves no finished run."""
    code, _, _ = run([*mpiexec(2), "-c", DIES, str(tmp_path / "run")])
    assert code != 0
    assert not (tmp_path / "run" / "summary.json").exists()


@pytest.mark.slow
def test_a_process_alone_is_told_how_to_start(mpiexec):
    """Also what another MPI's mpiexec starts is alone: as many processes as asked for, each with rank 0."""
    code, _, errors = run([sys.executable, "-m", "bem", "run", "sinusoid", "--ranks"])
    assert code == 2
    assert errors.startswith("bem: --ranks: this process is alone; allowed: mpiexec -n 4 bem run SCENE --ranks")


@pytest.mark.parametrize(("rank", "lines"), [("0", 1), ("1", 0)])
def test_a_missing_mpi4py_is_told_by_one_process(rank, lines):
    """The first by the variable of the starter."""
    code, _, errors = run([sys.executable, "-c", BLOCKED + "from bem.cli import main\nmain()"], PMI_RANK=rank)
    assert code == 2
    assert len(errors.splitlines()) == lines
    assert lines == 0 or "pip install 'bem-tribology[mpi]'" in errors
