"""How the package's example surfaces were made: `python tests/surfaces/make_examples.py`.

Generated, with what instruments add: tilt, points without a signal, lone spikes, rounding to the digits of the file.
"""

import io
import struct
import sys
from pathlib import Path

import numpy as np

from bem import Grid, generate_surface
from bem.surfaces.examples import FOLDER

CELLS, SPACING = 128, 0.8e-6
SAYS = "bem (generated)"


def ground_disk():
    """Ground along y: correlation 3 um across the lay, 20 um along it, Sq 0.25 um, deep valleys."""
    grid = Grid((CELLS, CELLS), (SPACING, SPACING))
    asked = {"rms_height": 0.25e-6, "correlation_length": (3e-6, 20e-6), "skewness": -0.6, "kurtosis": 3.8, "seed": 18}
    heights = generate_surface(grid, autocorrelation="exponential", **asked)
    heights = heights + 2e-3 * grid.x[:, None] - 1e-3 * grid.y[None, :]  # as it lay on the table
    rng = np.random.default_rng(1)
    spikes = rng.integers(0, CELLS, (12, 2))
    heights[spikes[:, 0], spikes[:, 1]] += rng.uniform(2e-6, 5e-6, 12)
    holes = rng.integers(0, CELLS, (40, 2))
    heights[holes[:, 0], holes[:, 1]] = np.nan
    return heights.astype(np.float32)


def polished_pin():
    """Polished: self-affine, H = 0.8 below 20 um, Sq 30 nm, on a slight crown."""
    grid = Grid((CELLS, CELLS), (SPACING, SPACING))
    heights = generate_surface(grid, rms_height=30e-9, hurst=0.8, rolloff_wavelength=20e-6, seed=19)
    heights = heights - (grid.x[:, None] ** 2 + grid.y[None, :] ** 2) / (2 * 20e-3)
    return np.round(heights * 1e10).astype(np.int64)  # in tenths of a nanometre


def write_al3d(path, heights):
    """Alicona's format: tags of 20 + 30 + 2 bytes, then rows of floats."""
    tags = {"Cols": CELLS, "Rows": CELLS, "PixelSizeXMeter": SPACING, "PixelSizeYMeter": SPACING}
    tags |= {"CreatingApplication": SAYS, "InvalidPixelValue": "NaN", "DepthImageOffset": 0}
    magic = b"AliconaImaging\x00\r\n"
    size = len(magic) + 52 * (len(tags) + 2)
    tags["DepthImageOffset"] = size
    lines = {"Version": 1, "TagCount": len(tags), **tags}
    head = b"".join(struct.pack("<20s30s2s", k.encode(), str(v).encode(), b"\r\n") for k, v in lines.items())
    path.write_bytes(magic + head + np.ascontiguousarray(heights.T).astype("<f4").tobytes())


def write_x3p(path, tenths):
    """ISO 25178-72: an archive of main.xml and the heights, here 16-bit numbers of 0.1 nm above the lowest."""
    from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

    low = int(tenths.min())
    raw = np.ascontiguousarray((tenths - low).T).astype("<u2").tobytes()
    axis = (
        "<{0}><AxisType>{1}</AxisType><DataType>{2}</DataType><Increment>{3!r}</Increment><Offset>{4!r}</Offset></{0}>"
    )
    axes = axis.format("CX", "I", "D", SPACING, 0.0) + axis.format("CY", "I", "D", SPACING, 0.0)
    axes += axis.format("CZ", "A", "I", 1e-10, low * 1e-10)
    text = (
        '<?xml version="1.0" encoding="UTF-8"?>\n<p:ISO5436_2 xmlns:p="http://www.opengps.eu/2008/ISO5436_2"><Record1>'
        f"<Revision>ISO5436 - 2000</Revision><FeatureType>SUR</FeatureType><Axes>{axes}</Axes></Record1><Record2>"
        f"<Instrument><Manufacturer>{SAYS}</Manufacturer><Model>none</Model><Serial>unknown</Serial>"
        "<Version>1</Version></Instrument><ProbingSystem><Type>Software</Type><Identification>none</Identification>"
        f"</ProbingSystem></Record2><Record3><MatrixDimension><SizeX>{CELLS}</SizeX><SizeY>{CELLS}</SizeY>"
        "<SizeZ>1</SizeZ></MatrixDimension><DataLink><PointDataLink>bindata/data.bin</PointDataLink></DataLink></Record3>"
        "</p:ISO5436_2>"
    )
    packed = io.BytesIO()
    with ZipFile(packed, "w", ZIP_DEFLATED) as archive:
        for name, content in (("main.xml", text.encode()), ("bindata/data.bin", raw)):
            archive.writestr(ZipInfo(name, (2026, 1, 1, 0, 0, 0)), content, ZIP_DEFLATED)
    path.write_bytes(packed.getvalue())


def main(folder):
    folder.mkdir(exist_ok=True)
    write_al3d(folder / "ground-disk.al3d", ground_disk())
    write_x3p(folder / "polished-pin.x3p", polished_pin())


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER)
