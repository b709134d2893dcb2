"""Laws of oil, friction, wear and tribofilms: what one looks like, and the one registry that knows them all.

A law is a frozen dataclass that derives from its family's class (`bem.lubrication.viscosity.ViscosityLaw` and its like,
see `FAMILIES`): a `name`, its parameters as fields made by `parameter`, its formula as the method that the family asks
for. `register` enters it. Constructors, scenes, schema, messages and documentation take names and parameters from
here.

Laws from outside the package are registered as all extensions are, see `bem.extensions`.
"""

from __future__ import annotations

import dataclasses
import difflib
import importlib
import math
import re
from abc import ABCMeta
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, TypeVar

from bem.errors import InputError
from bem.extensions import load_extensions

FAMILIES = {
    "viscosity_law": "bem.lubrication.viscosity",
    "density_law": "bem.lubrication.density",
    "shear_law": "bem.lubrication.shear",
    "boundary_friction": "bem.friction.boundary",
    "slip_friction": "bem.tangential.friction_laws",
    "adhesion": "bem.adhesion.laws",
    "criterion": "bem.wear.criterion",
    "removal": "bem.wear.removal",
    "traction": "bem.wear.traction",
    "growth": "bem.tribofilm.growth",
    "film_property": "bem.tribofilm.properties",
}
"""Families and where the package's own laws of each are; the module is loaded when the family is first asked for."""

_NAME = re.compile(r"[a-z][a-z0-9_]{0,63}")
_REQUIRED: Any = dataclasses.MISSING


@dataclass(frozen=True)
class Parameter:
    """What a number of a law is.

    meaning : in words. unit : SI, "" for none. above, at_least, below, at_most : bounds, None for none.
    several : a list of such numbers. source : where the default or the bounds come from.
    """

    meaning: str
    unit: str = ""
    above: float | None = None
    at_least: float | None = None
    below: float | None = None
    at_most: float | None = None
    several: bool = False
    source: str = ""

    def holds(self, value: object) -> bool:
        """Return True if a number is finite and within the bounds."""
        try:
            number = float(value)  # type: ignore[arg-type]
        except (TypeError, ValueError):
            return False
        return (
            not isinstance(value, str | bool)
            and math.isfinite(number)
            and (self.above is None or number > self.above)
            and (self.at_least is None or number >= self.at_least)
            and (self.below is None or number < self.below)
            and (self.at_most is None or number <= self.at_most)
        )

    @property
    def allowed(self) -> str:
        """The bounds and the unit, as the end of a message."""
        lower = (
            f"({self.above:g}" if self.above is not None else f"[{self.at_least:g}" if self.at_least is not None else ""
        )
        upper = (
            f"{self.below:g})" if self.below is not None else f"{self.at_most:g}]" if self.at_most is not None else ""
        )
        unit = f" [{self.unit}]" if self.unit else ""
        if upper:
            return f"must lie in {lower or '(-inf'}, {upper}{unit}"
        if not lower:
            return f"must be finite{unit}"
        words = {"(0": "positive", "[0": "zero or positive"}
        return (
            f"must be {words.get(lower, ('above ' if lower[0] == '(' else 'at least ') + lower[1:])} and finite{unit}"
        )


def parameter(
    meaning: str,
    unit: str = "",
    *,
    default: Any = _REQUIRED,
    above: float | None = None,
    at_least: float | None = None,
    below: float | None = None,
    at_most: float | None = None,
    several: bool = False,
    source: str = "",
    keyword_only: bool = False,
) -> Any:
    """A field of a law: a number, or several.

    Parameters
    ----------
    meaning : in words, for the documentation and for messages.
    unit : SI unit, "" for none; scenes take any unit of the same dimension.
    default : value where none is given; without it the parameter is required. None: the law finds the value elsewhere.
    above, at_least, below, at_most : bounds.
    several : a tuple of numbers instead of one.
    source : where default or bounds come from.
    keyword_only : True for a parameter with a default in a family's class, whose laws have required ones of their own.
    """
    about = Parameter(meaning, unit, above, at_least, below, at_most, several, source)
    return dataclasses.field(
        default=default, metadata={"parameter": about}, kw_only=keyword_only or dataclasses.MISSING
    )


