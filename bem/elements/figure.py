"""Figure of all contacts of a machine element: load and pressure, film, friction and temperatures over the path.

Marked points, A to E of a gear pair, are lines through all panels.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from bem.elements.element import Element
from bem.elements.model import LEAST_ASPERITY_SHARE
from bem.elements.plain_bush import PlainBushModel, sliding_to_depth, worn_out_depth
from bem.elements.running import Running, friction_sums
from bem.physical_constants import ZERO_CELSIUS

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def draw_element(element: Element, runs: Sequence[Running], path: Path) -> None:
    """Write the figure of an element: .png, .pdf or .svg.

    runs : solved films; points of the lower panels, none where it is empty.
    """
    figure = element_figure(element, runs)
    figure.savefig(path, format=path.suffix[1:].lower(), dpi=150)


def element_figure(element: Element, runs: Sequence[Running]) -> Figure:
    """Return the figure of an element; parameters as in `draw_element`."""
    from bem.plots.backend import load_matplotlib
    from bem.plots.style import style

    load_matplotlib()
    from matplotlib.figure import Figure

    known = [one for one in runs if one.converged]
    if isinstance(element.model, PlainBushModel):
        with style():
            return _bush(element, element.model, known, Figure(figsize=(7.2, 4.6), layout="constrained"))
    with style():
        figure = Figure(figsize=(7.2, 7.8 if known else 4.6), layout="constrained")
        panels = figure.subplots(4 if known else 2, 1, sharex=True)
        _loads(element, panels[0])
        _films(element, known, panels[1])
        if known:
            _friction(element, known, panels[2])
            _temperatures(element, known, panels[3])
        degrees = element.found.along_unit == "rad"
        panels[-1].set_xlabel("angle (deg)" if degrees else f"{element.found.along} from C (mm)")
        for panel in panels:
            for place in element.found.marks.values():
                panel.axvline(1e3 * place, color="0.6", linewidth=0.7, zorder=0)
        for name, place in element.found.marks.items():
            panels[0].annotate(
                name, (1e3 * place, 1.0), xycoords=("data", "axes fraction"), xytext=(0, 3),
                textcoords="offset points", ha="center",
            )  # fmt: skip
        figure.suptitle(
            f"{element.model.name}: {element.model.description or element.model.element}", fontsize="medium"
        )
    return figure


def _bush(element: Element, model: PlainBushModel, runs: Sequence[Running], figure: Figure) -> Figure:
    """Draw the pressure of a bush beside the equivalent cylinder's, and with a wear rate the worn depth over time.

    Where the film carries the load the curve of wear says that it is of rubbing surfaces.
    """
    import numpy as np

    found, flat = model.shaft_contact, model.cylinder
    worn = bool(model.specific_wear_rate)
    panels = figure.subplots(1, 2 if worn else 1, squeeze=False)[0]
    half = math.degrees(found.half_angle)
    at = np.concatenate([[-half], np.degrees(found.angles[::-1]), [half]])
    panels[0].plot(at, 1e-6 * np.concatenate([[0.0], found.pressures[::-1], [0.0]]), color="C0", label="shaft in bush")
    flat_at = np.degrees(flat.angles) * model.bodies.cylinder.radius / model.bodies.radius
    panels[0].plot(flat_at, 1e-6 * flat.pressures, "--", color="0.5", label="equivalent cylinder on a flat")
    panels[0].axhline(1e-6 * model.mean_pressure, color="C1", linewidth=0.9, label="mean, F/(d L)")
    panels[0].set_xlabel("angle from the load line (deg)")
    panels[0].set_ylabel("pressure (MPa)")
    panels[0].set_ylim(bottom=0)
    panels[0].legend(frameon=False, fontsize="small")
    if worn:
        depth = np.linspace(0.0, worn_out_depth(model)[0], 61)
        hours = np.array([sliding_to_depth(model, one) for one in depth]) / (3600 * model.sliding_speed)
        panels[1].plot(hours, 1e6 * depth, color="C0")
        panels[1].set_xlabel("time (h)")
        panels[1].set_ylabel("worn depth at the load line (um)")
        shares = [one.asperity_share for one in runs if one.asperity_share is not None]
        if shares and max(shares) < LEAST_ASPERITY_SHARE:
            panels[1].set_title("if the surfaces rub; here a film carries the load", fontsize="small")
        panels[1].set_xlim(left=0)
        panels[1].set_ylim(bottom=0)
    figure.suptitle(f"{model.name}: {model.description or model.element}", fontsize="medium")
    return figure


_HEADROOM = 1.06
"""Upper end of an axis from zero over the highest value, so that markers stand clear of the frame."""


def _from_zero(axes: Any) -> None:
    """Let an axis begin at zero and leave room for markers above the highest value."""
    values = [float(value) for line in axes.lines for value in line.get_ydata()]
    highest = max((value for value in values if math.isfinite(value)), default=0.0)
    axes.set_ylim(0, _HEADROOM * highest if highest > 0 else None)


def _abscissa(element: Element, value: float) -> float:
    return math.degrees(value) if element.found.along_unit == "rad" else 1e3 * value


def _branches(element: Element, contacts: Sequence[Any]) -> dict[str, list[int]]:
    """Return indices of contacts by ring of a bearing, or all under one empty name, in the order of their places."""
    found: dict[str, list[int]] = {}
    for i, one in enumerate(contacts):
        found.setdefault(one.path, []).append(i)
    return {name: sorted(rows, key=lambda i: contacts[i].place) for name, rows in found.items()}


def _broken(contacts: Sequence[Any], rows: Sequence[int], element: Element, values: Sequence[float]) -> tuple[Any, Any]:
    """Return abscissas and values of a curve over solved contacts, with a gap over places without a steady film."""
    against = [one.place for one in element.found.contacts if abs(one.slide_roll_ratio) > 2]
    x, y = [], []
    for i, after in zip(rows, [*rows[1:], None], strict=True):
        x.append(_abscissa(element, contacts[i].place))
        y.append(values[i])
        if after is not None and any(contacts[i].place < place < contacts[after].place for place in against):
            x.append(math.nan)
            y.append(math.nan)
    return x, y


def _loads(element: Element, axes: Any) -> None:
    """Draw load and Hertz pressure over the path."""
    contacts = element.found.contacts
    right = axes.twinx()
    for number, (ring, rows) in enumerate(_branches(element, contacts).items()):
        x = [_abscissa(element, contacts[i].place) for i in rows]
        dash = ("-", "--")[number % 2]
        axes.plot(x, [1e-9 * contacts[i].hertz(element.modulus).maximum_pressure for i in rows], dash, color="C0",
                  label=ring or None)  # fmt: skip
        right.plot(x, [1e-3 * contacts[i].carried for i in rows], dash, color="C1")
    axes.set_ylabel("Hertz pressure (GPa)", color="C0")
    right.set_ylabel("load (kN)", color="C1")
    _from_zero(axes)
    _from_zero(right)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(frameon=False, fontsize="small")


def _films(element: Element, known: Sequence[Running], axes: Any) -> None:
    """Draw minimum films, and marks of the path."""
    columns, contacts = element.columns(), element.found.contacts
    if "minimum_film [m]" not in columns:
        axes.set_ylabel("no oil is given")
        return
    scale = element.model.rms_roughness
    key, factor = ("minimum_film [m]", 1e9) if scale is None else ("film_over_roughness", 1.0)
    for number, rows in enumerate(_branches(element, contacts).values()):
        x = [_abscissa(element, contacts[i].place) for i in rows]
        axes.plot(x, [factor * columns[key][i] for i in rows], ("-", "--")[number % 2], color="0.5",
                  label=None if number else "formula")  # fmt: skip
    if known:
        x = [_abscissa(element, one.contact.place) for one in known]
        axes.plot(x, [one.minimum_film * (1e9 if scale is None else 1 / scale) for one in known], ".", color="C0",
                  label="solved")  # fmt: skip
    axes.set_ylabel("minimum film (nm)" if scale is None else "lambda ratio")
    _from_zero(axes)
    axes.legend(frameon=False, fontsize="small")


def _friction(element: Element, known: Sequence[Running], axes: Any) -> None:
    """Draw friction over the path."""
    right = axes.twinx()
    contacts = [one.contact for one in known]
    sums = [friction_sums(one, known) for one in contacts]
    friction, power = [abs(one[0]) for one in sums], [one[1] for one in sums]
    for number, rows in enumerate(_branches(element, contacts).values()):
        dash = ("-", "--")[number % 2]
        axes.plot(*_broken(contacts, rows, element, friction), dash, marker=".", color="C0")
        right.plot(*_broken(contacts, rows, element, power), dash, marker=".", color="C1")
    _from_zero(axes)
    axes.set_ylabel("friction coefficient\n(magnitude)", color="C0")
    right.set_ylabel("friction power (W)", color="C1")
    _from_zero(right)


def _temperatures(element: Element, known: Sequence[Running], axes: Any) -> None:
    """Draw temperatures of oil and surfaces over the path."""
    contacts = [one.contact for one in known]
    for number, rows in enumerate(_branches(element, contacts).values()):
        dash = ("-", "--")[number % 2]
        for name, values, colour in (
            ("oil, mean in the contact", [one.oil for one in known], "C0"),
            ("surface, highest", [one.surface for one in known], "C3"),
        ):
            if all(value is not None for value in values):
                celsius = [value - ZERO_CELSIUS for value in values if value is not None]
                axes.plot(*_broken(contacts, rows, element, celsius), dash, marker=".", color=colour,
                          label=None if number else name)  # fmt: skip
    axes.set_ylabel("temperature (°C)")
    if axes.get_legend_handles_labels()[0]:
        axes.legend(frameon=False, fontsize="small")
