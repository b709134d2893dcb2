"""`bem surface`: generate, read, describe, plot."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from bem.cli._map_files import Reading, options_of, read_map

if TYPE_CHECKING:
    from bem.surfaces import Surface

FileArgument = Annotated[
    Path,
    typer.Argument(
        metavar="FILE",
        help="An instrument's file, or a map as .npz or table; the package's own are example/ground-disk.al3d and "
        "example/polished-pin.x3p.",
    ),
]
DetrendOption = Annotated[
    str | None, typer.Option(help="plane, curvature or none; plane, and none for an .npz, if not given.")
]
FillOption = Annotated[bool, typer.Option("--fill/--no-fill", help="Fill missing points, or refuse a file with some.")]
ChannelOption = Annotated[str | None, typer.Option(help="Name or number of the channel; the file's own default.")]
SpacingOption = Annotated[
    str | None, typer.Option(help='Distance of points where the file does not say, "100 nm" or "100 nm,200 nm".')
]
SpikesOption = Annotated[
    float | None, typer.Option(help="Take out points further from their neighbours than so many standard deviations.")
]
LinesOption = Annotated[bool, typer.Option("--level-lines", help="Remove the offset of each scan line too.")]
UnitOption = Annotated[str | None, typer.Option(help="Unit of the heights where the file does not say, such as nm.")]


def register(app: typer.Typer) -> None:
    """Add the commands."""
    group = typer.Typer(name="surface", help="Generate, read, describe and plot surfaces.", no_args_is_help=True)
    group.command()(generate)
    group.command()(read)
    group.command()(describe)
    group.command()(plot)
    app.add_typer(group)


def generate(
    out: Annotated[Path, typer.Argument(metavar="OUT", help="File to write, .npz.")],
    cells: Annotated[str, typer.Option(help="Cells along x and y, such as 512 or 512,256.")],
    spacing: Annotated[str, typer.Option(help='Cell side, such as "100 nm", or two.')],
    rms_height: Annotated[str, typer.Option(help='Sq, such as "50 nm".')],
    seed: Annotated[int, typer.Option(min=0, help="The same seed gives the same bits.")] = 0,
    correlation_length: Annotated[
        str | None, typer.Option(help="Where the autocorrelation falls to 1/e; two for unequal axes.")
    ] = None,
    autocorrelation: Annotated[str, typer.Option(help="gaussian or exponential.")] = "gaussian",
    hurst: Annotated[float | None, typer.Option(help="Hurst exponent of a self-affine surface instead.")] = None,
    rolloff_wavelength: Annotated[str | None, typer.Option(help="Flat spectrum above this wavelength.")] = None,
    cutoff_wavelength: Annotated[str | None, typer.Option(help="No waves below this wavelength.")] = None,
    skewness: Annotated[float, typer.Option(help="Ssk.")] = 0.0,
    kurtosis: Annotated[float, typer.Option(help="Sku; 3 is Gaussian.")] = 3.0,
) -> None:
    """Generate a periodic random surface."""
    from bem.cli._quantity import length, new_file, pair_of_cells, pair_of_lengths
    from bem.cli._terminal import print_written
    from bem.errors import InputError
    from bem.grid import Grid
    from bem.surfaces import Surface, write_surface

    new_file(out, "OUT", (".npz",))
    sides = pair_of_lengths(spacing, "--spacing")
    correlation = pair_of_lengths(correlation_length, "--correlation-length")
    assert sides is not None
    grid = Grid(pair_of_cells(cells, "--cells"), sides, periodic=(True, True))
    asked = {
        "rms_height": length(rms_height, "--rms-height"),
        "seed": seed,
        "correlation_length": correlation,
        "autocorrelation": autocorrelation,
        "hurst": hurst,
        "rolloff_wavelength": length(rolloff_wavelength, "--rolloff-wavelength"),
        "cutoff_wavelength": length(cutoff_wavelength, "--cutoff-wavelength"),
        "skewness": skewness,
        "kurtosis": kurtosis,
    }
    if (correlation is None) == (hurst is None):
        raise InputError("give exactly one of --correlation-length and --hurst")
    with options_of("generate_surface"):
        surface = Surface.generate(grid, **asked)
    path = write_surface(out, surface)
    _show(surface, path.name)
    print_written(path)


def read(
    file: FileArgument,
    out: Annotated[Path, typer.Argument(metavar="OUT", help="File to write, .npz.")],
    detrend: DetrendOption = None,
    fill: FillOption = True,
    channel: ChannelOption = None,
    spacing: SpacingOption = None,
    height_unit: UnitOption = None,
    despike: SpikesOption = None,
    level_lines: LinesOption = False,
) -> None:
    """Read a measured surface, level it, fill what is missing and write it as a plain map in metres."""
    from bem.cli._quantity import new_file
    from bem.cli._terminal import print_written
    from bem.surfaces import write_surface

    new_file(out, "OUT", (".npz",))
    surface = read_map(file, Reading(detrend, fill, channel, spacing, height_unit, despike, level_lines))
    path = write_surface(out, surface)
    _show(surface, file.name, despike)
    print_written(path)


def describe(
    files: Annotated[
        list[Path],
        typer.Argument(
            metavar="FILE...",
            help="One file as `read` takes it, or several measurements of one surface: their means and scatter.",
        ),
    ],
    detrend: DetrendOption = None,
    fill: FillOption = True,
    channel: ChannelOption = None,
    spacing: SpacingOption = None,
    height_unit: UnitOption = None,
    despike: SpikesOption = None,
    level_lines: LinesOption = False,
    json: Annotated[bool, typer.Option("--json", help="As JSON, in SI units.")] = False,
    figure: Annotated[
        Path | None,
        typer.Option(
            metavar="OUT",
            help="Draw, as .png, .pdf or .svg: one surface as `plot` does, of several the averaged spectrum.",
        ),
    ] = None,
) -> None:
    """Print height, slope and correlation of a surface; of several measurements their means and scatter.

    \b
    Examples:
      bem surface describe disk.al3d
      bem surface describe spot1.al3d spot2.al3d spot3.al3d --figure spectrum.png
    """
    from bem.cli._quantity import new_file
    from bem.cli._terminal import print_written

    if figure is not None:
        new_file(figure, "--figure", (".png", ".pdf", ".svg"))
    surfaces = _read_several(files, Reading(detrend, fill, channel, spacing, height_unit, despike, level_lines))
    if len(files) == 1:
        _print_json(files[0], surfaces[0]) if json else _show(surfaces[0], files[0].name, despike)
    else:
        _show_measurements(files, surfaces, despike, json=json)
    if figure is None:
        return
    from bem.plots.surface import draw_measurements, draw_surface
    from bem.surfaces.measurements import periodic_axes

    if len(files) == 1:
        draw_surface(surfaces[0], figure, periodic=periodic_axes(surfaces[0]))
    else:
        draw_measurements(surfaces, [file.name for file in files], figure)
    if not json:
        print_written(figure)


def _print_json(file: Path, surface: Surface) -> None:
    """Print all parameters of a surface as JSON."""
    import json as writer

    from bem.surfaces.measurements import parameters_of

    shape = {"file": str(file), "shape": surface.shape, "spacing": surface.spacing}
    found = {**shape, **{name: _finite(value) for name, value in parameters_of(surface).items()}}
    print(writer.dumps({**found, "metadata": dict(surface.metadata)}, default=str, ensure_ascii=False))


def _finite(value: float) -> float | None:
    """Return a number that JSON knows."""
    import math

    return value if math.isfinite(value) else None


def plot(
    file: FileArgument,
    out: Annotated[Path, typer.Argument(metavar="OUT", help="Figure to write: .png, .pdf or .svg.")],
    detrend: DetrendOption = None,
    fill: FillOption = True,
    channel: ChannelOption = None,
    spacing: SpacingOption = None,
    height_unit: UnitOption = None,
    despike: SpikesOption = None,
    level_lines: LinesOption = False,
) -> None:
    """Draw a surface: heights, their distribution, autocorrelation and spectrum."""
    from bem.cli._quantity import new_file
    from bem.cli._terminal import print_written

    new_file(out, "OUT", (".png", ".pdf", ".svg"))
    surface = read_map(file, Reading(detrend, fill, channel, spacing, height_unit, despike, level_lines))
    from bem.plots.surface import draw_surface
    from bem.surfaces.measurements import periodic_axes

    draw_surface(surface, out, periodic=periodic_axes(surface))
    print_written(out)


def _read_several(files: list[Path], options: Reading) -> list[Surface]:
    """Read maps; spacing and unit of heights are for the files that do not say them, if there are any."""
    from bem.surfaces.read import states_scale

    stated = [False] * len(files)
    if len(files) > 1 and (options.spacing is not None or options.height_unit is not None):
        stated = [states_scale(file) for file in files]
        stated = [one and not all(stated) for one in stated]
    own_scale = replace(options, spacing=None, height_unit=None)
    return [read_map(file, own_scale if own else options) for file, own in zip(files, stated, strict=True)]


def _show(surface: Surface, name: str, despike: float | None = None) -> None:
    """Print a surface as a table, below what makes it doubtful; `despike` : with which it was read."""
    import math

    from bem.cli._terminal import table
    from bem.quantities import si
    from bem.surfaces import describe_surface
    from bem.surfaces.finite_size import FEWEST_PATCHES
    from bem.surfaces.measurements import finite_size_of, periodic_axes

    d = describe_surface(surface.heights, surface.spacing, periodic=periodic_axes(surface))
    _doubts(surface, despike)
    error = finite_size_of(surface)
    told = surface.metadata.get("spacing_in_file")

    def metres(value: float) -> str:
        if math.isnan(value):
            return "beyond half the map"
        return si(value, "m", digits=4)

    rows = [
        ("cells", f"{surface.shape[0]} x {surface.shape[1]}"),
        ("spacing", " x ".join(metres(s) for s in surface.spacing)),
        *([] if told is None else [("spacing in the file, not taken", " x ".join(metres(s) for s in told))]),
        ("size", " x ".join(metres(s) for s in surface.lengths)),
        (
            "Sq, rms height",
            " ± ".join(
                _written(value, _LENGTH, digits, _unit_of(d.Sq))
                for value, digits in ((d.Sq, 4), (error.Sq, 2))
                if digits == 4 or value > 0
            ),
        ),
        ("Sa, mean height", metres(d.Sa)),
        ("Sz, peak to valley", metres(d.Sz)),
        ("Ssk, skewness", f"{d.Ssk:.4g}"),
        ("Sku, kurtosis", f"{d.Sku:.4g}"),
        ("Sdq, rms slope", f"{d.Sdq:.4g}" + (f" ± {error.Sdq:.2g}" if error.Sdq > 0 else "")),
        ("autocorrelation length, x", metres(d.autocorrelation_length_x)),
        ("autocorrelation length, y", metres(d.autocorrelation_length_y)),
        *_functional_rows(surface),
    ]
    if surface.metadata.get("missing_points"):
        rows.append(("points filled", str(surface.metadata["missing_points"])))
    if surface.metadata.get("spikes") or despike is not None:
        rows.append(("spikes taken out", str(surface.metadata.get("spikes", 0))))
    table(("figure", "value"), rows, title=name)
    if any(words == _HURST and "±" in value for words, value in rows):
        print(f"± of the {_HURST}: standard deviation over maps of this size, by the scatter of the spectrum's rings.")
    if error.Sq > 0:
        patches = f"the {error.patches:.0f} independent patches" if error.patches >= 1.5 else "fewer than two patches"
        print(f"± of Sq and Sdq: scatter of maps of this size (standard deviation), from {patches} that the map holds.")
        if error.patches < FEWEST_PATCHES:
            print(
                f"These are few patches (below {FEWEST_PATCHES}): lone heights or waves as long as the map decide Sq, "
                "and a larger map may have a larger one. Remove spikes, measure a larger area, or filter waviness out."
            )


def _doubts(surface: Surface, despiked: float | None, name: str = "") -> None:
    """Print what makes the figures doubtful: spikes, the unit of heights judged without them, and points filled.

    despiked : standard deviations with which the surface was read; None where spikes were left.
    name : of the file, where there are several.
    """
    from bem.cli._terminal import print_text
    from bem.quantities import counted
    from bem.scenes.maps import filled_note
    from bem.surfaces import describe_surface, despike, fill_missing
    from bem.surfaces.spikes import SPIKE, spikes_of

    heights, of = surface.heights, f"{name}: " if name else ""
    spikes = spikes_of(surface, despiked or SPIKE)
    if spikes:
        points = counted(spikes, "point")
        print_text(
            f"caution: {of}{points} more than {SPIKE:g} standard deviations off the neighbours: spikes of the "
            f"instrument? --despike {SPIKE:g} removes them."
            if despiked is None
            else f"caution: {of}{points} still more than {despiked:g} standard deviations off the neighbours after "
            "despiking. Look at them with bem surface plot."
        )
        heights = fill_missing(despike(surface.measured_heights, surface.spacing), surface.spacing)
    found = describe_surface(heights, surface.spacing)
    _print_doubt(found.Sq, found.Sdq, name)
    filled = filled_note(name, surface)
    if filled is not None:
        print_text(f"caution: {filled}")


def _print_doubt(rms_height: float, rms_slope: float, name: str = "") -> None:
    """Print a line where the unit of heights is doubted; `name` : of the file, where there are several."""
    from bem.cli._terminal import print_text
    from bem.scenes.maps import height_unit_note

    note = height_unit_note(name, rms_height, rms_slope)
    if note is not None:
        print_text(f"caution: {note}")


_HURST = "Hurst exponent"


def _functional_rows(surface: Surface) -> list[tuple[str, str]]:
    """Return rows on the material ratio curve, the asperities and the spectrum."""
    import math

    from bem.quantities import si
    from bem.surfaces import describe_asperities, material_ratio
    from bem.surfaces.measurements import periodic_axes
    from bem.surfaces.self_affine import self_affine_fit_of_map

    if surface.heights.size < 10 or not float(surface.heights.max()) > float(surface.heights.min()):
        return []
    curve = material_ratio(surface.heights)
    rows = [
        ("Sk, core height", si(curve.Sk, "m", digits=4)),
        ("Spk, reduced peak height", si(curve.Spk, "m", digits=4)),
        ("Svk, reduced valley depth", si(curve.Svk, "m", digits=4)),
        ("Smr1, Smr2, material ratios of the core", f"{curve.Smr1:.1%}, {curve.Smr2:.1%}"),
    ]
    if min(surface.shape) >= 3:
        asperities = describe_asperities(surface, periodic=periodic_axes(surface))
        if math.isfinite(asperities.radius):
            rows += [
                ("asperities per mm² (summits of cells)", f"{asperities.density * 1e-6:.4g}"),
                ("asperity radius, mean", si(asperities.radius, "m", digits=4)),
                ("asperity heights, standard deviation", si(asperities.rms_height, "m", digits=4)),
            ]
        rows.append(("bandwidth, Nayak's alpha", f"{asperities.bandwidth:.4g}"))
    fit = self_affine_fit_of_map(surface.heights, surface.spacing, periodic=periodic_axes(surface))
    if fit is not None:
        decades = f"rms misfit {fit.misfit:.2f} decades"
        between = f"{si(fit.shortest_wavelength, 'm', digits=3)} to {si(fit.longest_wavelength, 'm', digits=3)}"
        if fit.is_self_affine:
            rows.append((_HURST, f"{fit.hurst:.2f} ± {fit.hurst_error:.2f} ({between}; {decades})"))
            if math.isfinite(fit.rolloff_wavelength):
                rows.append(("roll-off wavelength", si(fit.rolloff_wavelength, "m", digits=3)))
            else:
                rows.append(("roll-off wavelength", "none: the spectrum rises up to the longest waves"))
        else:
            how = "falls more steeply" if fit.hurst >= 1 else "is flatter"
            rows.append(("spectrum", f"no power law of self-affine surfaces, q^-4 to q^-2: it {how} (q: wavenumber)"))
    return rows


_LENGTH, _NUMBER, _SHARE, _PER_AREA = "length", "number", "share", "per mm²"
_OF_SEVERAL = (
    ("Sq", "Sq, rms height", _LENGTH),
    ("Sa", "Sa, mean height", _LENGTH),
    ("Sz", "Sz, peak to valley", _LENGTH),
    ("Ssk", "Ssk, skewness", _NUMBER),
    ("Sku", "Sku, kurtosis", _NUMBER),
    ("Sdq", "Sdq, rms slope", _NUMBER),
    ("autocorrelation_length_x", "autocorrelation length, x", _LENGTH),
    ("autocorrelation_length_y", "autocorrelation length, y", _LENGTH),
    ("Sk", "Sk, core height", _LENGTH),
    ("Spk", "Spk, reduced peak height", _LENGTH),
    ("Svk", "Svk, reduced valley depth", _LENGTH),
    ("Smr1", "Smr1, material ratio of the peaks", _SHARE),
    ("Smr2", "Smr2, material ratio above the valleys", _SHARE),
    ("asperity_density", "asperities per mm² (summits of cells)", _PER_AREA),
    ("asperity_radius", "asperity radius, mean", _LENGTH),
    ("spectrum_hurst", "Hurst exponent", _NUMBER),
    ("spectrum_rolloff_wavelength", "roll-off wavelength", _LENGTH),
)
"""Parameters of several measurements: name, words, and how they are written."""


def _show_measurements(files: list[Path], surfaces: list[Surface], despike: float | None, *, json: bool) -> None:
    """Print means and scatter of several measurements, as a table or as JSON."""
    from bem.cli._terminal import table
    from bem.surfaces import describe_measurements

    found = describe_measurements(surfaces)
    if json:
        import json as writer

        parameters = {
            name: {"mean": _finite(one.mean), "scatter": _finite(one.scatter), "values": list(map(_finite, one.values))}
            for name, one in found.parameters.items()
        }
        spectrum = {
            name: list(map(_finite, getattr(found.spectrum, name).tolist()))
            for name in ("wavenumber", "density", "scatter", "measurements")
        }
        print(writer.dumps({"files": [str(file) for file in files], "parameters": parameters, "spectrum": spectrum}))
        return
    for file, surface in zip(files, surfaces, strict=True):
        _doubts(surface, despike, file.name)
    rows = []
    for name, words, how in _OF_SEVERAL:
        one = found.parameters.get(name)
        if one is None or not one.known.size:
            continue
        few = "" if one.known.size == len(files) else f" ({one.known.size} of {len(files)})"
        numbers = (one.mean, one.scatter, one.finite_size, float(one.known.min()), float(one.known.max()))
        unit = _unit_of(one.mean)
        rows.append(
            (words + few, *(_written(value, how, digits, unit) for value, digits in zip(numbers, _DIGITS, strict=True)))
        )
    head = ("figure", "mean", "scatter", "by finite size", "lowest", "highest")
    table(head, rows, title=f"{len(files)} measurements", right=(1, 2, 3, 4, 5))
    print("scatter: standard deviation of the measurements; by finite size: what maps of this size would have anyway.")
    height = found.parameters["Sq"]
    if height.scatter > _BEYOND_SIZE * height.finite_size:
        print(
            f"Sq scatters by {height.scatter / height.mean:.0%}, by the finite size of the maps alone by "
            f"{height.finite_size / height.mean:.0%}: the surface differs from place to place, or the measurements do."
        )
    fits = found.parameters.get("spectrum_hurst")
    if fits is not None and fits.known.size < len(files):
        print(
            f"Spectra of {len(files) - fits.known.size} of {len(files)} maps are not self-affine: Hurst exponent and "
            "roll-off wavelength leave them out."
        )
    spacings = sorted({max(one.spacing) for one in surfaces})
    if spacings[-1] > _SAME_SPACING * spacings[0]:
        from bem.quantities import si

        print(
            f"Points lie {si(spacings[0], 'm', digits=3)} to {si(spacings[-1], 'm', digits=3)} apart: slopes and "
            "asperities follow the spacing. Compare the spectra (--figure)."
        )


_DIGITS = (4, 2, 2, 4, 4)
"""Digits of mean, scatter, finite size, lowest, highest."""
_BEYOND_SIZE = 2.0
"""Scatter over standard error by finite size that chance exceeds in 5 % of cases with two maps, 2 % with three."""
_SAME_SPACING = 1.05
"""Ratio of spacings up to which slopes are compared without a word."""


def _unit_of(length: float) -> tuple[float, str]:
    """Return size [m] and name of the unit in which a length has one to three digits before the point."""
    units = ((1e-3, "mm"), (1e-6, "um"), (1e-9, "nm"))
    return next(((size, name) for size, name in units if abs(length) >= size), units[-1])


def _written(value: float, how: str, digits: int, unit: tuple[float, str]) -> str:
    """Return a parameter as a table has it, lengths in the unit of their mean; empty where it is unknown."""
    import math

    if not math.isfinite(value):
        return ""
    if how == _LENGTH:
        return f"{float(f'{value / unit[0]:.{digits}g}'):g} {unit[1]}"  # 160 nm, not 1.6e+02 nm
    if how == _SHARE:
        return f"{value:.1%}"
    return f"{value * (1e-6 if how == _PER_AREA else 1.0):.{digits}g}"
