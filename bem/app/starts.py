"""What the first page offers to start from: tasks as users name them, kinds of scene, built-in scenes.

Verified in tests/app/test_starts.py.
"""

from __future__ import annotations

from dataclasses import dataclass

from bem.errors import InputError
from bem.scenes.kind import get_kind, kinds_by_task
from bem.scenes.load import library, library_text
from bem.scenes.own_surfaces import MeasuredMap
from bem.scenes.template import scene_template


@dataclass(frozen=True)
class Start:
    """A task to start with.

    Attributes
    ----------
    name : of the scene that comes of it.
    title, words : what it is called, and what it computes.
    source : of the scene's text: "kind contact", "scene coated-sphere"; or "page /surfaces".
    """

    name: str
    title: str
    words: str
    source: str

    @property
    def picture(self) -> str:
        """Name of its sketch: of the kind it starts, or its own."""
        what, _, name = self.source.partition(" ")
        return name if what == "kind" else self.name


TASKS = (
    Start("contact", "Dry contact", "Pressure, real contact area, approach and stresses of two bodies", "kind contact"),
    Start("stribeck", "Stribeck curve", "Friction and load share over speed in mixed lubrication", "kind friction"),
    Start("surfaces", "My own surfaces", "Read a measured map, level it, take it into a scene", "page /surfaces"),
    Start("running-in", "Wear and running-in", "Friction, roughness and wear particles over cycles", "kind running-in"),
    Start("coating", "Coating", "Stresses in a coated body under a ball", "scene coated-sphere"),
    Start("tribofilm", "Tribofilm", "Growth and wear of a film such as ZDDP's", "kind tribofilm"),
    Start("film", "EHL film", "Film thickness and pressure between a ball and a disc", "kind point-film"),
    Start("bearing", "Bearing", "Film, friction and rating life of a rolling bearing", "page /element/rolling-bearing"),
    Start("gear", "Gear", "Film, losses, temperatures and scuffing of a gear pair", "page /element/gear-pair"),
    Start("cam", "Cam", "Film, friction and wear between a cam and its follower", "page /element/cam-follower"),
    Start(
        "ring",
        "Piston ring",
        "Film, friction and wear between a piston ring and its liner",
        "page /element/piston-ring",
    ),
    Start(
        "bush", "Plain bush", "Contact, p v, temperature and wear life of a polymer bush", "page /element/plain-bush"
    ),
)


def start_text(source: str) -> str:
    """The text of a scene to start from, with its comments.

    Parameters
    ----------
    source : as in `Start`, of a kind or a built-in scene.

    Raises
    ------
    InputError : a source that is none.
    """
    what, _, name = source.partition(" ")
    if what == "kind":
        return scene_template(name)
    if what == "scene":
        return library_text(name)
    raise InputError(f"{source}: no text of a scene; allowed: kind NAME, scene NAME")


OF_SURFACES = {"contact": "dry contact", "friction": "Stribeck curve", "running-in": "running-in", "wear": "wear"}
"""Kinds of a scene that is begun with a measured surface, in words."""


def scene_of_surface(kind: str, surface: MeasuredMap) -> str:
    """Return the text of a first scene with a measured surface below, as `bem new KIND --lower FILE` writes it.

    Raises
    ------
    InputError : a map that is too small for the contact.
    """
    return scene_template(kind, surfaces={"lower": surface})


@dataclass(frozen=True)
class BuiltIn:
    """A built-in scene; `task` is that of its kind, `found_by` what a filter looks into."""

    name: str
    kind: str
    task: str
    words: str

    @property
    def found_by(self) -> str:
        """Text to look for words in."""
        return f"{self.name} {self.kind} {self.task} {self.words}".lower()


def built_in_scenes() -> list[BuiltIn]:
    """The built-in scenes, by task and name."""
    task_of = {name: task for task, names in kinds_by_task().items() for name in names}
    order = list(task_of)
    found = [
        BuiltIn(name, str(table["kind"]), task_of[str(table["kind"])], str(table.get("description", "")))
        for name, table in library().items()
    ]
    return sorted(found, key=lambda item: (order.index(item.kind), item.name))


def kinds_with_titles() -> dict[str, list[tuple[str, str]]]:
    """Name and title of each kind, by task."""
    return {task: [(name, get_kind(name).title) for name in names] for task, names in kinds_by_task().items()}
