"""The validation page's section on the area over which oil is counted: from the stored result of `patch_length`."""

from __future__ import annotations

from typing import Any

from reports.builder import table, text
from reports.experiments import kept

NAME = "patch_length"
WORDS = {"patch": "the whole patch", "loaded": "where the film is loaded", "hertz": "the nominal Hertz contact"}


def body() -> str:
    """Return the section's text and table; or how to make its result."""
    try:
        found = kept.found(NAME)
    except FileNotFoundError:
        return text(f"Not run: python -m reports.experiments.{NAME}")
    return (
        text(
            "Load sharing presses the rough surfaces together until their mean opening equals the mean film thickness. "
            "The thesis takes both means over an area A: the total area at eq. 7 of paper A, nominal Hertzian contact "
            "areas in its nomenclature. Scenes that redo the thesis take the whole patch (oil_volume patch). All "
            "others take the area where the film carries load, weighted by its pressure (loaded): flow through the "
            "loaded zone is conserved, while oil beside the contact comes and leaves freely. Over the nominal Hertz "
            "contact under the total load (hertz) the length of the patch has no influence."
        )
        + table(
            (
                "contact",
                "speed (m/s)",
                "oil counted over",
                "patch (um)",
                "friction",
                "film load (N)",
                "friction differs by",
            ),
            _lines(found),
            caption="The same surface on patches of several lengths.",
        )
        + kept.age(NAME)
    )


def _lines(found: list[dict[str, Any]]) -> list[tuple[str, ...]]:
    """Return a line for each contact, speed and area: values from the shortest patch to the longest."""
    lines = []
    for case in dict.fromkeys((row["contact"], row["speed"], row["oil_volume"]) for row in found):
        rows = [row for row in found if (row["contact"], row["speed"], row["oil_volume"]) == case]
        frictions = [row["friction"] for row in rows]
        apart = 100 * (max(frictions) - min(frictions)) / max(frictions)
        lines.append(
            (
                case[0],
                f"{case[1]:g}",
                WORDS[case[2]],
                ", ".join(f"{row['length_um']:.0f}" for row in rows),
                ", ".join(f"{friction:.4f}" for friction in frictions),
                ", ".join(f"{row['film_load']:.3g}" for row in rows),
                f"{apart:.2g} %",
            )
        )
    return lines
