"""Compiled loops have the bits of their own text, whoever calls them first.

A loop that does not say what it allows of its arithmetic, and what a division by zero gives, is compiled with what the
first caller in the process says, and kept on disk like that: pressures differed in the last digits by the order of the
contacts before them.
"""

import ast
from pathlib import Path

import numpy as np
import pytest

import bem
from bem import compiled

PACKAGE = Path(bem.__file__).parent
DECORATORS = {"compiled", "contracted", "reordered", "inlined"}
TREES = {
    path.relative_to(PACKAGE).as_posix(): ast.parse(path.read_text(encoding="utf-8"))
    for path in sorted(PACKAGE.rglob("*.py"))
}


def is_loop(function):
    return any(ast.unparse(name) in DECORATORS for name in function.decorator_list)


def functions():
    for path, tree in TREES.items():
        for node in ast.walk(tree):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                yield path, node


def test_loops_are_compiled_by_the_decorators_alone():
    assert sum(is_loop(function) for _, function in functions()) > 250
    elsewhere = [
        path
        for path, tree in TREES.items()
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute | ast.Name | ast.alias)
        and ast.unparse(node).split(".")[-1] in ("njit", "jit", "vectorize", "guvectorize", "cfunc")
    ]
    assert set(elsewhere) == {"compiled.py"}


@pytest.mark.parametrize(
    ("decorator", "allowed"),
    [
        ("compiled", False),
        ("contracted", {"contract"}),
        ("reordered", {"contract", "reassoc", "nsz", "arcp"}),
        ("inlined", False),
    ],
)
def test_a_decorator_says_all_that_a_caller_would_hand_on(decorator, allowed, tmp_path, monkeypatch):
    monkeypatch.setattr("numba.config.CACHE_DIR", str(tmp_path))
    loop = getattr(compiled, decorator)(_ratio)
    options = loop.targetoptions
    assert options["fastmath"] == allowed
    assert (options["error_model"], options["nogil"]) == ("numpy", True)
    assert loop(1.0, 0.0) == np.inf
    assert list(tmp_path.rglob("*.nbi"))


def _ratio(a, b):
    return a / b


def _is_typed(function):
    given = function.args
    each = [*given.posonlyargs, *given.args, *given.kwonlyargs, given.vararg, given.kwarg]
    return function.returns is not None or any(one is not None and one.annotation for one in each)


def test_only_loops_go_without_types():
    """What they take is found when they are compiled; functions that are typed in part are refused by mypy."""
    assert [f"{path}:{f.lineno} {f.name}" for path, f in functions() if not (_is_typed(f) or is_loop(f))] == []
