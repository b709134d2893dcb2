"""The validation page's section on the shape of wear pieces: from the stored result of `piece_shapes`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from reports.builder import table, text
from reports.experiments import kept
from reports.validation_values import SLIGHT

NAME = "piece_shapes"
SOURCE = {10.0: (442.0, 245.0, 197.0), 2.5: (267.0, 161.0, 151.0)}
"""Length, width and thickness [nm] of the source's model at each load [N]."""


def body() -> str:
    """Return the section's text and table; or how to make its result."""
    try:
        found = kept.found(NAME)
    except FileNotFoundError:
        return text(f"Not run: python -m reports.experiments.{NAME}")
    return (
        text(
            "Width of the steel pieces at 10 N lies outside the window. The source defines length and width as the "
            'longest and the smallest dimension "of the square which encompasses the particle" (section B 2.5). That '
            "is a rectangle, along the axes of the map or turned. It does not say how pieces that touch at an edge or "
            "a corner count, nor by what its tables weight. The sizes of its microscope point to number: 747 / 541 / "
            "145 nm make a box of 0.06 um3, more than the sphere of its mean radius by number, 175 nm (0.02 um3), and "
            "less than that of its mean by volume, 358 nm (0.19 um3). By number ours are further from its model than "
            "by volume."
        )
        + table(
            ("length and width", "neighbours", "mean by", "10 N (nm)", "2.5 N (nm)", f"all within {SLIGHT:.2f}"),
            list(_lines(found)),
            caption="Length / width / thickness of one surface, last 50 of 200 cycles; the source's model: "
            "442 / 245 / 197 at 10 N, 267 / 161 / 151 at 2.5 N.",
        )
        + text(
            "Neither rectangle is within by any weight with 6 neighbours. Those that are within take a definition, a "
            "weight or a connectivity of which the source says nothing, so the convention of this page stays: "
            "rectangle along the axes, 6 neighbours, mean by volume. Seen from above, as on a microscope's plate, "
            "pieces show these lengths and widths: by volume their thickness is the smallest side."
        )
        + kept.age(NAME)
    )


def _lines(found: list[dict[str, Any]]) -> Iterator[tuple[str, ...]]:
    """Yield a line for each definition, connectivity and weight, with the sizes at both loads."""
    sizes = {(row["load_N"], row["connectivity"]): row["sizes_nm"] for row in found}
    for name in found[0]["sizes_nm"]:
        for neighbours in (6, 18):  # 26 differ from 18 by less than 1 nm
            for weight in ("number", "area", "volume"):
                values = {load: sizes[load, neighbours][name][weight] for load in SOURCE}
                inside = all(is_within(values[load], SOURCE[load]) for load in SOURCE)
                shown = (" / ".join(f"{value:.0f}" for value in values[load]) for load in SOURCE)
                yield name, str(neighbours), weight, *shown, "yes" if inside else "no"


def is_within(values: Any, wanted: tuple[float, ...]) -> bool:
    """Return True if each size lies within the factor that lines on sizes accept."""
    return all(one / SLIGHT < value < one * SLIGHT for value, one in zip(values, wanted, strict=True))
