"""Clusters of open cells of a periodic patch, and the clusters that percolate.

A cluster carries a mean flow along x only if it percolates: a path inside it leads from a cell to the same cell of the
next period along x (it *wraps* the patch). Clusters are labelled by union-find in a forest of cells with their offsets
from the root (Machta, Choi, Lucke, Schweizer and Chayes, Physical Review E 54 (1996) 1332): a link between two cells of
one tree whose offsets disagree closes a path around the patch. Cost: a few passes over the cells.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled


@dataclass(frozen=True, eq=False)
class FluidClusters:
    """Clusters of open cells of a periodic patch, connected through the sides of cells.

    Attributes
    ----------
    label : (nx, ny), number of the cell's cluster; -1 where the cell is closed.
    wraps_x, wraps_y : (clusters,), True if the cluster percolates along x or along y.
    """

    label: NDArray[np.int64]
    wraps_x: NDArray[np.bool_]
    wraps_y: NDArray[np.bool_]

    def percolating_cells(self, axis: int) -> NDArray[np.bool_]:
        """Return True for the cells (nx, ny) of the clusters that percolate along the axis."""
        wraps = self.wraps_x if axis == 0 else self.wraps_y
        return np.append(wraps, False)[self.label]


def label_clusters(is_open: NDArray[np.bool_]) -> FluidClusters:
    """Return the clusters of the open cells (nx, ny) of a patch that is periodic along both axes."""
    nx, ny = is_open.shape
    parent, _, wraps = _union_clusters(np.ascontiguousarray(is_open))
    roots = parent.reshape(nx, ny)
    found, label = np.unique(roots[is_open], return_inverse=True)
    labels = np.full((nx, ny), -1, dtype=np.int64)
    labels[is_open] = label
    return FluidClusters(labels, wraps[found, 0], wraps[found, 1])


@compiled
def _root(parent, offset, cell):
    """Return the root of the cell's tree and compress the path to it; `offset` [cells] is counted from the parent."""
    root, x, y = cell, 0, 0
    while parent[root] != root:
        x += offset[root, 0]
        y += offset[root, 1]
        root = parent[root]
    while parent[cell] != root and cell != root:
        above, step_x, step_y = parent[cell], offset[cell, 0], offset[cell, 1]
        parent[cell] = root
        offset[cell, 0], offset[cell, 1] = x, y
        x -= step_x
        y -= step_y
        cell = above
    return root


@compiled
def _union_clusters(is_open):
    """Return the root of each cell, the offsets [cells] from it, and whether the tree of a root wraps along x and y."""
    nx, ny = is_open.shape
    parent = np.arange(nx * ny)
    offset = np.zeros((nx * ny, 2), np.int64)
    wraps = np.zeros((nx * ny, 2), np.bool_)
    for i in range(nx):
        for j in range(ny):
            if not is_open[i, j]:
                continue
            for axis in range(2):
                k, m = ((i + 1) % nx, j) if axis == 0 else (i, (j + 1) % ny)
                if not is_open[k, m]:
                    continue
                a, b = i * ny + j, k * ny + m
                step_x, step_y = (1, 0) if axis == 0 else (0, 1)
                first, second = _root(parent, offset, a), _root(parent, offset, b)
                # from the first root to the second one, along the link
                x = (offset[a, 0] if a != first else 0) + step_x - (offset[b, 0] if b != second else 0)
                y = (offset[a, 1] if a != first else 0) + step_y - (offset[b, 1] if b != second else 0)
                if first == second:
                    wraps[first, 0] |= x != 0
                    wraps[first, 1] |= y != 0
                else:
                    parent[second] = first
                    offset[second, 0], offset[second, 1] = x, y
                    wraps[first, 0] |= wraps[second, 0]
                    wraps[first, 1] |= wraps[second, 1]
    for cell in range(nx * ny):
        _root(parent, offset, cell)
    for cell in range(nx * ny):
        parent[cell] = _root(parent, offset, cell)
    return parent, offset, wraps
