"""Compiled loops have the bits of their own text, whoever calls them first.

A loop that does not say what it allows of its arithmetic, and what a division by zero gives, is compiled with what the
first caller in the process says, and kept on disk like that: pressures differed in the last digits by the order of the
contacts before them.
"""

import ast
import copy
import functools
from pathlib import Path

import numpy as np
import pytest

import bem
from bem import compiled
from bem.contact import pcg

PACKAGE = Path(bem.__file__).parent
DECORATORS = {"compiled", "inlined"}


@functools.cache
def trees():
    """Syntax trees of the package's modules by path."""
    return {
        path.relative_to(PACKAGE).as_posix(): ast.parse(path.read_text(encoding="utf-8"))
        for path in sorted(PACKAGE.rglob("*.py"))
    }


def is_loop(function):
    return any(ast.unparse(name) in DECORATORS for name in function.decorator_list)


def functions():
    for path, tree in trees().items():
        for node in ast.walk(tree):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                yield path, node


@pytest.mark.internal
@pytest.mark.parametrize("decorator", sorted(DECORATORS))
def test_a_decorator_says_all_that_a_caller_would_hand_on(decorator, tmp_path, monkeypatch):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    loop = getattr(compiled, decorator)(_ratio)
    options = loop.targetoptions
    assert options["fastmath"] is False
    assert (options["error_model"], options["nogil"]) == ("numpy", True)
    assert loop(1.0, 0.0) == np.inf
    assert list(tmp_path.rglob("*.nbi"))


FIELDS = np.random.default_rng(5).standard_normal((7, 997))
LOOPS = {
    pcg.subtract_mean: (FIELDS[0], FIELDS[1], 3.0, FIELDS[2]),
    pcg.constrain: (FIELDS[0], FIELDS[1], 0.3, FIELDS[2], FIELDS[3]),
    pcg.new_direction: (FIELDS[0], FIELDS[1], 0.3, FIELDS[2]),
    pcg.advance: (*FIELDS[:5], 0.1, 0.3, 2.0),
    pcg.sum_of_squares: (FIELDS[0],),
}


@pytest.mark.internal
@pytest.mark.parametrize("loop", LOOPS, ids=lambda loop: loop.__name__)
def test_arithmetic_is_that_of_the_text(loop):
    """Bit for bit what the interpreter makes of it: no sum in another order, no product rounded with the sum it goes
    into. Only so is a loop the same compiled with those that it calls and compiled from what is kept of them."""
    said = []
    for function in (loop, loop.py_func):
        arguments = copy.deepcopy(LOOPS[loop])
        result = function(*arguments)
        outcome = np.zeros(0) if result is None else np.ravel(result)
        said.append(np.hstack([outcome, *(np.ravel(given) for given in arguments)]).tobytes())
    assert said[0] == said[1]


def _ratio(a, b):
    return a / b


def _is_typed(function):
    given = function.args
    each = [*given.posonlyargs, *given.args, *given.kwonlyargs, given.vararg, given.kwarg]
    return function.returns is not None or any(one is not None and one.annotation for one in each)


def test_only_loops_go_without_types():
    """What they take is found when they are compiled; functions that are typed in part are refused by mypy."""
    assert [f"{path}:{f.lineno} {f.name}" for path, f in functions() if not (_is_typed(f) or is_loop(f))] == []
