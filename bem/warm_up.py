"""Compilation of every loop before a user's first run, from a record of their signatures.

The record, `compiled_signatures.json`, is what small scenes of all kinds compile; `bem warm-up --record` renews it.

Verified in tests/packaging/test_warm_up.py.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

from bem.runs import run_scene
from bem.startup.compile_ahead import Progress, compile_loops, find_dispatchers
from bem.startup.signatures import SignatureRecord, SignatureWriter
from bem.threads import cores, get_threads, set_threads

_FEW = ("repetitions=1", "cycles.count=3", "cycles.settled=1", "depths.count=8")
_SHORT = ("life.count=64", "wear.positions=2")

_MANY = ("grid.shape=256", 'contact={mean_pressure = "40 GPa"}', "outputs={}")
"""More cells in contact than one block of the passes has; run by two threads, whose loops are others than one's."""

SCENES: tuple[tuple[str, tuple[str, ...]], ...] = (
    ("rough-contact", ("grid.shape=256",)),
    ("hertz-sphere", ()),
    ("hertz-cylinder", ()),
    ("sinusoid", ()),
    ("flash-temperature", ("grid.shape=96",)),
    ("fretting-ball", ("grid.shape=48", "push.steps=2")),
    ("rolling-creepage", ("grid.shape=24", 'over={"roll.creepage" = [0.001]}')),
    ("coated-sphere", ("grid.shape=96",)),
    ("film-barrel", ("film.cells=64",)),
    ("film-rough-ball", ("film.cells=48", "patch.shape=48", 'over={"rolling.mean_speed" = ["0.003 m/s"]}')),
    ("waviness", ("film.cells=32", "march.steps=4", "march.duration=0.1 ms")),
    ("traction-curve", ("film.points=300", 'over={"rolling.slide_roll_ratio" = [0.1]}')),
    ("hot-film", ("film.points=200", 'over={"rolling.slide_roll_ratio" = [0.1]}')),
    ("film-reciprocating", ("march.duration=5 ms", "march.steps=20")),
    ("stribeck-mineral-oil", ("repetitions=1", "speeds.count=3", "grid.shape=100", "film.points=500")),
    ("running-in-stribeck", (*_FEW, 'speeds.values=["0.01 m/s"]', "cycles.averaged=1", "grid.shape=96")),
    ("micropitting-rig", (*_SHORT, "grid.shape=[80, 12]", "fatigue.depths.count=2")),
    ("running-in-life", (*_SHORT, 'fatigue={criterion = "crossland", depths = {count = 2, spacing = "1 um"}}')),
    ("wear-soft-roughness", (*_FEW, "domain.cells=120", "domain.half_widths=2.4")),
    ("fretting-wear", ("cycles.count=3", "cycles.settled=1", "domain.cells=[60, 2]")),
    ("wear-steel-brass", (*_FEW, "domain.cells=160")),
    # what a voxel bears is used up at once, so that damage moves with what leaves
    ("wear-criteria", (*_FEW, "domain.cells=96", "variants[4].criterion.passes=100000")),
    ("tribofilm-afm-tip", ('rubbing.loads=["600 nN"]', "grid.shape=48")),
    ("tribofilm-macro", ('rubbing.temperatures=["80 degC"]', "grid.shape=256", "grid.lengths=200 um")),
    ("uniform-asperities", ('array.spacings=["20 um"]', 'array.interferences=["50 nm"]', "array.cell=1 um")),
    ("flow-factors", ("grid.shape=64", "flow.ratios=[1.0]")),
    ("particles-afm-map", ("synthetic.shape=[256, 256]",)),
    ("rough-contact", _MANY),
)
"""Built-in scenes of every kind and what makes them small. The first is the main job."""


RECORD = Path(__file__).resolve().parent / "compiled_signatures.json"
"""Signatures of all loops; see `bem.startup.signatures`."""


def warm_up(progress: Progress, *, main: bool = False, workers: int | None = None) -> list[str]:
    """Compile the recorded loops on all cores; return the loops that could not be compiled, with the reason.

    Parameters
    ----------
    progress : called with the number of loops that are compiled and the number of all.
    main : only what the main job, a rough contact, needs.
    workers : number of processes; None takes one per core.
    """
    record = SignatureRecord(RECORD.read_text(encoding="utf-8"))
    return compile_loops(record, cores() if workers is None else workers, progress, main=main)


def record_signatures() -> str:
    """Run all scenes in this process and return the record of the loops that they compiled.

    numba's cache must be empty at the start: what is read from there does not show the loops that it calls.
    """
    writer, threads = SignatureWriter(), get_threads()
    with tempfile.TemporaryDirectory() as folder:
        for number, (name, settings) in enumerate(SCENES):
            set_threads(2 if settings is _MANY else threads)
            try:
                run_scene(name, Path(folder) / str(number), settings=settings, figures=False)
            finally:
                set_threads(threads)
            for (module, loop), dispatcher in find_dispatchers():
                for signature in dispatcher.overloads:
                    writer.add(module, loop, signature)
            if number == 0:
                writer.end_main_job()
    return writer.text()
