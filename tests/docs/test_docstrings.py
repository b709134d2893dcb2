"""Docstrings name the parameters, attributes and names that there are, and no others."""

import ast
import builtins
import dataclasses
import importlib
import inspect
import keyword
import pkgutil
import re
from pathlib import Path

import pytest

import bem
from bem.scenes.kind import get_kind, kind_names
from bem.scenes.records import figures

_SECTION = re.compile(r"^(\w[\w ]*)\n-{3,}$", re.MULTILINE)


def public_functions():
    """All public functions of bem's modules, by qualified name."""
    found = {}
    for module in pkgutil.walk_packages(bem.__path__, "bem."):
        if any(part.startswith("_") for part in module.name.split(".")):
            continue
        loaded = importlib.import_module(module.name)
        for name, item in vars(loaded).items():
            if name.startswith("_") or getattr(item, "__module__", None) != module.name:
                continue
            if inspect.isfunction(inspect.unwrap(item)) if callable(item) and not inspect.isclass(item) else False:
                found[f"{module.name}.{name}"] = inspect.unwrap(item)
    return found


FUNCTIONS = public_functions()


def sections(text):
    parts = _SECTION.split(inspect.cleandoc(text))
    return dict(zip(parts[1::2], parts[2::2], strict=True))


def named(section):
    """Names at the start of the section's entries: `a, b : what they are`."""
    names = []
    for line in section.strip("\n").splitlines():
        match = re.match(r"^(\*{0,2}\w+(?:, \*{0,2}\w+)*) : ", line)
        if match:
            names += [name.strip().lstrip("*") for name in match[1].split(",")]
    return names


@pytest.mark.parametrize("name", sorted(FUNCTIONS))
def test_documented_parameters_are_those_of_the_signature(name):
    function = FUNCTIONS[name]
    assert function.__doc__, f"{name} has no docstring"
    documented = sections(function.__doc__)
    if "Parameters" not in documented:
        return
    # an entry may follow another on its line: "a : ... . b : ..."
    text = documented["Parameters"]
    parameters = list(inspect.signature(function).parameters)
    unknown = [item for item in named(text) if item not in parameters]
    assert not unknown, f"{name}: docstring names {unknown}, which are no parameters"
    missing = [item for item in parameters if not re.search(rf"\b{item}\b", text)]
    assert not missing, f"{name}: parameters {missing} are not in the docstring"


def test_the_check_sees_mistakes():
    def wrong(a, b):
        """One line.

        Parameters
        ----------
        a, c : numbers.
        """

    assert named(sections(wrong.__doc__)["Parameters"]) == ["a", "c"]
    assert len(FUNCTIONS) > 200
    assert sum("Parameters" in sections(f.__doc__) for f in FUNCTIONS.values()) > 30


def public_classes():
    """All classes of bem's modules with a section about their attributes or parameters, by qualified name."""
    found = {}
    for module in pkgutil.walk_packages(bem.__path__, "bem."):
        for name, item in vars(importlib.import_module(module.name)).items():
            own = inspect.isclass(item) and item.__module__ == module.name and item.__doc__
            if own and {"Attributes", "Parameters"} & set(sections(item.__doc__)):
                found[f"{module.name}.{name}"] = item
    return found


CLASSES = public_classes()


def attributes(item):
    """Names that an object of the class has, or that it is made with."""
    fields = {field.name for field in dataclasses.fields(item)} if dataclasses.is_dataclass(item) else set()
    return fields | set(dir(item)) | set(inspect.signature(item).parameters)


def wrong_attributes(item):
    """Documented names that the class lacks, and public fields of a dataclass that are not documented."""
    text = "\n".join(sections(item.__doc__).get(title, "") for title in ("Attributes", "Parameters"))
    fields = [f.name for f in dataclasses.fields(item)] if dataclasses.is_dataclass(item) else []
    return (
        [name for name in named(text) if name not in attributes(item)],
        [name for name in fields if not name.startswith("_") and not re.search(rf"\b{name}\b", text)],
    )


@pytest.mark.parametrize("name", sorted(CLASSES))
def test_documented_attributes_are_those_of_the_class(name):
    unknown, missing = wrong_attributes(CLASSES[name])
    assert not unknown, f"{name}: docstring names {unknown}, which it does not have"
    assert not missing, f"{name}: {missing} are not in the docstring"


SOURCES = {path: path.read_text("utf-8") for path in sorted(Path(bem.__path__[0]).rglob("*.py"))}
_ROOMS = {path.stem if path.stem != "__init__" else path.parent.name for path in SOURCES} - {"bem"}
_OTHERS = ("numpy", "scipy", "xarray", "pyfftw")
_FILES = ("json", "nc", "csv", "toml", "vtu", "html", "py", "npz")


def docstrings(tree):
    """All docstrings in a file, with the name of what they describe."""
    for node in ast.walk(tree):
        has_one = isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef)
        if has_one and (text := ast.get_docstring(node, clean=False)):
            yield getattr(node, "name", "module"), text


def names_in_code(tree):
    """Identifiers of a file, and words of its strings (scene keys, figures), docstrings left out."""
    about = {text for _, text in docstrings(tree)}
    found = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value not in about:
            found |= set(re.findall(r"\w+", node.value))
        for key in ("id", "attr", "arg", "name", "module"):
            if isinstance(value := getattr(node, key, None), str):
                found |= set(value.split("."))
    return found


TREES = {path: ast.parse(text) for path, text in SOURCES.items()}
NAMES = set().union(*map(names_in_code, TREES.values())) | set(keyword.kwlist) | set(dir(builtins)) | _ROOMS
NAMES |= {key for kind in kind_names() for key in figures(get_kind(kind).record)}  # made of a field and its unit
NAMES |= {path.stem for path in Path(bem.__path__[0]).rglob("*") if path.suffix}


def exists(name):
    """Whether a (dotted) name may stand in a docstring: words that the code uses, a file, or another library's."""
    *first, last = name.removesuffix("()").split(".")
    if last in _FILES or (first and first[0] in _OTHERS):
        return True
    return all(part in NAMES or part.isdigit() for part in (*first, last))


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: str(path.relative_to(bem.__path__[0])))
def test_names_in_docstrings_exist(path):
    unknown = [
        f"{where}: `{name}`"
        for where, text in docstrings(TREES[path])
        for name in re.findall(r"(?<!`)`([A-Za-z_]\w*(?:\.\w+)*(?:\(\))?)`(?!`)", text)
        if not exists(name)
    ]
    assert not unknown, unknown


def test_the_checks_of_names_see_mistakes():
    @dataclasses.dataclass
    class Wrong:
        """One line.

        Attributes
        ----------
        load, rate : numbers.
        """

        load: float
        speed: float

    assert wrong_attributes(Wrong) == (["rate"], ["speed"])
    assert len(CLASSES) > 10
    assert not exists("friction.mixed_contact")  # what a docstring once said
    assert not exists("solve_contcat")
    assert exists("bem.lubrication.solve_line_film")


@pytest.mark.parametrize("name", bem.__all__)
def test_everything_public_says_what_it_is(name):
    item = getattr(bem, name)
    if inspect.isclass(item) or inspect.isfunction(item):
        assert item.__doc__
        assert not item.__doc__.startswith(f"{name}("), "a generated docstring"
