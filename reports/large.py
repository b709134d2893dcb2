"""Large contacts on the page of run times: bytes a cell, and why there is no operator in slabs; from stored results.

Knows the two experiments; nothing is measured here. Verified in tests/reports/test_large.py.
"""

from __future__ import annotations

import json
from typing import Any

from reports.builder import table, text
from reports.experiments.kept import age, found
from reports.experiments.large_contact import RESULT as CONTACTS
from reports.experiments.large_published import RESULT as PUBLISHED
from reports.experiments.slab_transforms import RESULT as SLABS
from reports.reproduced import paragraph

_NAMES = {
    "bem": "this project's passes, product included",
    "fftw": "FFTW, measured plans",
    "scipy": "scipy",
    "slabs_of": "scipy in processes with slabs",
    "dask": "Dask, blocks",
    "mpi4py_fft": "mpi4py-fft (ranks that wait work)",
}


def contacts() -> str:
    """What a large periodic contact takes."""
    rows: dict[str, dict[str, Any]] = json.loads(CONTACTS.read_text("utf-8"))
    body = text(
        "A rough surface on a flat, periodic, elastic, 7 to 8 % of the cells in contact: most memory of a fresh "
        "process, the gap counted with the contact. Gap, pressure and residual are in double throughout; the search is "
        "in single precision and costs no accuracy (`bem plan`). With a quarter of 2048 x 2048 cells in contact it is "
        "94 bytes a cell. At 59 bytes 16384 x 16384 cells take 15.8 GB, their surface 15 GB before it. On free axes "
        "transforms have four times the points: 90 bytes a cell, 15,000 cells along each side in 20 GB. "
        "`python -m reports.experiments.large_contact --size 16384` repeats it." + _of_runs(rows)
    )
    headers = (
        "cells a side",
        "surface, bytes a cell",
        "contact, bytes a cell",
        "whole run, bytes a cell (planned)",
        "surface, s",
        "contact, s",
    )
    shown = [
        (
            size,
            f"{row['surface_bytes_a_cell']:.0f}",
            f"{row['contact_bytes_a_cell']:.0f}",
            f"{row['run_bytes_a_cell']:.0f} ({row['planned_bytes_a_cell']:.0f})" if "run_bytes_a_cell" in row else "",
            f"{row['surface_processor_s']:.3g}",
            f"{row['contact_processor_s']:.3g}",
            f"{row['convolutions']:.1f}",
            f"{row['residual']:.1e}",
        )
        for size, row in rows.items()
    ]
    caption = "Seconds of processor time on two threads. Small grids have the libraries' memory in theirs."
    return body + table((*headers, "convolutions", "residual"), shown, caption=caption) + paragraph(CONTACTS.stem)


def published() -> str:
    """One contact of 8192 x 8192 cells beside the time that another code's page publishes."""
    own, other = (found(PUBLISHED.stem)[name] for name in ("bem", "published"))
    body = text(
        f"A periodic contact of {own['cells']} x {own['cells']} cells to {other['tolerance']:g} on one thread, "
        f"{100 * own['contact_fraction']:.1f} % of the cells in contact, beside what the project page of "
        f"{other['code']} says of one with 8 % in contact. Its machine (20 cores) and the band of its surface are not "
        f"ours, and it was not run here at this size. bem is timed by processor time on a machine with a load of "
        f"{own['load_average']:g}. Its residual is the largest violation over the rms height; formed anew, penetration "
        f"is {own['penetration']:.1e} and complementarity {own['complementarity']:.1e} of the rms height. "
        f"The 13 bytes a cell of {other['code'].split()[0]} are those of its operator of free surfaces. bem's periodic "
        f"operator has {own['operator_bytes_a_cell']:.1f}; all of its contact, with gap, pressure and what the search "
        f"needs, {own['bytes_a_cell']:.0f}. `python -m reports.experiments.{PUBLISHED.stem}` repeats it."
    )
    headers = ("code", "s", "iterations", "convolutions", "operator, bytes a cell", "contact, bytes a cell")
    names = ("processor_s", "iterations", "convolutions", "operator_bytes_a_cell", "bytes_a_cell")
    rows = [
        ("bem", *(own[name] for name in names)),
        (
            f"{other['code']}, as published",
            other["wall_s"],
            other["iterations"],
            "",
            other["operator_bytes_a_cell"],
            "",
        ),
    ]
    caption = "Seconds of processor time of bem, of wall time of the published solve; both on one thread."
    return body + table(headers, rows, caption=caption) + age(PUBLISHED.stem)


def _of_runs(rows: dict[str, dict[str, Any]]) -> str:
    """What a run takes beyond its contact; nothing where fewer than two sizes were measured."""
    held = [(int(size) ** 2, row["run_bytes_a_cell"]) for size, row in rows.items() if "run_bytes_a_cell" in row]
    if len(held) < 2:
        return ""
    (few, before), (many, after) = held[-2:]
    further = (many * after - few * before) / (many - few)
    return (
        " A whole `bem run` of the same contact as a scene, with error bars, results and pictures (`--run`), takes "
        f"{further:.0f} bytes for each further cell from {few**0.5:.0f} to {many**0.5:.0f} a side; libraries and "
        "stores of bounded size, half a gigabyte, come on top. From 11585 cells a side heights are on disk meanwhile."
    )


def _seconds(value: float | None) -> str:
    return "" if value is None else f"{value:.3g}"


def slabs() -> str:
    """Why there is no operator in slabs."""
    rows: dict[str, dict[str, dict[str, float]]] = json.loads(SLABS.read_text("utf-8"))
    size, largest = list(rows.items())[-1]
    spent, moved = largest["processor_s"], largest["transposed_s"]["2"]
    ratio = {name: spent["slabs_of_2"] / spent[name] for name in ("scipy_2", "bem_2")}
    body = text(
        "A contact beyond one machine would need its transforms in slabs, a process for each, with two transpositions "
        f"a pair. On {size} x {size} cells two slabs of scipy's transforms work {ratio['scipy_2']:.2f} times as long "
        f"as scipy's two threads, {100 * moved / spent['slabs_of_2']:.0f} % of it to move what threads share, and "
        f"{ratio['bem_2']:.1f} times as long as two threads of this project's passes; what messages between machines "
        "cost comes on top. As 16384 x 16384 cells fit on one, threads are kept and no operator in slabs is built. "
        "`python -m reports.experiments.slab_transforms` repeats it."
    )
    ways = list(dict.fromkeys(name.rsplit("_", 1)[0] for name in spent))
    found = [
        (
            cells,
            _NAMES[way],
            *(f"{row['processor_s'].get(f'{way}_{n}', float('nan')):.3g}".replace("nan", "") for n in (1, 2)),
        )
        for cells, row in rows.items()
        for way in ways
    ]
    headers = ("cells a side", "one pair of transforms", "one, s", "two, s")
    shown = table(headers, found, caption="Processor time of all threads or processes together.")
    return body + shown + paragraph(SLABS.stem)
