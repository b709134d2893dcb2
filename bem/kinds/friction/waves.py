"""Roughness that the film flattens before it shares its load with it: the key `film.roughness` of the kind friction.

Verified in tests/scenes/test_flattened_friction_kind.py.
"""

from __future__ import annotations

from typing import Any, Literal

from bem.scenes.common import problem
from bem.scenes.keys import key
from bem.scenes.lubrication import FilmMeshScene
from bem.scenes.waves import WHERE


class FrictionFilmScene(FilmMeshScene):
    """Mesh of the oil film, and whether it flattens the roughness."""

    roughness: Literal["undeformed", "waves"] = key(
        "Roughness that the contact presses: undeformed, or as the film leaves it, by its waves (fast; smaller "
        "asperity load shares, closer to films with the roughness in Reynolds' equation).",
        "advanced",
        default="undeformed",
    )


def check_flattening(scene: Any) -> None:
    """Refuse what flattening by waves does not cover.

    Raises
    ------
    ValueError : with a message.
    """
    sharing = scene.sharing
    if all(body.surface.kind == "smooth" for body in (scene.lower, scene.upper)):
        raise problem(f"{WHERE} of smooth surfaces", "lower.surface or upper.surface other than smooth")
    if scene.supply is not None:
        raise problem(f"supply with {WHERE}, whose inlet is flooded", "no supply, or roughness undeformed")
    if any(body.build().layers for body in (scene.lower, scene.upper)):
        raise problem(f"coated bodies with {WHERE}, whose waves are of half-spaces", "bodies without layers")
    if not {"elastic", "capped"} >= set(sharing.models):
        raise problem(f"uncoupled asperities with {WHERE}", "models elastic and capped")
    if sharing.flow_factors != "off":
        raise problem(
            f'flow_factors = "{sharing.flow_factors}" with {WHERE}, which has the roughness in the film already',
            'flow_factors = "off"',
        )
    if scene.grid.periodic[0]:
        raise problem(f"a patch periodic along x with {WHERE}", "a patch that holds the contact, free along x")
    if any(sum(pair) <= 0 for pair in scene.speeds.build()):
        raise problem(f"a mean speed of zero or less with {WHERE}", "mean speeds along +x; turn the axes")
