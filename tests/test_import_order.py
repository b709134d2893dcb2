"""Imports in `bem` run one way, and nothing in it sees the oracle."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1] / "bem"

ORDER = [
    {"errors", "startup"},
    {"representation", "compiled"},
    {"extensions", "arguments", "memory", "plausibility"},
    {"grid", "materials", "threads", "laws"},
    {"numerics", "kernels", "reference_solutions"},
    {"transforms"},
    {"convolution"},
    {"stress", "heat"},
    {"contact"},
    {"tangential"},
    {"surfaces", "lubrication", "flow"},
    {"particles"},
    {"friction"},
    {"wear"},
    {"tribofilm"},
    {"accuracy"},
    {"life"},
    {"scenes"},
    {"results"},
    {"campaigns"},
    {"plots"},
    {"runs"},
    {"warm_up"},
    {"verification", "benchmarks"},
    {"elements"},
    {"app"},
    {"cli"},
]
RANK = {room: level for level, rooms in enumerate(ORDER) for room in rooms}


def imports(path):
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import; write the whole name"
            if node.module == "bem":
                yield from (f"bem.{alias.name}" for alias in node.names)
            else:
                yield node.module


FILES = [p for p in sorted(ROOT.rglob("*.py")) if p.parent != ROOT or p.name not in ("__init__.py", "__main__.py")]


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(ROOT)))
def test_imports_run_one_way(path):
    room = path.relative_to(ROOT).parts[0].removesuffix(".py")
    assert room in RANK, f"new room {room!r}: give it a place in ORDER"
    for name in imports(path):
        top, _, rest = name.partition(".")
        assert top not in ("fem_reference", "reports", "tests", "meshes"), f"{path} imports {name}"
        if top == "bem" and rest:
            other = rest.split(".")[0]
            if other in RANK and other != room:
                assert RANK[other] < RANK[room], f"{room} may not import {other}"
