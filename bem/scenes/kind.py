"""Kinds of scene: the class, and the registry of the package's kinds (a folder of `bem/kinds` each) and those that
`bem.register` entered.

Knows plans, records and axes; no kind of its own until one is asked for. Verified in tests/scenes and tests/extension.
"""

from __future__ import annotations

import importlib
import pkgutil
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from bem.errors import InputError
from bem.extensions import load_extensions, same_origin
from bem.scenes.asked import ALL, figures_that_may_be_asked, figures_that_may_not
from bem.scenes.axes import Axis
from bem.scenes.common import MeasuredSurface, SceneModel, Table
from bem.scenes.context import Context
from bem.scenes.paths import checksum_of
from bem.scenes.planner import Plan
from bem.scenes.profile import ProfileScene
from bem.scenes.records import Record
from bem.scenes.records import headline as headline_of
from bem.scenes.resolutions import Resolution
from bem.scenes.uncertain import deviations

KINDS = Path(__file__).resolve().parents[1] / "kinds"
"""Folder of the package's kinds: each one's parts, and its built-in scenes under `examples`."""
TASKS = ("dry contact", "oil films (EHL)", "mixed lubrication", "wear and running-in", "tribofilms")
"""Order of the tasks that lists of kinds go by; other tasks follow, and last of all `OTHER`."""
OTHER = "other kinds"
"""Task of a kind that says none."""
_NAME = re.compile(r"[a-z][a-z0-9-]{0,63}")


@dataclass(frozen=True)
class Kind:
    """A kind of scene, with one case in a scene wherever a function takes one, but for `axes` and `summarise`.

    Attributes
    ----------
    name : what `kind = "..."` in a scene says; the folder's name with "-" for "_".
    title : one line.
    model : of the scene's tables.
    plan : what will be computed, without any work.
    run : does it.
    record : its result.
    figures : names from `bem.plots.figures`, drawn when the run is over.
    headline : keys of the summary to show first; the figures that the record marks so follow.
    resolve : fills in what files decide, first of all.
    axes : what a scene runs over.
    summarise : further keys of the summary, from all records.
    volumes : variables for ParaView.
    scattering : figures that its record says never have an error bar, but whose scatter over repetitions is one under
        the models that a scene has chosen.
    always_lists : whether the summary has lists for a single case too.
    resolutions : what is refined where an accuracy
        is asked for.
    contacts : contacts of a scene, each a `bem.scenes.checks.Case`, that plans show and checks examine; None where
        there are none.
    warm_up : built-in scenes and the settings that make them small; their runs compile the loops of the kind.
    by_tangent : whether `run` itself propagates the uncertainty of a scene's key (`Record.input_changes`); otherwise
        the run is repeated on both sides of the value.
    refuse_on_ranks : raises InputError for a scene whose contact several processes (`bem.distributed`) cannot solve;
        None where no scene of the kind can be run so.
    task : of a kind from outside the package, under which lists show it; a folder of `bem/kinds` says its own.
    """

    name: str
    title: str
    model: type[SceneModel]
    plan: Callable[[Any], Plan]
    run: Callable[[Any, Context], Record]
    record: type[Record]
    figures: tuple[str, ...] = ()
    headline: tuple[str, ...] = ()
    resolve: Callable[[Any], Any] = lambda scene: scene
    axes: Callable[[Any], tuple[Axis, ...]] = lambda scene: ()
    summarise: Callable[[Any, Sequence[Axis], Sequence[Any]], dict[str, Any]] = lambda scene, axes, records: {}
    volumes: Callable[[Any], tuple[str, ...]] = lambda scene: ()
    scattering: Callable[[Any], tuple[str, ...]] = lambda scene: ()
    always_lists: bool = False
    resolutions: tuple[Resolution, ...] = ()
    contacts: Callable[[Any], list[Any]] | None = None
    warm_up: tuple[tuple[str, tuple[str, ...]], ...] = ()
    by_tangent: Callable[[Any, str], bool] = lambda scene, key: False
    refuse_on_ranks: Callable[[Any], None] | None = None
    task: str = OTHER

    def __post_init__(self) -> None:
        marked = (key for key in headline_of(self.record) if key not in self.headline)
        object.__setattr__(self, "headline", (*self.headline, *marked))

    def resolved(self, scene: Any) -> Any:
        """The scene with what files decide filled in, and, where it asks for an accuracy, with its first level.

        Raises
        ------
        InputError : an accuracy that cannot be asked for; what `resolve` refuses.
        """
        if scene.accuracy is not None:
            self._check_accuracy(scene)
            for one in self.resolutions:
                scene = one.first(scene)
        resolved = self.resolve(with_checksums(scene))
        deviations(resolved)  # refuses keys that hold no number
        return resolved

    def _check_accuracy(self, scene: Any) -> None:
        """Refuse an accuracy of figures that there are not, or that this kind cannot refine to."""
        if not self.resolutions:
            raise InputError(f"accuracy: a scene of kind {self.name} has no error bars that it could be refined by")
        if not getattr(getattr(scene, "outputs", None), "errors", True):
            raise InputError("accuracy: outputs.errors is false; allowed: true, error bars say whether it is met")
        names = figures_that_may_be_asked(self.record, self.headline)
        asked = scene.accuracy if isinstance(scene.accuracy, Mapping) else {}
        unknown = [name for name in asked if name != ALL and name not in names]
        if unknown:
            why, listed = figures_that_may_not(self.record), ", ".join([ALL, *names])
            own = f"no figure of kind {self.name}"
            raise InputError([f"accuracy.{name}: {why.get(name, own)}; allowed: {listed}" for name in unknown])

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


