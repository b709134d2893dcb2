"""Command line: ``python -m fem_reference CASE [options]``, ``--list``, ``all``."""

from __future__ import annotations

import argparse
import inspect
import logging
import os
import random
import sys
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from subprocess import run
from typing import Any

from fem_reference import provenance, results
from fem_reference.problem import Parameter, Problem, all_problems, module_of, stored_cases

STORED = Path(__file__).resolve().parents[1] / "bem" / "verification" / "fem_results"


def _add_options(parser: argparse.ArgumentParser, parameters: tuple[Parameter, ...]) -> None:
    for parameter in parameters:
        kind = parameter.kind or (str if parameter.default is None else type(parameter.default))
        option = "--" + parameter.name.replace("_", "-")
        text = f"{parameter.help} (default {parameter.default})"
        options: dict[str, Any] = {"dest": parameter.name, "type": kind, "default": argparse.SUPPRESS, "help": text}
        if parameter.count is not None:
            options["nargs"] = "+" if parameter.count < 0 else parameter.count
        if parameter.choices is not None:
            options["choices"] = parameter.choices
        parser.add_argument(option, **options)


def _list() -> None:
    for problem in all_problems().values():
        print(f"{problem.name}: {problem.sentence}")
        for parameter in problem.parameters:
            print(f"    --{parameter.name.replace('_', '-'):12s} {parameter.help} (default {parameter.default})")
        print(f"    stored: {', '.join(problem.stored) or 'none'}\n")


def _table(result: results.Result) -> str:
    """One line per curve: largest value, largest bar over it, order."""
    lines = [f"{result.case}: {result.sentence}  [{result.time_s:.1f} s, {result.mesh['levels'][-1]['dofs']} dofs]"]
    for curve in result.quantities:
        size = max((abs(v) for v in curve.values), default=0.0)
        bar = max(curve.error_bar, default=0.0)
        relative = f"{bar / size:.1e}" if size else "-"
        order = "-" if curve.order is None else f"{curve.order:.1f}"
        lines.append(f"  {curve.name:24s} {curve.along:42s} max {size:10.4g}  bar/max {relative:>8s}  order {order}")
    for name, check in result.checks.items():
        lines.append(f"  {name}: {check['value']:.9g}, expected {check['expected']:.9g}")
    return "\n".join(lines)


def _changed(folder: Path, cases: Iterable[str]) -> list[str]:
    """Cases that are not stored, or whose sources or parameters are not those of the stored result."""
    known = stored_cases()
    found = []
    for case in cases:
        problem, parameters = known[case]
        path = folder / f"{case}.json"
        digest = provenance.inputs_digest(module_of(problem), parameters)
        if not path.is_file() or results.read(path).inputs != digest:
            found.append(case)
    return found


def _all(chosen: argparse.Namespace) -> int:
    """Solve the stored set again, each case in its own process.

    With `check` compare to what is stored and write nothing; with `changed` solve only the cases whose sources or
    parameters changed, and `sample` of the others, drawn by `seed`.
    """
    folder, check, only = chosen.out, chosen.check, set(chosen.only)
    cases = [case for case, (problem, _) in stored_cases().items() if not only or {case, problem.name} & only]
    if chosen.changed:
        changed = _changed(folder, cases)
        others = [case for case in cases if case not in changed]
        drawn = random.Random(chosen.seed).sample(others, min(chosen.sample, len(others)))
        print(f"{len(changed)} of {len(cases)} cases have changed inputs; {len(drawn)} of the others are drawn")
        cases = sorted({*changed, *drawn})
    folder.mkdir(parents=True, exist_ok=True)

    def one(case: str) -> tuple[str, int, str]:
        command = [sys.executable, "-m", "fem_reference", case]
        command += ["--check", str(folder / f"{case}.json")] if check else ["--out", str(folder / f"{case}.json")]
        one_thread = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
        done = run(command, capture_output=True, text=True, check=False, env={**os.environ, **one_thread})
        return case, done.returncode, (done.stdout + done.stderr).strip()

    failed = 0
    with ThreadPoolExecutor(chosen.jobs) as pool:
        for case, code, text in pool.map(one, cases):
            failed += code != 0
            print(f"{'ok    ' if code == 0 else 'FAILED'} {case}", flush=True)
            if code:
                print(text, flush=True)
    print(f"{len(cases) - failed} of {len(cases)} cases {'reproduced' if check else 'written'}")
    return 1 if failed else 0


