"""Kinds of scene. One file here is one kind: nothing else has to know of it. A file of yours is one as well if it ends
in `bem.register(KIND)`, see `bem.extensions`; its figures it registers likewise.

To add the kind `wear`, write `bem/scenes/kinds/wear.py` (a kind `running-in` lives in `running_in.py`) with

    KIND = Kind(
        name="wear",              # the file's name with "-" for "_"; what `kind = "..."` in a scene says
        title="wear particles ...",         # one line
        model=WearScene,          # pydantic model, a subclass of bem.scenes.common.SceneModel
        plan=plan,                # plan(scene) -> Plan: of one case, no work; says what is skipped and why
        run=run,                  # run(scene, context) -> record: one case
        record=WearRecord,        # what a case gives, a dataclass as of bem.scenes.records
        axes=axes,                # optional: axes(scene) -> what the scene runs over, as of bem.scenes.axes
        figures=("pressure-map", ...),      # names from bem/plots/figures/, drawn when the run is over
        headline=("particle_equivalent_radius_nm", ...),    # keys of the summary to show first
        resolve=resolve,          # optional: resolve(scene) -> scene, first of all: fills in what files decide
        summarise=summarise,      # optional: summarise(scene, axes, records) -> more keys of the summary
    )

*One case.* `plan` and `run` are given a scene in which every axis has one value, and know of no other. Loads, variants,
repetitions, whatever `[over]` names, processes, clusters, statistics, notes of many cases, resuming and the dataset are
the business of `bem.campaigns`.

*Model.* Fields have the types of `bem.scenes.units` (`Length`, `Force`, `Temperature`, ...: strings with units or
SI numbers come in, SI floats come out) and the tables of `bem.scenes.common` (`BodyScene` = material + layer +
surface, `UpperBodyScene` likewise but rigid without material, `GridScene`, `ShapeScene`, `DepthsScene`,
`MaterialScene`). Bounds: `Annotated[Length, Field(gt=0)]`; integers and booleans: `Field(strict=True)`; choices:
`Literal[...]`; variants: a union of tables with `kind: Literal[...]` and `Field(discriminator="kind")`; rules
between keys: a `model_validator(mode="after")` that raises `problem("what is wrong", "what is allowed")`. Files are
given in keys called `path` (made absolute on loading). Messages, nearest spellings, units in the resolved scene
file and the JSON schema all follow from the model.

*Building.* `bem.scenes.build` turns tables into `Grid`, `Body` and heights: `resolved_grid(scene.grid, *surfaces)`
for `resolve`, `grid_of(scene.grid)`, `scene.lower.build()`, `heights_of(scene.lower.surface, grid, seed,
context.note)`, `shape_of(scene.shape, grid)`, `softer_hardness(lower, upper)`, `traction_couples(lower, upper,
friction)`.

*Plan.* `Plan((Step(name, why, skipped=..., transforms=count, points=of each, memory=bytes, seconds=other), ...))`;
`bem.scenes.planner` has `padded_points` and `convolution_memory`. `bem run` refuses a plan that does not fit into
memory.

*Run.* Imports of solvers belong inside `run`, so that `bem scenes` stays light. The context
(`bem.scenes.context.Context`) offers

- `context.seed("lower")`, `context.seed("slide", cycle)`: a seed per purpose, the same whenever the scene is run;
- `context.progress(done, total, "cycles", radius_nm=140.0)`: shown on a terminal, with the time left;
- `context.note("...")`: what the reader of the results must know; on screen, in `summary.json`, in the report;
- `with context.timer("stresses"):` sums of seconds per stage, in `summary.json` as `seconds_by_stage`;
- `context.save({...})`: replaces the checkpoint, whole or not at all (arrays, plain values, lists, dicts);
- `context.saved()`: that state when the run is resumed, else None; a resumed run must end in the same bits.

An interrupt is a `KeyboardInterrupt` out of any call; the state saved last is what a resumed run starts from. `run`
writes no file. It returns its record,

    @dataclass(frozen=True, eq=False)
    class WearRecord(Record):
        cycles: Annotated[int, Figure("", "cycles")]                                  # summary: cycles
        Sq_final: Annotated[float, Figure("nm", "Sq in the contact strip, run in")]   # summary: Sq_final_nm
        x: Annotated[FloatArray, Series(("x",), "m", "x, along sliding")]  # named like its dimension: a coordinate
        pressure: Annotated[FloatArray, Series(("x", "y"), "Pa", "contact pressure", of="last")]   # of the last case

in SI units, with `status` (the worst of its solvers; any but converged makes the exit code 3) and `where` ("cycle 17:
..."),
and raises `InputError` (bad input: the run's folder is removed again, unless something was saved in it) or
`ConvergenceError` (it cannot go on: the checkpoint stays, exit code 3). For scripts and tests
`bem.scenes.PlainContext` needs no disk.

*Built-in scenes* are files `bem/scenes/library/NAME.toml` with `kind`, `description` (one line) and `redoes` (item
of the thesis). *Figures* are functions in `bem/plots/figures/`; its docstring says how to add one."""

