"""`bem particles`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from bem.cli._map_files import Reading, options_of, read_map

if TYPE_CHECKING:
    from bem.particles import Particle


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(short_help="Find wear particles in a measured AFM height map.")(particles)


def particles(
    map_: Annotated[Path, typer.Argument(metavar="MAP", help="An AFM height map: any instrument's file, or .npz.")],
    threshold: Annotated[str, typer.Option(help="Height above the plate from which a particle is one.")] = "50 nm",
    background: Annotated[str, typer.Option(help="How to level: plane, curvature, offset or none.")] = "plane",
    level_lines: Annotated[bool, typer.Option("--level-lines", help="Level each scan line too.")] = False,
    separate: Annotated[
        float | None,
        typer.Option(help="Part touching particles whose pass is this share below the lower summit, such as 0.3."),
    ] = None,
    border: Annotated[str, typer.Option(help="Particles cut by the border: exclude or include.")] = "exclude",
    rectangle: Annotated[
        str, typer.Option(help="Length and width from the rectangle that is axis_aligned or of minimum_area.")
    ] = "axis_aligned",
    smallest_radius: Annotated[str, typer.Option(help="Leave out smaller equivalent radii.")] = "0 nm",
    channel: Annotated[str | None, typer.Option(help="Name or number of the file's channel.")] = None,
    spacing: Annotated[str | None, typer.Option(help="Distance of points where the file does not say.")] = None,
    height_unit: Annotated[str | None, typer.Option(help="Unit of heights where the file does not say.")] = None,
    table_out: Annotated[
        Path | None, typer.Option("--table", metavar="FILE", help="Write all particles as .csv.")
    ] = None,
    json_out: Annotated[Path | None, typer.Option("--json", metavar="FILE", help="Write the figures as .json.")] = None,
    figure_out: Annotated[
        Path | None, typer.Option("--figure", metavar="FILE", help="Draw map and distribution: .png, .pdf, .svg.")
    ] = None,
) -> None:
    """Find the wear particles in a measured AFM height map and print their sizes.

    \b
    Examples:
      bem particles plate.spm
      bem particles plate.npz --threshold "30 nm" --table particles.csv --figure particles.png
    """
    from bem.cli._quantity import length, new_file
    from bem.cli._terminal import print_written
    from bem.particles import particles_from_height_map

    for path, option, endings in (
        (table_out, "--table", (".csv",)),
        (json_out, "--json", (".json",)),
        (figure_out, "--figure", (".png", ".pdf", ".svg")),
    ):
        if path is not None:
            new_file(path, option, endings)
    height = length(threshold, "--threshold")
    smallest = length(smallest_radius, "--smallest-radius")
    assert height is not None
    assert smallest is not None
    surface = read_map(map_, Reading("none", True, channel, spacing, height_unit, None, False))
    with options_of("particles_from_height_map"):
        found = particles_from_height_map(
            surface.heights,
            surface.spacing,
            threshold=height,
            background=background,
            level_lines=level_lines,
            separate=separate,
            border=border,
            rectangle=rectangle,
            smallest_radius=smallest,
        )
    if found:
        _show(found, map_.name)
    else:
        print(f"{map_.name}: no particles above {threshold}")
    if table_out is not None:
        _write_table(table_out, found)
        print_written(table_out)
    if json_out is not None:
        _write_figures(json_out, found, {"map": str(map_), "threshold_nm": 1e9 * height})
        print_written(json_out)
    if figure_out is not None:
        from bem.particles import level_background
        from bem.plots.particles import draw_particles

        level = level_background(
            surface.heights, surface.spacing, threshold=height, method=background, lines=level_lines
        )
        draw_particles(level, surface.spacing, found, figure_out)
        print_written(figure_out)


def _show(found: list[Particle], name: str) -> None:
    from bem.cli._terminal import table
    from bem.particles import particle_statistics

    weighted = [particle_statistics(found, weight=weight) for weight in ("number", "area", "volume")]
    rows = [
        (title, *(f"{1e9 * getattr(s, f'mean_{key}'):.1f} ± {1e9 * getattr(s, f'std_{key}'):.1f}" for s in weighted))
        for title, key in (
            ("equivalent radius (nm)", "equivalent_radius"),
            ("length (nm)", "length"),
            ("width (nm)", "width"),
            ("thickness (nm)", "thickness"),
        )
    ]
    headers = ("mean ± deviation", "by number", "by area", "by volume")
    table(headers, rows, title=f"{name}: {len(found)} particles", right=(1, 2, 3))


def _write_figures(path: Path, found: list[Particle], origin: dict[str, str | float]) -> None:
    import json
    import math

    from bem.particles import size_summary
    from bem.results.atomic import write_text

    figures = {k: None if math.isnan(v) else v for k, v in size_summary(found).items()}
    write_text(path, json.dumps({**origin, **figures}, indent=1) + "\n")


def _write_table(path: Path, found: list[Particle]) -> None:
    from bem.results.atomic import write_text

    head = "x_m,y_m,volume_m3,equivalent_radius_m,length_m,width_m,thickness_m,columns,truncated"
    lines = [
        f"{p.position[0]:.9g},{p.position[1]:.9g},{p.volume:.9g},{p.equivalent_radius:.9g},{p.length:.9g},{p.width:.9g},"
        f"{p.thickness:.9g},{p.columns_count},{int(p.truncated)}"
        for p in found
    ]
    write_text(path, "\n".join([head, *lines]) + "\n")
