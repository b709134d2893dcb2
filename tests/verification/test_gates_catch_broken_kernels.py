"""A kernel that is off by one per cent does not get through the gates.

A turned sign is 200 times that error: a gate whose figures are linear in the kernel catches it with the one per cent.
The figures of contact gates are not linear, so those are tested with both.

It is caught when a gate fails on its numbers; an exception is no catch. That healthy kernels pass is tested in
`test_gates.py`.
"""

import importlib
import math

import numpy as np
import pytest

from bem import convolution
from bem.kernels.layered import hankel
from bem.kernels.loads import Load
from bem.stress import spectra, von_mises_bound
from bem.verification import registry
from bem.verification.stored import STRESS_NAMES

pytestmark = pytest.mark.internal


def forget():
    """Spectra of healthy kernels must not serve a broken one, nor the other way round."""
    convolution._SPECTRA.clear()
    hankel._cached_table.cache_clear()
    for cache in (spectra.SPECTRA, von_mises_bound._TABLES):
        cache.clear()


@pytest.fixture(autouse=True)
def _clean_caches():
    forget()
    yield
    forget()


def rows_of(gate):
    """The gate's rows, computed with nothing kept from before; what raises is no row, and no catch."""
    forget()
    (chosen,) = registry.select([gate])
    return chosen.run()


def break_kernel(monkeypatch, target, factor, *, component=None, load=None):
    """Multiply what a function returns, or one component of it, for one load (an argument of type Load)."""
    module, name = target.rsplit(".", 1)
    home = importlib.import_module(module)
    healthy = getattr(home, name)

    def broken(*args, **kwargs):
        out = healthy(*args, **kwargs)
        given = kwargs.get("load", next((a for a in args if isinstance(a, Load)), Load.NORMAL))
        if load is not None and given is not load:
            return out
        out = np.array(out)
        if component is None:
            out *= factor
        else:
            out[component] *= factor
        return out

    monkeypatch.setattr(home, name, broken)


# (function, component or None, load or None, gate that must see it)
SURFACE = [
    ("bem.kernels.half_space.surface_table", None, Load.NORMAL, "disc-uniform"),
    ("bem.kernels.half_space.surface_table", None, Load.TANGENTIAL, "disc-tangential-uniform"),
    ("bem.kernels.semi_periodic.surface_table", None, Load.NORMAL, "strip-normal"),
    ("bem.kernels.semi_periodic.surface_table", None, Load.TANGENTIAL, "strip-tangential"),
    ("bem.convolution.surface_response", None, Load.NORMAL, "oblique-wave"),
    ("bem.convolution.surface_response", None, Load.TANGENTIAL, "oblique-wave"),
    ("bem.kernels.layered.frequency_response.surface_response", None, Load.NORMAL, "harmonic-normal-soft"),
    ("bem.kernels.layered.frequency_response.surface_response", None, Load.TANGENTIAL, "harmonic-tangential-soft"),
    ("bem.kernels.layered.cells.surface_remainder", None, Load.NORMAL, "disc-uniform-soft"),
    ("bem.kernels.layered.cells.surface_remainder", None, Load.TANGENTIAL, "disc-tangential-uniform-soft"),
    ("bem.kernels.layered.semi_periodic.surface_remainder", None, Load.NORMAL, "strip-normal-soft"),
    ("bem.kernels.layered.semi_periodic.surface_remainder", None, Load.TANGENTIAL, "strip-tangential-soft"),
    ("bem.verification.strip.strip_displacement", None, Load.NORMAL, "strip-normal"),
    ("bem.verification.strip.strip_displacement", None, Load.TANGENTIAL, "strip-tangential"),
    ("bem.verification.rectangle.rectangle_displacement", 2, Load.NORMAL, "rectangle-normal"),
    ("bem.verification.rectangle.rectangle_displacement", 0, Load.NORMAL, "rectangle-normal"),
    ("bem.verification.rectangle.rectangle_displacement", 2, Load.TANGENTIAL, "rectangle-tangential"),
    ("bem.verification.rectangle.rectangle_displacement", 0, Load.TANGENTIAL, "rectangle-tangential"),
]

# along x under a traction along x, along y under it, and what pressure does in the plane
IN_PLANE = [
    ("bem.kernels.half_space.in_plane_table", 0, None, "disc-tangential-uniform"),
    ("bem.kernels.half_space.in_plane_table", 2, None, "rectangle-tangential"),
    ("bem.kernels.layered.cells.in_plane_remainder", 0, None, "disc-tangential-uniform-soft"),
    ("bem.kernels.layered.cells.in_plane_remainder", 2, None, "rectangle-tangential-stiff"),
    ("bem.kernels.semi_periodic.in_plane_table", 0, None, "strip-tangential"),
    ("bem.kernels.semi_periodic.in_plane_table", 0, None, "strip-antiplane"),
    ("bem.kernels.layered.semi_periodic.in_plane_remainder", 0, None, "strip-tangential-soft"),
    ("bem.kernels.layered.semi_periodic.in_plane_remainder", 0, None, "strip-antiplane-soft"),
    ("bem.kernels.spectral.in_plane_response", 0, None, "harmonic-tangential-soft"),
    ("bem.kernels.spectral.in_plane_response", 0, None, "harmonic-antiplane-soft"),
    ("bem.tangential.operator.surface_coefficients", None, Load.TANGENTIAL, "disc-hertz-soft"),
    ("bem.kernels.spectral.surface_response", None, Load.TANGENTIAL, "harmonic-normal-soft"),
]


