"""Docstrings of public functions name the parameters that there are, and say what is raised."""

import importlib
import inspect
import pkgutil
import re

import pytest

import bem

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


@pytest.mark.parametrize("name", bem.__all__)
def test_everything_public_says_what_it_is(name):
    item = getattr(bem, name)
    if inspect.isclass(item) or inspect.isfunction(item):
        assert item.__doc__
        assert not item.__doc__.startswith(f"{name}("), "a generated docstring"