def main(arguments: list[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    logging.disable(logging.WARNING)  # dolfinx' compiler calls, and its advice on quadrature
    parser = argparse.ArgumentParser(prog="python -m fem_reference", add_help=False)
    parser.add_argument("case", nargs="?")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("-h", "--help", action="store_true")
    known, rest = parser.parse_known_args(arguments)
    if known.list:
        _list()
        return 0
    if known.case is None:
        print(__doc__)
        print("CASE is a problem, a stored case (see --list) or all; CASE --help shows its options.")
        return 0 if known.help else 2

    if known.case == "all":
        options = argparse.ArgumentParser(prog="python -m fem_reference all")
        options.add_argument("--out", type=Path, default=STORED, help="folder of the stored set")
        options.add_argument("--check", action="store_true", help="compare to the stored set; write nothing")
        options.add_argument("--jobs", type=int, default=1, help="processes at a time")
        options.add_argument("--only", nargs="*", default=[], help="these cases or problems only")
        options.add_argument("--changed", action="store_true", help="only cases whose sources or parameters changed")
        options.add_argument("--sample", type=int, default=0, help="with --changed: as many of the others, drawn")
        options.add_argument("--seed", type=int, default=0, help="of the drawn cases")
        return _all(options.parse_args(rest + (["--help"] if known.help else [])))

    problems, stored = all_problems(), stored_cases()
    if known.case in stored:
        problem, parameters = stored[known.case]
    elif known.case in problems:
        problem = problems[known.case]
        parameters = problem.defaults()
    else:
        import difflib

        near = difflib.get_close_matches(known.case, [*problems, *stored], n=3)
        hint = f"; did you mean {' or '.join(near)}?" if near else ""
        print(f"there is no case {known.case!r}{hint} (--list shows all)", file=sys.stderr)
        return 2
    return _one(known.case, problem, parameters, rest + (["--help"] if known.help else []))


def _one(case: str, problem: Problem, parameters: dict, rest: list[str]) -> int:
    """Solve one case with options; print its table, write or check a file."""
    options = argparse.ArgumentParser(prog=f"python -m fem_reference {case}", description=problem.sentence)
    _add_options(options, problem.parameters)
    options.add_argument("--out", type=Path, help="write the result to this file")
    options.add_argument("--finer", type=int, default=0, help="refine all meshes by so many levels (default 0)")
    options.add_argument("--check", type=Path, help="compare to this stored result; exit 1 if it does not reproduce")
    chosen = vars(options.parse_args(rest))
    out, check, finer = chosen.pop("out"), chosen.pop("check"), chosen.pop("finer")
    if finer < 0:
        print(f"--finer {finer}: allowed are whole numbers from 0", file=sys.stderr)
        return 2
    if finer and "finer" not in inspect.signature(problem.solve).parameters:
        print(f"--finer: the meshes of {problem.name} are fixed", file=sys.stderr)
        return 2
    refined = {"finer": finer} if finer else {}
    if check is not None and not check.is_file():
        print(f"there is no stored result {check}", file=sys.stderr)
        return 1
    try:
        result = problem.solve(**{**parameters, **chosen, **refined})
    except ValueError as error:
        print(f"{case}: {error}", file=sys.stderr)
        return 2
    digest = provenance.inputs_digest(module_of(problem), {**parameters, **chosen, **refined})
    result = replace(result, case=out.stem if out is not None else case, inputs=digest)
    print(_table(result))
    if out is not None:
        results.write(result, out)
    if check is not None:
        complaints = results.reproduces(results.read(check), result)
        print("\n".join(complaints) or f"{check.name} reproduces")
        return 1 if complaints else 0
    return 0


if __name__ == "__main__":
    sys.exit(main())