def each_load(components, *functions):
    """Functions of stress under either load, with the components that their gates for that load must see."""
    return [
        (function, components, load, gate)
        for function, gates in functions
        for load, gate in zip(Load, gates, strict=True)
    ]


STRESSES = [
    *each_load(
        range(6),
        ("bem.kernels.subsurface.stress_table", ("disc-uniform", "disc-tangential-uniform")),
        ("bem.kernels.semi_periodic.stress_table", ("images-bare-x", "images-bare-x")),
        ("bem.stress.spectra.stress_response", ("oblique-wave", "oblique-wave")),
        ("bem.kernels.layered.cells.stress_remainder", ("disc-uniform-soft", "disc-tangential-uniform-soft")),
        ("bem.kernels.layered.semi_periodic.stress_remainder", ("images-coated-x", "images-coated-x")),
        ("bem.verification.rectangle.rectangle_stress", ("rectangle-normal", "rectangle-tangential")),
    ),
    *each_load(
        (0, 1, 2, 4),
        ("bem.kernels.semi_periodic.stress_table", ("strip-normal", "strip-tangential")),
        ("bem.kernels.layered.semi_periodic.stress_remainder", ("strip-normal-soft", "strip-tangential-soft")),
        ("bem.verification.strip.strip_stress", ("strip-normal", "strip-tangential")),
        (
            "bem.kernels.layered.frequency_response.stress_response",
            ("harmonic-normal-soft", "harmonic-tangential-soft"),
        ),
    ),
]
"""Kernels of stress: all components are off in one run, and each must fail in a row of its own."""
ACROSS = [
    ("bem.kernels.layered.frequency_response.stress_response", c, Load.TANGENTIAL, "harmonic-antiplane-soft")
    for c in (4, 5)
]
WAVES = [
    ("bem.kernels.layered.frequency_response.wave_frame_response", row, None, gate)
    for rows, gate in (
        (range(1, 6), "harmonic-normal-soft"),
        (range(7, 12), "harmonic-tangential-soft"),
        ((13, 14), "harmonic-antiplane-soft"),
    )
    for row in rows
] + [  # displacements along the surface, which no operator uses
    ("bem.verification.harmonic.wave_frame_response", row, None, f"harmonic-{load}-soft")
    for row, load in ((0, "normal"), (6, "tangential"), (12, "antiplane"))
]
OTHERS = [
    ("bem.verification.contact.contact_modulus", None, None, "contact-sphere-elastic-pair"),
    ("bem.verification.contact.von_mises", None, None, "contact-cylinder-plain"),
    ("bem.heat.operators.temperature_table", None, None, "heat-band-peclet-10"),
    ("bem.heat.operators.temperature_table", None, None, "heat-disc-hertz"),
    ("bem.verification.heat.moving_band", None, None, "heat-band-peclet-1"),
    ("bem.verification.heat.disc_at_rest", None, None, "heat-disc-uniform"),
    ("bem.contact.shaft_in_bush._bush_harmonics", None, None, "bush-peek"),
    ("bem.contact.shaft_in_bush._bush_mean", None, None, "bush-peek-wide"),
]
ALL = [*SURFACE, *IN_PLANE, *ACROSS, *WAVES, *OTHERS]
QUICK = [SURFACE[0], SURFACE[3], SURFACE[8], STRESSES[0], STRESSES[1], STRESSES[12], WAVES[3], OTHERS[2], IN_PLANE[2]]

NONLINEAR = ("contact-sphere-elastic-pair", "contact-cylinder-plain")
"""Gates whose figures come from a solved contact."""


def label(mutant):
    function, component, load, gate = mutant
    part = component if component is None or isinstance(component, int) else "".join(map(str, component))
    return f"{function.removeprefix('bem.')}[{part}]-{load.name.lower() if load else 'any'}-{gate}"


def cases(mutants):
    """One case for each mutant; of those that are not quick every commit draws a third."""
    others = (pytest.mark.slow, pytest.mark.drawn(3))
    return [pytest.param(one, marks=() if one in QUICK else others, id=label(one)) for one in mutants]


def failed_rows(gate):
    """Rows of the gate that fail by their numbers: a figure that could not be computed says nothing of the kernel."""
    failed = [row for row in rows_of(gate) if not row.passed]
    assert all(math.isfinite(row.bem) and math.isfinite(row.difference) for row in failed)
    return failed


def check_caught(monkeypatch, mutant, factor):
    function, component, load, gate = mutant
    if function.endswith("contact_modulus") and factor < 0:
        factor = 0.99  # a modulus below zero has no contact at all, so no number either
    break_kernel(monkeypatch, function, factor, component=component, load=load)
    assert failed_rows(gate)


@pytest.mark.parametrize("mutant", cases(ALL))
def test_a_kernel_that_is_off_by_one_per_cent_is_caught(monkeypatch, mutant):
    check_caught(monkeypatch, mutant, 1.01)


@pytest.mark.parametrize("mutant", cases(STRESSES))
def test_every_component_of_stress_that_is_off_by_one_per_cent_is_caught(monkeypatch, mutant):
    function, components, load, gate = mutant
    break_kernel(monkeypatch, function, 1.01, component=list(components), load=load)
    seen = " ".join(row.quantity for row in failed_rows(gate))
    assert [name for name in (STRESS_NAMES[c] for c in components) if name not in seen] == []


@pytest.mark.slow
@pytest.mark.parametrize("mutant", [one for one in ALL if one[-1] in NONLINEAR], ids=label)
def test_a_kernel_of_the_other_sign_is_caught_by_gates_that_are_not_linear(monkeypatch, mutant):
    check_caught(monkeypatch, mutant, -1.0)
