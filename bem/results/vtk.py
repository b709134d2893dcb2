"""Stress fields for ParaView: a .vtu file of hexahedra between the points where stresses are known."""

from __future__ import annotations

import base64
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from bem.results.atomic import replacing
from bem.scenes.context import Variable, release

LARGEST = 200_000
"""Points in a file; larger fields are thinned along x and y by a whole number, which the file's name says."""


def write_volumes(folder: Path, variables: Mapping[str, Variable], names: Sequence[str]) -> list[Path]:
    """Write variables of dimensions (depth, x, y), or with one more axis in front, as point data of `volume.vtu`.

    Points lie at (x, y, -depth). An axis in front becomes separate fields named after its coordinate: `stress_xx`.
    Nothing is written for fields of one depth or of a single row. Raises ResultsError if the file cannot be written.
    """
    x, y, depth = (variables[name].values for name in ("x", "y", "depth"))
    stride = 1
    while len(x[::stride]) * len(y[::stride]) * len(depth) > LARGEST and stride < min(len(x), len(y)) // 2:
        stride += 1
    x, y = x[::stride], y[::stride]
    if min(len(x), len(y), len(depth)) < 2:
        return []
    points = np.stack([axis.ravel() for axis in np.meshgrid(x, y, -depth, indexing="ij")], axis=1)
    cells = _hexahedra(len(x), len(y), len(depth))
    path = folder / ("volume.vtu" if stride == 1 else f"volume-every-{stride}.vtu")
    with replacing(path) as temporary, open(temporary, "wb") as file:
        file.write(_OPENING.format(sys.byteorder.capitalize(), len(points), len(cells)).encode())
        _array(file, "Points", points)
        file.write(b"</Points><Cells>")
        _array(file, "connectivity", cells)
        _array(file, "offsets", np.arange(8, 8 * len(cells) + 1, 8, dtype=np.int32))
        _array(file, "types", np.full(len(cells), _HEXAHEDRON, dtype=np.uint8))
        file.write(b"</Cells><PointData>")
        for name in names:
            for label, values in _scalars(name, variables):
                thinned = np.empty((len(x), len(y), len(depth)))
                for i, plane in enumerate(values):
                    thinned[:, :, i] = plane[::stride, ::stride]
                    release(values)
                _array(file, label, thinned.ravel())
        file.write(b"</PointData></Piece></UnstructuredGrid></VTKFile>\n")
    return [path]


_OPENING = (
    '<VTKFile type="UnstructuredGrid" version="0.1" byte_order="{}Endian" header_type="UInt64">'
    '<UnstructuredGrid><Piece NumberOfPoints="{}" NumberOfCells="{}"><Points>'
)
_HEXAHEDRON = 12
_TYPES = {"float64": "Float64", "int32": "Int32", "uint8": "UInt8"}


def _array(file: BinaryIO, name: str, values: NDArray[Any]) -> None:
    """One array of the file, its length in bytes in front; not packed: that took ten times a small contact's physics.

    Without a library: loading one for this took as long as writing the volume.
    """
    columns = f' NumberOfComponents="{values.shape[1]}"' if values.ndim == 2 and name == "Points" else ""
    file.write(f'<DataArray type="{_TYPES[values.dtype.name]}" Name="{name}"{columns} format="binary">'.encode())
    content = np.uint64(values.nbytes).tobytes() + values.tobytes()
    file.write(base64.b64encode(content))
    file.write(b"</DataArray>")


def _scalars(name: str, variables: Mapping[str, Variable]) -> list[tuple[str, NDArray[np.float64]]]:
    variable = variables[name]
    if len(variable.dimensions) == 3:
        return [(name, variable.values)]
    labels = variables[variable.dimensions[0]].values
    return [(f"{name}_{label}", variable.values[i]) for i, label in enumerate(labels)]


def _hexahedra(nx: int, ny: int, nz: int) -> NDArray[np.int32]:
    """Corners of all cells, in VTK's order, of points numbered with z fastest; z falls with its index."""
    index = np.arange(nx * ny * nz, dtype=np.int32).reshape(nx, ny, nz)
    low, high = index[:, :, 1:], index[:, :, :-1]
    corners = [
        part[i : i + nx - 1, j : j + ny - 1] for part in (low, high) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))
    ]
    return np.stack([corner.ravel() for corner in corners], axis=1)