@dataclass(frozen=True)
class Law(metaclass=ABCMeta):  # noqa: B024 - its families say what is abstract
    """What all laws share: parameters are checked and become floats when one is made.

    Raises
    ------
    InputError : one message per parameter out of bounds, and those of `rules`.
    """

    family: ClassVar[str] = ""
    name: ClassVar[str] = ""
    cites: ClassVar[tuple[str, ...]] = ()
    """Keys of the law's sources in `references.bib`."""

    def __post_init__(self) -> None:
        messages = []
        optional = {field.name for field in dataclasses.fields(self) if field.default is None}
        for key, about in self.parameters().items():
            value = getattr(self, key)
            if value is None and key in optional:
                continue
            numbers = tuple(value) if about.several and not isinstance(value, str) and _iterable(value) else (value,)
            if not all(about.holds(number) for number in numbers) or (about.several and not _iterable(value)):
                messages.append(f"{type(self).__name__}: {key} {value!r} {about.allowed}")
            else:
                object.__setattr__(self, key, tuple(map(float, numbers)) if about.several else float(value))
        messages = messages or [f"{type(self).__name__}: {text}" for text in self.rules()]
        if messages:
            raise InputError(messages)

    def rules(self) -> Iterable[str]:
        """Messages about parameters that do not go together; none by default."""
        return ()

    @classmethod
    def parameters(cls) -> dict[str, Parameter]:
        """The parameters by name."""
        return {
            field.name: field.metadata["parameter"]
            for field in dataclasses.fields(cls)
            if "parameter" in field.metadata
        }

    @classmethod
    def required(cls) -> tuple[str, ...]:
        """Names of the parameters without a default."""
        fields = {field.name: field for field in dataclasses.fields(cls)}
        return tuple(key for key in cls.parameters() if fields[key].default is _REQUIRED)

    @classmethod
    def enter(cls) -> None:
        """As `register`."""
        register(cls)

    def values(self) -> dict[str, Any]:
        """The parameters' values by name."""
        return {key: getattr(self, key) for key in self.parameters()}


LawClass = TypeVar("LawClass", bound=type[Law])
_laws: dict[str, dict[str, type[Law]]] = {family: {} for family in FAMILIES}
_loaded: set[str] = set()


def register(law: LawClass) -> LawClass:
    """Enter a law under its family and name; also a class decorator, above `@dataclass(frozen=True)`.

    Parameters
    ----------
    law : a frozen dataclass that derives from a family's class.

    Raises
    ------
    InputError : no such class, one without the family's formula, no or a strange name, a name that another law of the
        family has, or a parameter that another law of the family has in another unit.
    """
    if not (isinstance(law, type) and issubclass(law, Law) and law.family in FAMILIES):
        raise InputError(f"register: {law!r} does not derive from a family of laws; families: {', '.join(FAMILIES)}")
    own_fields = law.__dict__.get("__dataclass_params__")
    if own_fields is None or not own_fields.frozen:
        raise InputError(f"register: {law.__name__} is not a frozen dataclass; write @dataclass(frozen=True) above it")
    if not _NAME.fullmatch(law.name):
        raise InputError(f"register: {law.__name__}.name {law.name!r} must be lower-case letters, digits and _")
    _load(law.family, plugins=False)
    entered = _laws[law.family]
    other = entered.get(law.name)
    if other is not None and (other.__module__, other.__qualname__) != (law.__module__, law.__qualname__):
        raise InputError(f"register: {law.family} {law.name!r} is taken by {other.__module__}.{other.__qualname__}")
    for beside in entered.values():
        for key, about in law.parameters().items():
            if beside is not other and key in beside.parameters() and beside.parameters()[key].unit != about.unit:
                raise InputError(
                    f"register: {law.__name__}.{key} is in [{about.unit}], but {beside.__name__} has it in "
                    f"[{beside.parameters()[key].unit}]"
                )
    if law.__abstractmethods__:
        wanting = ", ".join(sorted(law.__abstractmethods__))
        raise InputError(f"register: {law.__name__} does not define {wanting}, which every {law.family} needs")
    entered[law.name] = law
    return law


def unregister(law: type[Law]) -> None:
    """Take a law out again; nothing happens if it is not in."""
    if _laws.get(law.family, {}).get(law.name) is law:
        del _laws[law.family][law.name]


