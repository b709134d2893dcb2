# Most instruments are read by SurfaceTopography already. A format that it does not know, in a file of your own:
import numpy as np

import bem
from bem.surfaces import SurfaceFormat, read_surface


def read_counts(path):
    """Heights (nx, ny) [m], not-a-number where missing; spacing [m], None if the file does not say; notes."""
    nx, ny = np.fromfile(path, dtype="<i4", count=2)
    counts = np.fromfile(path, dtype="<i2", offset=8).reshape(nx, ny)
    return np.where(counts == -32768, np.nan, counts * 1e-9), (1e-7, 1e-7), {"instrument": "ours"}


# by its ending, by how the file begins (recognises=lambda head: head.startswith(b"...")), or both
bem.register(SurfaceFormat("counts of 1 nm", read_counts, suffixes=(".counts",)))

with open("worn.counts", "wb") as stream:
    stream.write(np.array([4, 6], "<i4").tobytes() + np.zeros((4, 6), "<i2").tobytes())
assert read_surface("worn.counts", detrend="none").shape == (4, 6)
# with BEM_LAWS=my_reader.py: bem surface describe worn.counts
# in a scene: surface = { kind = "measured", path = "worn.counts" }
# whatever read_counts raises of a damaged file becomes one SurfaceFileError