from __future__ import annotations

import importlib
import pkgutil
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cache
from typing import Any

from bem.errors import InputError
from bem.extensions import load_extensions, same_origin
from bem.scenes.axes import Axis
from bem.scenes.common import SceneModel
from bem.scenes.context import Context
from bem.scenes.planner import Plan
from bem.scenes.records import Record

_NAME = re.compile(r"[a-z][a-z0-9-]{0,63}")


def _unchanged(scene: Any) -> Any:
    return scene


def _no_axes(scene: Any) -> tuple[Axis, ...]:
    return ()


def _nothing_more(scene: Any, axes: Sequence[Axis], records: Sequence[Any]) -> dict[str, Any]:
    return {}


def _no_volumes(scene: Any) -> tuple[str, ...]:
    return ()


@dataclass(frozen=True)
class Kind:
    """A kind of scene; the module's docstring says what each part must do."""

    name: str
    title: str
    model: type[SceneModel]
    plan: Callable[[Any], Plan]
    run: Callable[[Any, Context], Record]
    record: type[Record]
    figures: tuple[str, ...] = ()
    headline: tuple[str, ...] = ()
    resolve: Callable[[Any], Any] = field(default=_unchanged)
    axes: Callable[[Any], tuple[Axis, ...]] = field(default=_no_axes)
    summarise: Callable[[Any, Sequence[Axis], Sequence[Any]], dict[str, Any]] = field(default=_nothing_more)
    volumes: Callable[[Any], tuple[str, ...]] = field(default=_no_volumes)
    always_lists: bool = False

    def enter(self) -> None:
        """Enter it, for a kind from outside the package; see `bem.register`.

        Raises
        ------
        InputError : a strange name, one that another kind has, a model whose `kind` is another or that is no scene.
        """
        if not _NAME.fullmatch(self.name):
            raise InputError(f"register: the kind's name {self.name!r} must be lower-case letters, digits and -")
        if not (isinstance(self.model, type) and issubclass(self.model, SceneModel)):
            raise InputError(f"register: the model of kind {self.name!r} does not derive from SceneModel")
        if self.model.model_fields["kind"].default != self.name:
            raise InputError(f'register: {self.model.__name__} needs kind: Literal["{self.name}"] = "{self.name}"')
        other = _registered.get(self.name)
        if self.name in _of_the_package() or (other is not None and not same_origin(other.model, self.model)):
            raise InputError(f"register: the kind {self.name!r} is taken")
        _registered[self.name] = self


_registered: dict[str, Kind] = {}


def kind_names() -> tuple[str, ...]:
    """Names of all kinds, without loading those of the package."""
    load_extensions()
    return tuple(sorted({*_of_the_package(), *_registered}))


@cache
def _of_the_package() -> tuple[str, ...]:
    return tuple(sorted(module.name.replace("_", "-") for module in pkgutil.iter_modules(__path__)))


def get_kind(name: str) -> Kind:
    """The kind of that name; KeyError if there is none."""
    if name not in kind_names():
        raise KeyError(name)
    if name in _registered:
        return _registered[name]
    kind = importlib.import_module(f"bem.scenes.kinds.{name.replace('-', '_')}").KIND
    assert isinstance(kind, Kind)
    assert kind.name == name, f"kind {kind.name!r} must live in {kind.name.replace('-', '_')}.py"
    return kind
