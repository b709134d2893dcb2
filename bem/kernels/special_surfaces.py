"""Selection of the kernel of a surface that is not Boussinesq's: a crystal, or a surface under tension.

Both modules have `surface_table(grid, material)` and `surface_response(kx, ky, material)`, of pressure alone and even
along each axis. `anisotropic` has the part that is odd along both, too.
"""

from __future__ import annotations

from types import ModuleType

from bem.materials import Material


def special_surface(material: Material) -> ModuleType:
    """Return the module of a crystal or of surface tension; imported late, because few bodies need it."""
    if material.stiffness is not None:
        from bem.kernels import anisotropic

        return anisotropic
    from bem.kernels import surface_tension

    return surface_tension
