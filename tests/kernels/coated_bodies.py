"""Layers on half-spaces by their ratios, and what every way to their coefficients must fulfil."""

import numpy as np
import pytest
from scipy import special

from bem import Body, Layer, Material, displacement_operator, subsurface_stress
from bem.kernels.coefficients import STRESS_PARITY, stress_coefficients, surface_coefficients
from bem.kernels.layered import frequency_response, hankel
from bem.kernels.loads import Load


def material(shear_modulus, poissons_ratio):
    return Material("solid", youngs_modulus=2 * shear_modulus * (1 + poissons_ratio), poissons_ratio=poissons_ratio)


def coated(ratio, nu1, nu2, thickness, substrate_modulus=1.0):
    """Of the ratio of shear moduli, layer over substrate."""
    return Body(material(substrate_modulus, nu2), layer=Layer(material(ratio * substrate_modulus, nu1), thickness))


def error_of_table(spectra, radii, reach, panels):
    """Largest error of the radial table against the same integrals along the real axis, over what cancels there.

    `panels` : length of the quadrature's panels over the decay of the spectra.
    """
    graded = hankel.graded(spectra.smallest / 4, 1 / spectra.decay)
    even = np.arange(0, 40 / spectra.decay, min(panels / spectra.decay, 2 / radii.max()))
    q, weights = hankel.gauss_rule(np.union1d(graded, even))
    f = spectra.values(q) * (q * weights / (2 * np.pi))
    terms = [special.jv(order, np.outer(radii, q)) * f[n] for n, order in enumerate(spectra.orders)]
    expected = np.stack([t.sum(axis=1) for t in terms], axis=1)
    # what cancels on the real axis, over all components: some of them vanish
    size = np.stack([np.abs(t).sum(axis=1) for t in terms], axis=1).max(axis=1, keepdims=True)
    table = hankel.radial_table(spectra, reach)
    return (np.abs(hankel.evaluate_table(table, radii) - expected) / size).max()


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


def assert_tractions_and_strains_pass(grid, body, load, of_strains):
    """Through the interface of a layer, strains to this part of the largest stress."""
    thickness = body.layer.thickness
    above = stress_coefficients(grid, body, thickness, load)
    below = stress_coefficients(grid, body, thickness * (1 + 1e-14), load)
    scale = max(np.abs(above).max(), np.abs(below).max())
    assert above[[2, 3, 4]] == pytest.approx(below[[2, 3, 4]], abs=2e-12 * scale)  # z moved by 1e-14 h; round-off
    over, under = in_plane_strain(above, body.layer.material), in_plane_strain(below, body.material)
    assert over == pytest.approx(under, abs=of_strains * scale)


def assert_layers_of_the_same_change_nothing(grid, solid, thicknesses, depths, seed):
    """Layers of the substrate's material under a random pressure: displacements and stresses are the substrate's."""
    pressure = np.random.default_rng(seed).random(grid.shape) * 1e8
    stacked, bare = Body(solid, layers=[Layer(solid, thickness) for thickness in thicknesses]), Body(solid)
    u, v = (displacement_operator(grid, body, friction=0.3)(pressure) for body in (stacked, bare))
    assert u == pytest.approx(v, abs=1e-13 * np.abs(v).max())  # round-off
    s, t = (subsurface_stress(pressure, grid, body, depths, friction=0.3) for body in (stacked, bare))
    assert s == pytest.approx(t, abs=1e-12 * np.abs(t).max())


def by_fourier(body, depth, load, x, y, dx, dy):
    """Displacement (depth None) or six stresses at (x, y) of a loaded cell: the double Fourier integral in polars.

    Knows no Bessel function, no table and no cell integration; below the outermost layer the whole, in it what the
    layer adds.
    """
    top = body.interfaces[0]
    inside = depth is None or depth <= top
    decay = 2 * top - (depth or 0.0) if inside else depth
    radius = np.hypot(x, y) + np.hypot(dx, dy)
    edges = np.union1d(hankel.graded(1e-3, 1 / decay), np.arange(0, 40 / decay, min(1 / decay, 3 / radius)))
    q, weights = hankel.gauss_rule(edges)
    count = 2 * int(24 * radius / decay) + 80
    theta = 2 * np.pi * (np.arange(count) + 0.5) / count
    kx, ky = np.outer(q, np.cos(theta)), np.outer(q, np.sin(theta))
    tangential = load is Load.TANGENTIAL
    if depth is None:
        spectrum = frequency_response.surface_response(kx, ky, body, load, remainder=True)[None]
        odd = [tangential]
    else:
        spectrum = frequency_response.stress_response(kx, ky, body, depth, load, remainder=inside)
        odd = [a * b < 0 for a, b in STRESS_PARITY[load]]
    phase = kx * x + ky * y
    measure = (q * weights)[:, None] * np.sinc(kx * dx / 2 / np.pi) * np.sinc(ky * dy / 2 / np.pi)
    measure *= dx * dy / (2 * np.pi * count)
    return np.array(
        [np.sum(s * measure * (-np.sin(phase) if o else np.cos(phase))) for s, o in zip(spectrum, odd, strict=True)]
    )
