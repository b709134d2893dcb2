"""Functions and files stay small enough to be read at a sitting; what is larger says why where it stands."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
MOST_LINES = 60  # of a function, its docstring not counted
MOST_ARGUMENTS = 9
LARGEST_FILE = 450
REASON = "# reason: "


def sources():
    for folder in ("bem", "reports", "fem_reference", "meshes"):
        for path in sorted((ROOT / folder).rglob("*.py")):
            yield path.relative_to(ROOT).as_posix(), path.read_text(encoding="utf-8")


def large_functions(source):
    """(name, lines, arguments, whether a reason stands there) of functions that are too large."""
    text = source.splitlines()
    for node in ast.walk(ast.parse(source)):
        if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            continue
        described = ast.get_docstring(node, clean=False)
        lines = node.end_lineno - node.lineno + 1 - (len(described.splitlines()) if described else 0)
        arguments = len(node.args.posonlyargs) + len(node.args.args) + len(node.args.kwonlyargs)
        if lines > MOST_LINES or arguments > MOST_ARGUMENTS:
            said = any(REASON in line for line in text[node.lineno - 1 : node.body[0].lineno])
            yield node.name, lines, arguments, said


def test_large_functions_say_why():
    wanting = [
        f"{path}: {name} has {lines} lines and {arguments} arguments"
        for path, source in sources()
        for name, lines, arguments, said in large_functions(source)
        if not said
    ]
    assert not wanting, f"make them shorter, or write '{REASON}...' on the line of the def: {wanting}"


def test_no_file_is_long():
    long = [path for path, source in sources() if source.count("\n") > LARGEST_FILE]
    assert not long, f"more than {LARGEST_FILE} lines; divide them by what they know"


def test_no_merge_is_left_half_done():
    """Of texts, which say nothing of it themselves."""
    texts = [
        path
        for end in ("md", "html", "css")
        for top in ("", "bem/**/", "reports/**/")
        for path in ROOT.glob(f"{top}*.{end}")
    ]
    assert len(texts) > 3
    marks = ("<" * 7 + " ", ">" * 7 + " ")
    left = [path.name for path in texts if any(line.startswith(marks) for line in path.read_text("utf-8").splitlines())]
    assert not left, f"decide between both sides: {left}"


@pytest.mark.parametrize(
    ("source", "found"),
    [
        ("def short(a): pass", []),
        ("def wide(a, b, c, d, e, *, f, g, h, i, j): pass", [("wide", 1, 10, False)]),
        ("def wide(  # reason: a promise\n    a, b, c, d, e, f, g, h, i, j\n): pass", [("wide", 3, 10, True)]),
        ("def long():\n" + "    x = 1\n" * 60, [("long", 61, 0, False)]),
        ('def told():\n    """A\n    B\n    C"""\n' + "    x = 1\n" * 59, []),
    ],
)
def test_the_measure_itself(source, found):
    assert list(large_functions(source)) == found


def test_no_two_test_files_share_a_name():
    """Two of one name cannot be collected together; run alone, neither says so."""
    names = [path.name for path in (ROOT / "tests").rglob("test_*.py")]
    assert len(names) == len(set(names))
