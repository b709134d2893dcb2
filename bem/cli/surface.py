"""`bem surface`: generate, read, describe, plot."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

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
    try:
        surface = Surface.generate(grid, **asked)
    except InputError as error:
        raise InputError([message.removeprefix("generate_surface: ") for message in error.messages]) from None
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
    surface = _read(file, detrend, fill, channel, spacing, height_unit, despike, level_lines)
    path = write_surface(out, surface)
    _show(surface, file.name)
    print_written(path)


def describe(
    file: FileArgument,
    detrend: DetrendOption = None,
    fill: FillOption = True,
    channel: ChannelOption = None,
    spacing: SpacingOption = None,
    height_unit: UnitOption = None,
    despike: SpikesOption = None,
    level_lines: LinesOption = False,
    json: Annotated[bool, typer.Option("--json", help="As JSON, in SI units.")] = False,
) -> None:
    """Print height, slope and correlation of a surface."""
    surface = _read(file, detrend, fill, channel, spacing, height_unit, despike, level_lines)
    if json:
        import dataclasses
        import json as writer
        import math

        from bem.surfaces import describe_asperities, describe_surface, material_ratio
        from bem.surfaces.self_affine import self_affine_fit_of_map

        described = describe_surface(surface.heights, surface.spacing, periodic=_periodic(surface))
        values = dataclasses.asdict(described)
        curve = material_ratio(surface.heights)
        values |= {name: getattr(curve, name) for name in ("Sk", "Spk", "Svk", "Smr1", "Smr2")}
        fit = self_affine_fit_of_map(surface.heights, surface.spacing, periodic=_periodic(surface))
        if fit is not None:
            values |= {f"spectrum_{name}": value for name, value in dataclasses.asdict(fit).items()}
        if min(surface.shape) >= 3:
            asperities = describe_asperities(surface, periodic=_periodic(surface))
            values |= {f"asperity_{name}": value for name, value in dataclasses.asdict(asperities).items()}
        figures = {k: None if math.isnan(v) else v for k, v in values.items()}
        shape = {"file": str(file), "shape": surface.shape, "spacing": surface.spacing}
        print(writer.dumps({**shape, **figures, "metadata": dict(surface.metadata)}, default=str, ensure_ascii=False))
        return
    _show(surface, file.name)


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
    surface = _read(file, detrend, fill, channel, spacing, height_unit, despike, level_lines)
    from bem.plots.surface import draw_surface

    draw_surface(surface, out, periodic=_periodic(surface))
    print_written(out)


def _read(
    file: Path,
    detrend: str | None,
    fill: bool,
    channel: str | None,
    spacing: str | None,
    height_unit: str | None,
    despike: float | None,
    level_lines: bool,
) -> Surface:
    from bem.cli._quantity import pair_of_lengths
    from bem.surfaces import read_surface

    return read_surface(
        file,
        # a plain map is a surface already: levelling it again would change its statistics and open its seams
        detrend=detrend or ("none" if file.suffix.lower() == ".npz" else "plane"),
        fill=fill,
        channel=int(channel) if channel is not None and channel.isdigit() else channel,
        spacing=pair_of_lengths(spacing, "--spacing"),
        height_unit=height_unit,
        despike=despike,
        level_lines=level_lines,
    )


def _periodic(surface: Surface) -> tuple[bool, bool]:
    known = surface.metadata.get("periodic")
    return (bool(known[0]), bool(known[1])) if isinstance(known, list | tuple) and len(known) == 2 else (False, False)


def _show(surface: Surface, name: str) -> None:
    import math

    from bem.cli._terminal import table
    from bem.quantities import si
    from bem.surfaces import describe_surface
    from bem.surfaces.filter import count_spikes

    d = describe_surface(surface.heights, surface.spacing, periodic=_periodic(surface))
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
        ("Sq, rms height", metres(d.Sq)),
        ("Sa, mean height", metres(d.Sa)),
        ("Sz, peak to valley", metres(d.Sz)),
        ("Ssk, skewness", f"{d.Ssk:.4g}"),
        ("Sku, kurtosis", f"{d.Sku:.4g}"),
        ("Sdq, rms slope", f"{d.Sdq:.4g}"),
        ("autocorrelation length, x", metres(d.autocorrelation_length_x)),
        ("autocorrelation length, y", metres(d.autocorrelation_length_y)),
        *_functional_rows(surface),
    ]
    for key, words in (("missing_points", "points filled"), ("spikes", "spikes taken out")):
        if surface.metadata.get(key):
            rows.append((words, str(surface.metadata[key])))
    table(("figure", "value"), rows, title=name)
    filled = float(surface.metadata.get("missing_points", 0) or 0) / surface.heights.size
    if filled > 0.1:
        print(
            f"{filled:.0%} of the points were missing and filled smoothly: the real surface is rougher. Take a part "
            "without holes, or measure again."
        )
    spikes = 0 if surface.metadata.get("spikes") else count_spikes(surface.heights, surface.spacing)
    if spikes:
        print(
            f"{spikes} points stand out of their neighbourhood by more than 6 standard deviations: spikes of the "
            "instrument? --despike 6 removes them."
        )


def _functional_rows(surface: Surface) -> list[tuple[str, str]]:
    """Return rows on the material ratio curve, the asperities and the spectrum."""
    import math

    from bem.quantities import si
    from bem.surfaces import describe_asperities, material_ratio
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
        asperities = describe_asperities(surface, periodic=_periodic(surface))
        if math.isfinite(asperities.radius):
            rows += [
                ("asperities per mm² (summits of cells)", f"{asperities.density * 1e-6:.4g}"),
                ("asperity radius, mean", si(asperities.radius, "m", digits=4)),
                ("asperity heights, standard deviation", si(asperities.rms_height, "m", digits=4)),
            ]
        rows.append(("bandwidth, Nayak's alpha", f"{asperities.bandwidth:.4g}"))
    fit = self_affine_fit_of_map(surface.heights, surface.spacing, periodic=_periodic(surface))
    if fit is not None:
        decades = f"{fit.misfit:.2f} decades off at rms"
        between = f"{si(fit.shortest_wavelength, 'm', digits=3)} to {si(fit.longest_wavelength, 'm', digits=3)}"
        if 0 < fit.hurst < 1:
            rows.append(("Hurst exponent", f"{fit.hurst:.2f} ± {fit.hurst_error:.2f} ({between}; {decades})"))
        else:
            slope = -2 * (1 + fit.hurst)
            rows.append(("spectrum", f"not self-affine: falls with wavenumber to the power {slope:.1f} ({between})"))
        if math.isfinite(fit.rolloff_wavelength):
            rows.append(("roll-off wavelength", si(fit.rolloff_wavelength, "m", digits=3)))
    return rows