def modules_of_laws() -> tuple[str, ...]:
    """Modules of all laws from outside the package: what another process has to import to know them too."""
    found = {law.__module__ for entered in _laws.values() for law in entered.values()}
    return tuple(sorted(name for name in found if name.split(".")[0] != "bem"))


def laws_of(family: str) -> Mapping[str, type[Law]]:
    """The laws of a family by name, in alphabetical order."""
    _load(family, plugins=True)
    return dict(sorted(_laws[family].items()))


REMOVED_LAWS = {
    ("criterion", "sphere"): ("averaged_von_mises", "junction"),
}
"""Laws of earlier versions by family and name, and the laws to use in their place."""


def unknown_law(family: str, word: object) -> str:
    """`is unknown`, as `unknown` says it of the laws of a family, or `was removed` and what to use instead."""
    instead = REMOVED_LAWS.get((family, str(word)))
    return unknown(word, laws_of(family)) if instead is None else f"was removed; use {' or '.join(map(repr, instead))}"


def unknown(word: object, names: Iterable[str]) -> str:
    """`is unknown - did you mean "..."?; choose from ...`."""
    listed = sorted(names)
    close = difflib.get_close_matches(str(word).lower().replace("-", "_"), listed, n=1, cutoff=0.6)
    hint = f" - did you mean {close[0]!r}?" if close else ""
    return f"is unknown{hint}; choose from {', '.join(listed)}"


def make_laws(owner: str, chosen: Mapping[str, object], given: Mapping[str, object]) -> dict[str, Law]:
    """Laws by family from names, laws or tables as in scenes, and parameters by name.

    A parameter goes to every chosen law that has it; one that only other laws of the families have is left out, so that
    a law can be changed by its name alone.

    Parameters
    ----------
    owner : who asks, for messages.
    chosen : by family the name of a law, a law, or a table with its name as `kind` and parameters.
    given : values by parameter; None is not given.

    Raises
    ------
    InputError : one message per unknown law or parameter, missing parameter, or value out of bounds.
    """
    messages: list[str] = []
    classes: dict[str, type[Law]] = {}
    tables = {family: dict(value) for family, value in chosen.items() if isinstance(value, Mapping)}
    chosen = {
        family: tables[family].pop("kind", None) if family in tables else value for family, value in chosen.items()
    }
    for family, value in chosen.items():
        if isinstance(value, Law) and value.family == family:
            classes[family] = type(value)
        elif isinstance(value, str) and value in laws_of(family):
            classes[family] = laws_of(family)[value]
        else:
            messages.append(f"{owner}: {family} {value!r} {unknown_law(family, value)}")
    known = {key for family in chosen for law in laws_of(family).values() for key in law.parameters()}
    known |= {key for law in classes.values() for key in law.parameters()}
    asked = {*given, *(key for table in tables.values() for key in table)}
    messages += [f"{owner}: {key} {unknown(key, known)}" for key in sorted(asked - known)]
    made: dict[str, Law] = {}
    for family, law in classes.items():
        both = {**tables.get(family, {}), **{key: value for key, value in given.items() if value is not None}}
        own = {key: value for key, value in both.items() if key in law.parameters()}
        value = chosen[family]
        missing = [] if isinstance(value, Law) else [key for key in law.required() if key not in own]
        messages += [
            f"{owner}: {key} is missing, which {family} {law.name!r} needs: {law.parameters()[key].meaning}, "
            + law.parameters()[key].allowed
            for key in missing
        ]
        if missing:
            continue
        try:
            made[family] = dataclasses.replace(value, **own) if isinstance(value, Law) else law(**own)
        except InputError as error:
            messages += [f"{owner}: {text.partition(': ')[2]}" for text in error.messages]
    if messages:
        raise InputError(messages)
    return made


def _iterable(value: object) -> bool:
    return isinstance(value, Iterable) and not isinstance(value, str)


def _load(family: str, *, plugins: bool) -> None:
    """Load the package's laws of a family, and once those of others."""
    if family not in _loaded:
        _loaded.add(family)
        importlib.import_module(FAMILIES[family])
    if plugins:
        load_extensions()
