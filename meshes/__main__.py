"""Write a mesh to a file for looking at it: ``python -m meshes half-space --thickness 0.5 --out FILE.msh``."""

from __future__ import annotations

import argparse

from meshes import Builder, gmsh_model
from meshes.grids import half_space_grid, harmonic_grid, rectangle_grid


def main(arguments: list[str] | None = None) -> None:
    """Build one mesh and write it in any format gmsh knows by the file's ending."""
    parser = argparse.ArgumentParser(prog="python -m meshes", description=__doc__)
    parser.add_argument("builder", choices=("half-space", "harmonic", "rectangle"))
    parser.add_argument("--thickness", type=float, help="of the layer; homogeneous if not given")
    parser.add_argument("--width", type=float, default=0.5, help="of the rectangle, over its length")
    parser.add_argument("--level", type=int, default=1, help="subdivision")
    parser.add_argument("--out", required=True, help="file to write")
    chosen = parser.parse_args(arguments)
    builder: Builder
    if chosen.builder == "half-space":
        builder = half_space_grid(thickness=chosen.thickness, level=chosen.level)
    elif chosen.builder == "harmonic":
        builder = harmonic_grid(thickness=chosen.thickness, level=chosen.level)
    else:
        builder = rectangle_grid(half_length=1.0, half_width=chosen.width, level=chosen.level)
    import gmsh

    with gmsh_model(chosen.builder) as model:
        builder.build(model)
        gmsh.write(chosen.out)
        print(f"{chosen.out}: {len(model.mesh.getNodes()[0])} nodes")


if __name__ == "__main__":
    main()
