"""Kind `ball`: the closed form of a ball on a flat."""

from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

import bem
from bem.grid import FloatArray
from bem.plots.figures import FigureKind
from bem.scenes import Kind
from bem.scenes.axes import listed
from bem.scenes.common import BodyScene, Force, PositiveLength, SceneModel
from bem.scenes.keys import key
from bem.scenes.planner import Plan, Step
from bem.scenes.records import Figure, Record, Series


class BallScene(SceneModel):
    """A rigid ball on a flat."""

    kind: Literal["ball"] = "ball"
    lower: BodyScene = key("The flat.", "basic")
    radius: PositiveLength = key("Radius of the ball.", "basic")
    loads: list[Annotated[Force, Field(gt=0)]] = key("Normal loads, one result for each.", "basic", min_length=1)


@dataclass(frozen=True, eq=False)
class BallRecord(Record):
    """Of one load."""

    approach: Annotated[float, Figure("nm", "approach of the ball")]
    r: Annotated[FloatArray, Series(("r",), "m", "distance from the axis", of="first")]
    pressure: Annotated[FloatArray, Series(("r",), "Pa", "pressure", of="last")]


def plan(scene):
    return Plan((Step("closed form", "of Hertz", seconds=0.001),))


def axes(scene):
    return (listed(scene, "loads", "load", Figure("N", "load")),)


def run(scene, context):
    from bem.reference_solutions.hertz import sphere_contact

    (load,) = scene.loads
    modulus = bem.contact_modulus(scene.lower.build().material)
    contact = sphere_contact(radius=scene.radius, contact_modulus=modulus, load=load)
    context.note("closed form")
    r = np.linspace(0, 2e-5, 50)
    return BallRecord(approach=contact.approach, r=r, pressure=contact.pressure(r, 0 * r))


def draw(run, figure):
    figure.add_subplot().plot(run.dataset["r"].values, run.dataset["pressure"].values)


bem.register(FigureKind("ball-pressure", "Pressure over the distance from the axis.", ("r", "pressure"), draw))
bem.register(
    Kind(
        name="ball",
        title="a ball on a flat, in closed form",
        model=BallScene,
        axes=axes,
        plan=plan,
        run=run,
        record=BallRecord,
        figures=("ball-pressure",),
        headline=("load_N", "approach_nm"),
    )
)
