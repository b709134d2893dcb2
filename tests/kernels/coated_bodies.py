"""Layers on half-spaces by their ratios, and what every way to their coefficients must fulfil."""

import numpy as np
import pytest
from scipy import special

from bem import Body, Layer, Material
from bem.kernels import layered_hankel
from bem.kernels.coefficients import stress_coefficients, surface_coefficients


def material(shear_modulus, poissons_ratio):
    return Material("solid", youngs_modulus=2 * shear_modulus * (1 + poissons_ratio), poissons_ratio=poissons_ratio)


def coated(ratio, nu1, nu2, thickness, substrate_modulus=1.0):
    """Of the ratio of shear moduli, layer over substrate."""
    return Body(material(substrate_modulus, nu2), layer=Layer(material(ratio * substrate_modulus, nu1), thickness))


def error_of_table(kernels, radii, reach, panels):
    """Largest error of the radial table against the same integrals along the real axis, over what cancels there.

    `panels` : length of the quadrature's panels over the decay of the spectra.
    """
    graded = layered_hankel.graded(kernels.smallest / 4, 1 / kernels.decay)
    even = np.arange(0, 40 / kernels.decay, min(panels / kernels.decay, 2 / radii.max()))
    q, weights = layered_hankel.gauss_rule(np.union1d(graded, even))
    f = kernels.spectra(q) * (q * weights / (2 * np.pi))
    terms = [special.jv(order, np.outer(radii, q)) * f[n] for n, order in enumerate(kernels.orders)]
    expected = np.stack([t.sum(axis=1) for t in terms], axis=1)
    # what cancels on the real axis, over all components: some of them vanish
    size = np.stack([np.abs(t).sum(axis=1) for t in terms], axis=1).max(axis=1, keepdims=True)
    table = layered_hankel.radial_table(kernels, reach)
    return (np.abs(layered_hankel.table_values(table, radii) - expected) / size).max()


def in_plane_strain(stress, solid):
    """eps_xx, eps_yy, eps_xy: the strains that pass an interface unbroken."""
    nu = solid.poissons_ratio
    trace = nu / (1 + nu) * stress[:3].sum(axis=0)
    return np.stack([stress[0] - trace, stress[1] - trace, stress[5]]) / (2 * solid.shear_modulus)


def assert_identical_materials_add_nothing(grid, load, on_surface, below):
    """A layer of the substrate's material has the substrate's coefficients, to these parts of the largest."""
    body = coated(1.0, 0.3, 0.3, 2.0)
    plain = Body(body.material)
    surface = surface_coefficients(grid, plain, load)
    assert surface_coefficients(grid, body, load) == pytest.approx(surface, abs=on_surface * np.abs(surface).max())
    for depth in (0.5, 2.0, 2.5):
        stress = stress_coefficients(grid, plain, depth, load)
        # below the layer a transform stands against closed forms (and their images)
        assert stress_coefficients(grid, body, depth, load) == pytest.approx(stress, abs=below * np.abs(stress).max())
