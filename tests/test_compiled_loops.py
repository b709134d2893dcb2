"""Compiled loops have the bits of their own text, whoever calls them first.

A loop that does not say what it allows of its arithmetic is compiled with what the first caller in the process allows,
and kept on disk like that: pressures differed in the last digits by the order of the contacts before them.
"""

import ast
from pathlib import Path

import bem

PACKAGE = Path(bem.__file__).parent


def _says(call: ast.Call, shared: dict[str, set[str]]) -> bool:
    """Whether the options of a decorator, written out or in a dictionary of the package, say it."""
    named = {keyword.arg for keyword in call.keywords if keyword.arg}
    for keyword in call.keywords:
        if keyword.arg is None:
            named |= shared[ast.unparse(keyword.value).split(".")[-1]]
    return "fastmath" in named


def test_every_compiled_loop_says_what_it_allows_of_its_arithmetic():
    trees = {path: ast.parse(path.read_text()) for path in PACKAGE.rglob("*.py")}
    shared: dict[str, set[str]] = {}
    for tree in trees.values():
        for node in ast.walk(tree):
            if isinstance(node, ast.AnnAssign) and isinstance(node.value, ast.Dict) and "COMPILE" in ast.unparse(node):
                keys = {key.value for key in node.value.keys if isinstance(key, ast.Constant)}
                name = ast.unparse(node.target)
                shared[name] = shared.get(name, keys) & keys
    calls = [
        (path, node)
        for path, tree in trees.items()
        for node in ast.walk(tree)
        if isinstance(node, ast.Call) and ast.unparse(node.func).split(".")[-1] == "njit"
    ]
    bare = [
        (path, node.lineno)
        for path, tree in trees.items()
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef)
        for name in node.decorator_list
        if not isinstance(name, ast.Call) and ast.unparse(name).split(".")[-1] == "njit"
    ]
    assert len(calls) > 100
    assert not bare
    assert [f"{path.name}:{call.lineno}" for path, call in calls if not _says(call, shared)] == []