def with_checksums(table: Any) -> Any:
    """The table with the checksums of its files of surfaces and profiles, at any depth; itself where there are none."""
    changed: dict[str, Any] = {}
    for name in type(table).model_fields:
        inner = getattr(table, name)
        if isinstance(inner, Table):
            whole = with_checksums(inner)
            if whole is not inner:
                changed[name] = whole
    if isinstance(table, MeasuredSurface | ProfileScene) and table.path is not None and table.sha256 is None:
        changed["sha256"] = checksum_of(table.path)
    return table.model_copy(update=changed) if changed else table


_registered: dict[str, Kind] = {}


def kind_names() -> tuple[str, ...]:
    """Names of all kinds by task, without loading those of the package."""
    return tuple(name for names in kinds_by_task().values() for name in names)


def kinds_by_task() -> dict[str, tuple[str, ...]]:
    """Names of all kinds by task, without loading those of the package."""
    load_extensions()
    listed = {
        name: (getattr(part, "TASK", OTHER), getattr(part, "PLACE", 0)) for name, part in _of_the_package().items()
    }
    listed |= {name: (kind.task, 0) for name, kind in _registered.items()}
    found: dict[str, list[str]] = {task: [] for task in TASKS}
    for name in sorted(listed, key=lambda name: (listed[name][0] == OTHER, *listed[name], name)):
        found.setdefault(listed[name][0], []).append(name)
    return {task: tuple(names) for task, names in found.items() if names}


def kind_aliases() -> dict[str, str]:
    """Names that people guess for kinds, and the kinds."""
    return {word: name for name, part in _of_the_package().items() for word in getattr(part, "ALSO", ())}


def sources_of_kind(name: str) -> dict[str, str]:
    """Return the sources of the methods of a kind: key in `references.bib` and method; none of kinds from outside."""
    return dict(getattr(_of_the_package().get(name), "CITES", {}))


@cache
def _of_the_package() -> dict[str, Any]:
    """Folders of the package's kinds by name: modules with TASK, PLACE among the kinds of the task, ALSO and CITES."""
    folders = sorted(module.name for module in pkgutil.iter_modules([str(KINDS)]) if module.ispkg)
    return {name.replace("_", "-"): importlib.import_module(f"bem.kinds.{name}") for name in folders}


def get_kind(name: str) -> Kind:
    """The kind of that name; KeyError if there is none."""
    if name not in kind_names():
        raise KeyError(name)
    if name in _registered:
        return _registered[name]
    kind = importlib.import_module(f"bem.kinds.{name.replace('-', '_')}.kind").KIND
    assert isinstance(kind, Kind)
    assert kind.name == name, f"kind {kind.name!r} must live in bem/kinds/{kind.name.replace('-', '_')}"
    return kind
