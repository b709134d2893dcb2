"""Pictures in space for the browser: stresses below a surface, particles of a run. They solve nothing."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from bem.app.pictures import (
    COLOURS,
    Picture,
    axis_title,
    heading,
    layer,
    layers_of,
    numbers,
    ordinal,
    scaled,
    stood_up,
    unit_of,
)
from bem.plots.labels import beyond_ends, label, prefix
from bem.results.arrays import Arrays

PARTICLES = "particles"
"""Name of particles beside the names of fields."""
MOST_POINTS = 32_000
"""Most points of a field in space; of larger fields every n-th along x and y, which the title then says."""
MOST_PARTICLES = 150
_PER_PARTICLE = ("x", "y", "length", "width", "thickness")
_LEVELS = 5


def solid_names(arrays: Arrays) -> dict[str, str]:
    """Return variables with a picture in space, with their words: fields over depth, x and y, and particles with
    places."""
    found = {
        name: str(item.attrs.get("long_name", name))
        for name, item in arrays.items()
        if item.dims[-3:] == ("depth", "x", "y") and min(item.shape[-3:]) > 1
    }
    sizes = [arrays.get(f"particle_{name}") for name in _PER_PARTICLE]
    if all(item is not None and item.shape[-1] > 0 for item in sizes):
        found[PARTICLES] = "particles as ellipsoids of their length, width and thickness"
    return found


def cases_of(arrays: Arrays, name: str) -> list[str]:
    """Describe the cases or components of a variable; empty for one."""
    item, kept = (arrays["particle_length"], 1) if name == PARTICLES else (arrays[name], 3)
    return layers_of(Arrays({**arrays.variables, "_": stood_up(item, kept)}, {}), "_")


def solid_picture(arrays: Arrays, name: str, case: int) -> Picture:
    """One of `solid_names`, of one of its cases."""
    if name == PARTICLES:
        rows = [np.asarray(arrays[f"particle_{one}"].values, dtype=np.float64) for one in _PER_PARTICLE]
        return particles_picture(*(row.reshape(-1, row.shape[-1])[case] for row in rows))
    item, count = arrays[name], arrays[name].shape[-3]
    planes = np.stack([layer(arrays, name, case * count + i) for i in range(count)])
    axes = [np.asarray(arrays[axis].values, dtype=np.float64) for axis in ("depth", "x", "y")]
    return field_picture(planes, axes, str(item.attrs.get("long_name", name)), unit_of(item))


def field_picture(values: NDArray[np.float64], axes: Sequence[NDArray[np.float64]], words: str, unit: str) -> Picture:
    """Surfaces of equal value of a field (nz, nx, ny) over depth, x and y [m], depth downwards."""
    step = 1
    while values[:, ::step, ::step].size > MOST_POINTS and step < min(values.shape[1:]) // 4:
        step += 1
    seen = values[:, ::step, ::step]
    depth, x, y = axes[0], axes[1][::step], axes[2][::step]
    factor, shown = scaled(seen[np.isfinite(seen)], unit)
    length, length_unit = prefix([float(np.ptp(side)) for side in axes], "m")
    down, along, across = np.meshgrid(-depth * length, x * length, y * length, indexing="ij")
    finite = seen[np.isfinite(seen)] * factor
    low, high = (float(v) for v in np.percentile(finite, [60, 99.8])) if finite.size else (0.0, 1.0)
    most = float(finite.max()) if finite.size else high
    said = beyond_ends((low, high), (low, most))[1].replace("\n", "<br>")
    trace = {
        "type": "isosurface",
        "x": numbers(along.ravel()),
        "y": numbers(across.ravel()),
        "z": numbers(down.ravel()),
        "value": numbers(np.nan_to_num(seen * factor).ravel()),
        "isomin": low,
        "isomax": high if high > low else low + 1.0,
        "opacity": 0.35,
        "surface": {"count": _LEVELS},
        "caps": {"x": {"show": False}, "y": {"show": False}},
        "colorscale": COLOURS,
        "colorbar": {"title": {"text": "<br>".join(part for part in (shown, said) if part)}},
    }
    thinned = f" (every {ordinal(step)} cell)" if step > 1 else ""
    return {"data": [trace], "layout": _space(words + thinned, length_unit)}


def particles_picture(
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    length: NDArray[np.float64],
    width: NDArray[np.float64],
    thickness: NDArray[np.float64],
) -> Picture:
    """Particles [m] where they came off, the largest ones, as ellipsoids under the surface: results keep sizes, no
    shapes."""
    sizes = np.stack([length, width, thickness])
    known = np.flatnonzero(np.isfinite(sizes).all(axis=0) & (sizes > 0).all(axis=0))
    largest = known[np.argsort(-sizes[:, known].prod(axis=0), kind="stable")][:MOST_PARTICLES]
    ball, faces = _ball()
    factor, unit = prefix([float(np.ptp(x[known])), float(np.ptp(y[known]))] if known.size else [1e-6], "m")
    places = np.stack([x[largest], y[largest], -0.5 * thickness[largest]], axis=1)
    corners = (places[:, None, :] + 0.5 * sizes[:, largest].T[:, None, :] * ball[None, :, :]) * factor
    triangles = faces[None, :, :] + len(ball) * np.arange(len(largest))[:, None, None]
    flat, corner = corners.reshape(-1, 3), triangles.reshape(-1, 3)
    trace = {
        "type": "mesh3d",
        **{axis: numbers(flat[:, i]) for i, axis in enumerate("xyz")},
        **{axis: corner[:, i].tolist() for i, axis in enumerate("ijk")},
        "intensity": numbers(np.repeat(thickness[largest] * 1e9, len(ball))),
        "colorscale": COLOURS,
        "colorbar": {"title": {"text": "thickness (nm)"}},
    }
    said = f"{len(largest)} of {len(known)} particles" if len(largest) < len(known) else f"{len(known)} particles"
    return {"data": [trace], "layout": _space(f"{said} where they came off, as ellipsoids", unit)}


def _ball(rings: int = 6, sides: int = 10) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Corners and triangles of a sphere of radius 1."""
    polar = np.linspace(0, np.pi, rings + 1)
    turn = 2 * np.pi * np.arange(sides) / sides
    corners = np.stack(
        [
            np.outer(np.sin(polar), np.cos(turn)),
            np.outer(np.sin(polar), np.sin(turn)),
            np.outer(np.cos(polar), np.ones(sides)),
        ],
        axis=-1,
    ).reshape(-1, 3)
    faces = []
    for ring in range(rings):
        for side in range(sides):
            a, b = ring * sides + side, ring * sides + (side + 1) % sides
            faces += [(a, b, a + sides), (b, b + sides, a + sides)]
    return corners, np.array(faces)


def _space(words: str, unit: str) -> Picture:
    scene = {
        "xaxis": axis_title(label("x", unit)),
        "yaxis": axis_title(label("y", unit)),
        "zaxis": axis_title(label("z", unit)),
        "aspectmode": "data",
    }
    return {"title": heading(words), "scene": scene, "height": 520, "margin": {"t": 66}}
