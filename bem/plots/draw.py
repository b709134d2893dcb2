"""Figures of a run as files."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bem.errors import InputError, ResultsError
from bem.plots.cases import axes_of, case_shown, case_words, first_case, first_figures
from bem.plots.figures import FigureKind, all_figures
from bem.results.arrays import LEFT_OUT, Arrays
from bem.results.atomic import replacing
from bem.results.read import FinishedRun
from bem.scenes.validate import nearest
from bem.startup.lazy import collecting

FORMATS = ("png", "pdf", "svg")


@dataclass(frozen=True)
class _Seen:
    """A run as figures see it: its arrays without xarray, which nobody waits for to look at a picture."""

    path: Path
    scene: dict[str, Any]
    summary: dict[str, Any]
    dataset: Arrays


def _seen(run: Any) -> Any:
    return _Seen(run.path, run.scene, run.summary, run.arrays) if isinstance(run, FinishedRun) else run


_OF_ANY_KIND = ("figures-over-keys",)


def _for(run: Any, kind: FigureKind) -> Any:
    """The run as a figure knows it: all cases, or the first one."""
    if kind.all_cases or not axes_of(run.dataset):
        return run
    return _Seen(run.path, run.scene, first_figures(run.summary), first_case(run.dataset))


def _case_of(run: Any, kind: FigureKind) -> str:
    """Describe the case that a figure shows; empty where it shows all cases, or where there is one."""
    several = bool(axes_of(run.dataset)) and not kind.all_cases
    return case_shown(run.dataset, run.summary.get("kind", ""), kind.needs) or (
        case_words(run.dataset) if several else ""
    )


@dataclass(frozen=True)
class Drawn:
    """A figure that is on disk."""

    kind: FigureKind
    paths: tuple[Path, ...]


def draw_all(
    run: Any,
    names: Sequence[str],
    folder: Path,
    formats: Sequence[str] = ("png",),
    on_failure: Callable[[str, Exception], None] | None = None,
) -> list[Drawn]:
    """Draw those of the named figures that fit the run, in that order.

    With `on_failure` a figure that cannot be drawn is reported to it by name and left out: hours of results must not be
    lost to a picture. Files that cannot be written are a ResultsError all the same.
    """
    known = all_figures()
    run = _seen(run)
    wanted = [*names, *(extra for extra in _OF_ANY_KIND if extra not in names)]

    drawn = []
    for name in wanted:
        kind = known[name]
        try:
            if kind.fits(_for(run, kind)):
                drawn.append(draw(run, kind, folder, formats))
        except ResultsError:
            raise
        except Exception as error:
            if on_failure is None:
                raise
            on_failure(name, error)
    return drawn


def load_what_draws() -> None:
    """Load the modules that every figure needs, for processes that wait meanwhile."""
    for name in ("bem.plots.style", "matplotlib.backends.backend_agg", "matplotlib.figure", "bem.plots.pictures"):
        importlib.import_module(name)


def draw(
    run: Any,
    kind: FigureKind,
    folder: Path,
    formats: Sequence[str] = ("png",),
    size: tuple[float, float] | None = None,
) -> Drawn:
    """Draw one figure in the given formats and size [inch]."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    from bem.plots.pictures import DOTS, settle, write
    from bem.plots.style import name_case, named_axes, said_beyond, style

    whole = _seen(run)
    run = _for(whole, kind)
    with style(), named_axes(run.dataset, run.scene), collecting():
        # at the dots of the file from the start: sizes of texts that the layout asks for serve the picture too
        figure = Figure(figsize=size or kind.size, dpi=DOTS, layout="constrained")
        FigureCanvasAgg(figure)
        kind.draw(run, figure)
        if not figure.get_suptitle():
            name_case(figure, _case_of(whole, kind))
        said_beyond(figure, run.summary)
        if size is not None:  # what is asked for goes before what the maps need
            figure.set_size_inches(size)
        settle(figure, sized=size is not None)
        paths = write(figure, folder, kind.name, formats)
        if kind.animate is not None:
            path = folder / f"{kind.name}.gif"
            with replacing(path) as temporary:
                kind.animate(run, temporary)
            paths.append(path)
    return Drawn(kind, tuple(paths))


def figure_kind(run: Any, name: str) -> FigureKind:
    """The figure of that name, if the run has what it needs.

    Raises
    ------
    InputError : no such figure, or not from this run.
    """
    known, run = all_figures(), _seen(run)
    fitting = [kind.name for kind in known.values() if kind.fits(_for(run, kind))]
    if name not in known:
        raise InputError(
            f'--figure "{name}": no such figure{nearest(name, fitting)}; allowed for this run: {", ".join(fitting)}'
        )
    lacking = set(str(run.dataset.attrs.get(LEFT_OUT, "")).split()).intersection(known[name].needs)
    if lacking:
        raise InputError(
            f'--figure "{name}": cannot be drawn from this point of a sweep that was run without --fields: it has no '
            f"{' and no '.join(sorted(lacking))}; allowed: bem run with its scene.toml, bem sweep --resume --fields, "
            f"or {', '.join(fitting)}"
        )
    if name not in fitting:
        raise InputError(f'--figure "{name}": cannot be drawn from this run; allowed: {", ".join(fitting)}')
    return known[name]
