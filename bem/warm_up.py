"""Compilation of every loop before a user's first run, from a record of their signatures.

The record, `compiled_signatures.json`, is what small scenes of all kinds compile; `bem warm-up --record` renews it.

Verified in tests/packaging/test_warm_up.py.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

from bem.runs import run_scene
from bem.scenes import get_kind, kind_names
from bem.startup.compile_ahead import Progress, compile_loops, find_dispatchers
from bem.startup.signatures import SignatureRecord, SignatureWriter
from bem.threads import cores, get_threads, set_threads

_MAIN = "contact"
_MANY = ("grid.shape=256", 'contact={mean_pressure = "40 GPa"}', "outputs={}")
"""More cells in contact than one block of the passes has; run by two threads, whose loops are others than one's."""


def scenes() -> list[tuple[str, tuple[str, ...]]]:
    """Return built-in scenes of every kind and what makes them small. The first is the main job."""
    names = [_MAIN, *(name for name in kind_names() if name != _MAIN)]
    small = [scene for name in names for scene in get_kind(name).warm_up]
    return [*small, (small[0][0], _MANY)]


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
        for number, (name, settings) in enumerate(scenes()):
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
