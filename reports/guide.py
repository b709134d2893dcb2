"""The user's guide: first steps, every option, the theory with its sources, limits, and how to add to the code."""

from __future__ import annotations

import html
import re
import typing
from collections.abc import Iterator, Sequence
from typing import Any

from bem.errors import InputError
from bem.laws import FAMILIES, Law, laws_of
from bem.scenes import get_kind, kind_names, library
from bem.scenes.laws import LawKey
from bem.scenes.template import _about, _default, scene_template
from bem.scenes.validate import _fields, _literals, _unwrap, _without_none
from reports.builder import Page, Section, table, text
from reports.guide_options import EFFECTS

LEAD = (
    "From two surfaces, two materials, a load, a speed and an oil to friction, particles, running-in and tribofilms: "
    "what to type, what each option does, which formulas stand behind it, and where they end."
)

FIRST_STEPS = """bem scenes                                  # what is built in
bem run rough-contact                       # figures, report.html, results.nc under runs/
bem new contact mine.toml                   # a commented scene with every key
bem plan mine.toml                          # grid, Hertz size, surfaces, steps, memory, time, warnings
bem run mine.toml --out first --set contact.load="2 N"
bem report first                            # the page again; bem plot first --figure pressure-map --format pdf
bem compare first second                    # scenes, figures and overlaid curves of two runs or more
bem schema contact > contact.schema.json    # for completion and checks in an editor
bem --install-completion                    # tab completion of commands, options and scene names
"""
SWEEP = """bem sweep rough-contact --over "contact.mean_pressure=log:20 MPa:500 MPa:6" --over seed=1:3 --out pressures
bem sweep rough-contact --over contact.behaviour=elastic,capped --scheduler tcp://scheduler:8786
bem sweep wear-mesh-convergence --over "variants[0].cells=80,100" --set "cylinder.loads=[10.0]"
"""
OWN_SURFACES = """bem surface read disk.al3d disk.npz --detrend curvature
bem surface describe disk.npz
bem surface plot disk.npz disk.png
bem run measured-surfaces --set lower.surface.path=disk.npz --set upper.surface.path=pin.npz
"""
PYTHON = """
import numpy as np
from bem import Body, Grid, Material, displacement_operator, solve_contact, subsurface_stress, von_mises

steel = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3, hardness=6e9)
grid = Grid((64, 64), (1e-6, 1e-6))
gap = (grid.x[:, None] ** 2 + grid.y[None, :] ** 2) / (2 * 10e-3)   # a ball of 10 mm radius
bodies = (Body(steel), Body(steel))
solution = solve_contact(gap, displacement_operator(grid, bodies), load=1.0)
stress = subsurface_stress(solution.pressure, grid, bodies[0], depths=[0.0, 5e-6], friction=0.1)
print(solution)
print(von_mises(stress).max())
"""
PYTHON_RUN = """
from bem import load_scene, open_run, run_scene

run = run_scene("sinusoid", "out", settings=["grid.shape=[32, 4]", "grid.spacing=3.2 um"], figures=False)
run.summary["contact_area_fraction"]        # the same as in out/summary.json
run.dataset["pressure"]                     # xarray, with units; h5py and ParaView read the files too
open_run("out").scene["contact"]
"""

LAW = '''
# my_laws.py, a file of your own: a law is one class; its parameters have units and bounds, its formula is a method
from dataclasses import dataclass
from typing import ClassVar
import numpy as np
import bem
from bem.laws import parameter
from bem.lubrication.viscosity import ViscosityLaw

@bem.register
@dataclass(frozen=True)
class Power(ViscosityLaw):
    """mu = mu0 (1 + alpha p / n)^n."""
    name: ClassVar[str] = "power"
    exponent: float = parameter("n: Barus' law where it is large", default=16.0, above=0)

    def log_viscosity_ratio(self, pressure, viscosity, pressure_viscosity):
        """ln(mu / mu0) and its derivative with pressure, which is alpha at zero pressure for every law."""
        base = 1 + pressure_viscosity * pressure / self.exponent
        return self.exponent * np.log(base), pressure_viscosity / base

oil = bem.Lubricant(0.1, pressure_viscosity=20e-9, viscosity_law="power", exponent=12)
assert oil.viscosity_at(np.array([0.0]))[0] == 0.1
assert bem.Lubricant(0.1, pressure_viscosity=20e-9, viscosity_law=Power(exponent=12)) == oil
'''
LAW_SCENE = """
[oil]
viscosity = "0.1 Pa*s"
pressure_viscosity = "20 1/GPa"
viscosity_law = "power"
exponent = 12           # or, in one line: viscosity_law = { kind = "power", exponent = 12 }
"""
LAW_LOAD = """
BEM_LAWS=my_laws.py bem run my-scene.toml
"""
CRITERION = '''
# the same for a wear criterion: material leaves where the equivalent stress exceeds the yield stress
from dataclasses import dataclass
from typing import ClassVar
import numpy as np
import bem
from bem.laws import parameter
from bem.wear.criterion import WearCriterion

@bem.register
@dataclass(frozen=True)
class OverStress(WearCriterion):
    """Von Mises stress above a threshold."""
    name: ClassVar[str] = "over_stress"
    threshold: float = parameter("stress that does no harm", "Pa", at_least=0)

    # lets depths be skipped by the bound on von Mises: the largest ratio of the two (leave it out if there is none)
    von_mises_factor = 1.0

    def equivalent_stress(self, stress):
        """(...) of stresses (6, ...) [Pa]."""
        return np.maximum(bem.von_mises(stress) - self.threshold, 0.0)

# in a scene: wear.criterion = { kind = "over_stress", threshold = "0.2 GPa" }
tension = np.array([3e8, 0, 0, 0, 0, 0])
assert np.isclose(OverStress(threshold=2e8).equivalent_stress(tension), 1e8)
'''
READER = '''
# Most instruments are read by SurfaceTopography already. What it cannot read comes in as heights [m] and spacing [m]:
import numpy as np
from bem.surfaces import Surface, read_surface, write_surface

def read_raw(path, shape, spacing, step):
    """A raw map of 16-bit counts, `step` metres each."""
    counts = np.fromfile(path, dtype="<i2").reshape(shape)
    return Surface(counts * step, spacing, {"file": str(path), "format": "raw"})

np.zeros((4, 6), dtype="<i2").tofile("map.raw")
write_surface("map.npz", read_raw("map.raw", (4, 6), (1e-7, 1e-7), 1e-9))
assert read_surface("map.npz", detrend="none").shape == (4, 6)

# To make it part of bem: the function and its file ending in bem/surfaces/read.py, and a file, whole and damaged,
# in tests/surfaces/test_surface_read.py: whatever is wrong must be one SurfaceFileError.
'''
KERNEL = '''
# A kernel is a pure function, arrays in, arrays out: bem/kernels/my_kernel.py
import numpy as np

def point_displacement(radius, contact_modulus):
    """Displacement under a unit point force, 1 / (pi E* r) [m/N]; Boussinesq, Johnson (1985), eq. 3.22a."""
    return 1 / (np.pi * contact_modulus * radius)

# Its gate compares it with something that knows nothing of it, and says how wrong it may be, and why:
# a function in bem/verification/ entered in registry.py. `bem verify` runs it, and the report shows it.
from bem.verification.rows import Curve

def gate_curve():
    """Far from a loaded square the sum over its cells is that of a point force."""
    from bem import Body, Grid, Material, displacement_operator
    steel = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3)
    grid = Grid((257, 1), (1e-6, 1e-6))
    pressure = np.zeros(grid.shape)
    pressure[128] = 1e9
    ours = displacement_operator(grid, Body(steel))(pressure)[200:, 0]
    radius = grid.x[200:]
    theirs = point_displacement(radius, steel.plane_strain_modulus) * 1e9 * grid.cell_area
    where = np.stack([radius, 0 * radius, 0 * radius], axis=1)
    return Curve("normal displacement", "x", "m", where, ours, theirs, 0 * theirs, 1e-4,
                 "a square cell is no point: its quadrupole falls with the square of the distance, (1/72)^2")

curve = gate_curve()
assert np.abs(curve.bem - curve.reference).max() <= curve.allowance * curve.reference.max()
'''
SNIPPETS = {
    "python": PYTHON,
    "python-run": PYTHON_RUN,
    "law": LAW,
    "criterion": CRITERION,
    "reader": READER,
    "kernel": KERNEL,
}

# title, formula, where it comes from, errata of the source, where it lives
THEORY: tuple[tuple[str, str, str, str, str], ...] = (
    (
        "Contact modulus",
        "1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2",
        "Johnson, Contact Mechanics (1985)",
        "The thesis' E' is 2 E*; it appears nowhere inside the code.",
        "bem/materials.py",
    ),
    (
        "Displacement of a rectangle",
        "u = (1/(pi E*)) sum over corners, signs alternating, of x ln(y + r) + y ln(x + r), times p",
        "Love (1929); Johnson (1985), eq. 3.25",
        "Thesis, Paper A, appendix A prints pi E' for pi E'/2 = pi E*, and calls half cell sides spacings.",
        "bem/kernels/half_space.py",
    ),
    (
        "Tangential coupling",
        "u_z = K_n p + f (T_lower - T_upper) p;  zero where Dundurs' beta is zero",
        "Cerruti; Johnson (1985), section 3.6; Dundurs (1969)",
        "The thesis adds it always; for equal bodies it cancels exactly and is skipped.",
        "bem/convolution.py",
    ),
    (
        "Periodic response",
        "u(q) = 2/(E* |q|) p(q);  mean mode: 0 (it moves the datum only)",
        "Westergaard (1939); Johnson (1985), section 13.2",
        "",
        "bem/kernels/spectral.py",
    ),
    (
        "Bonded layers",
        "u/p = (1 - nu1)/(mu1 q) (1 + 4 x k e^-2x - l k e^-4x)/(1 - (l + k + 4 k x^2) e^-2x + l k e^-4x),  x = q h,\n"
        "l = 1 - 4(1 - nu1)/(1 + m(3 - 4nu2)),  k = (m - 1)/(m + 3 - 4nu1),  m = mu1/mu2;\n"
        "for one; any number, and stresses: impedance of what lies below carried up through each layer, reflection\n"
        "R = (Zu - Z)^-1 (Z - Zd), decaying waves only. Free-space coefficients: those of the outermost material plus\n"
        "a smooth remainder by a Hankel transform",
        "Burmister (1945); O'Sullivan and King (1988); derived anew here",
        "Plain sampling of the spectrum leaves 2 to 24 % of error; nothing here does that.",
        "bem/kernels/layered.py, layer_waves.py, layered_hankel.py",
    ),
    (
        "Contact",
        "minimise 1/2 p.K p + p.g0 over 0 <= p <= H with the load, approach or mean gap fixed",
        "Kalker (1977); Polonsky and Keer (1999); thesis, papers A, C",
        "",
        "bem/contact/",
    ),
    (
        "Stresses below",
        "sigma_ij(z) = F^N_ij * p + F^S_ij * (f p)",
        "Love (1929) and Cerruti's potentials, integrated over rectangles; Hamilton (1983) as check",
        "",
        "bem/kernels/subsurface.py, bem/stress",
    ),
    (
        "Line film",
        "d/dx (rho h^3 / (12 mu) dp/dx) = u_mean d(rho h)/dx + d(rho h)/dt;  "
        "h = h0 + x^2/(2R) - (2/(pi E*)) integral p ln|x - x'| dx'",
        "Reynolds (1886); Dowson and Higginson (1966); thesis, papers A, D",
        "The thesis prints ln(x - x') for ln|x - x'|; its 4/(pi E') is right for its E'.",
        "bem/lubrication/",
    ),
    (
        "Cavitation",
        "p >= 0 and, where p = 0, either d(rho h u)/dx is left open (Swift-Stieber) or a fraction\n"
        "theta <= 1 of the gap is filled and carried along,\n"
        "d(theta rho h)/dt + u_mean d(theta rho h)/dx = 0 (mass-conserving)",
        "Swift (1932), Stieber (1933); Jakobsson and Floberg (1957), Olsson (1965), Elrod and Adams (1974)",
        "",
        "bem/lubrication/cavitation.py",
    ),
    (
        "Density",
        "rho/rho0 = 1 + 0.6e-9 p / (1 + 1.7e-9 p),  p in Pa",
        "Dowson and Higginson (1966)",
        "",
        "bem/lubrication/density.py",
    ),
    (
        "Shear of the oil",
        "Newtonian: tau = mu du/h;  Eyring: tau = tau0 asinh(mu du/(h tau0));\n"
        "Carreau: tau = (mu du/h) [1 + (mu du/(h G))^2]^((n - 1)/2);\n"
        "limited (the default): Newtonian;  all but Newtonian by name: abs(tau) <= tau_a + Lambda p",
        "Eyring (1936), Johnson and Tevaarwerk (1977); Bair (2007);\n"
        "limit: Bair and Winer (1979), Hoglund and Jacobson (1986)",
        "The thesis' oil is Newtonian; its conditions stay below 6 % of the limit.",
        "bem/lubrication/shear.py",
    ),
    (
        "Viscosity",
        "mu = mu0 exp{ln(mu0/mu_r) [(1 + p/p_r)^z - 1]}, z = alpha p_r / ln(mu0/mu_r);  or mu = mu0 exp(alpha p)",
        "Roelands (1966); Barus (1893)",
        "The thesis' nomenclature calls it kinematic; it is dynamic.",
        "bem/lubrication/viscosity.py",
    ),
    (
        "Friction of the film",
        "F = integral mu (u1 - u2)/h + (h/2) dp/dx over the full film, on the flat; by equilibrium on either",
        "equilibrium of the film",
        "The thesis integrates on the upper surface, where the pressure on the slope carries the rest: up to six times "
        "smaller.",
        "bem/lubrication/film.py",
    ),
    (
        "Load sharing",
        "mean(max(gap, 0)) = <h>;  F_film + F_contact = F_total;  f = (f_b F_contact + F_shear)/F_total",
        "thesis, papers A, D; Johnson, Greenwood and Poon (1972)",
        "The averaging of the search direction printed in the source belongs to load control. Full film: the film "
        "under F_total clears the roughness. Boundary: a film left with a tenth of the balance's tolerance is thinner "
        "than what the surfaces leave open under the rest, which they then carry. Boundary friction couples into the "
        "normal gap (the flat is held back: traction -f_b p where u1 > u2) unless the bodies are elastically alike.",
        "bem/friction/balance.py",
    ),
    (
        "Uncoupled asperities",
        "every summit a Hertz sphere of its own radius, F = (4/3) E* sqrt(R) d^(3/2), then hardness times\n"
        "the area pi R (2 d - d_c) beyond first yield d_c; blind to the others",
        "Greenwood and Williamson (1966), without the statistics; thesis, Paper A",
        "",
        "bem/friction/asperities.py",
    ),
    (
        "Equivalent stress",
        "von Mises: sqrt(3/2 s:s);  Tresca: sigma_1 - sigma_3;  maximum tension: sigma_1",
        "Malvern (1969), section 3.3 (principal stresses)",
        "",
        "bem/wear/criterion.py",
    ),
    (
        "Detachment",
        "a connected region of equivalent stress > yield stress that reaches the surface comes off, with its cap",
        "thesis, Paper C",
        "Number means of the thesis follow the cell: means by volume are reported.",
        "bem/wear/",
    ),
    (
        "Wear volume",
        "W = k F s;  number of particles = W / mean particle volume",
        "Archard (1953)",
        "",
        "bem/particles/",
    ),
    (
        "Tribofilm",
        "dh/dt = G0 exp(-(dU - tau dV)/(kB T)) - alpha h(t - lag);  substrate wear = exp(-C1 h) alpha h",
        "Gosvami et al. (2015); thesis, Paper E",
        "The nomenclature gives G0 in nm/s: it is 1e-2 m/s. Temperatures are kelvin.",
        "bem/tribofilm/",
    ),
    (
        "Properties of the tribofilm",
        "film + (substrate - film) exp(-h/length), the film's own value times a factor that falls with temperature",
        "the shape of Demmou et al. (2006) and of Bosman and Schipper (2011), constants calibrated",
        "The thesis only plots both curves: they are inputs, or a table.",
        "bem/tribofilm/properties.py",
    ),
    (
        "Film ratio",
        "lambda = h_min / Sq,  h_min/R = 2.65 G^0.54 U^0.7 W^-0.13,\n"
        "U = mu u/(E' R), G = alpha E', W = w/(E' R), E' = 2 E*",
        "Dowson and Higginson (1966); thesis, Paper B",
        "With load sharing h_min is that of the film solved under the whole load, Sq that of both surfaces together.",
        "bem/particles/film_ratio.py",
    ),
    (
        "Generated surfaces",
        "sum of waves with amplitudes from the autocorrelation exp(-(r/l)^2) or exp(-r/l), or q^-(1+H)\n"
        "below a roll-off, each with a random phase; other statistics by exchanging ranks\n"
        "until spectrum and heights both agree",
        "Schreiber and Schmitz (1996); Hu and Tonder (1992)",
        "Hu and Tonder filter a translated sequence once, which makes it Gaussian again.",
        "bem/surfaces/generate.py",
    ),
    (
        "Sedimentation",
        "t = 9 L mu / (2 RCF g (rho_p - rho_l) R^2)",
        "Stokes (1851); thesis, Paper B",
        "",
        "bem/particles/sedimentation.py",
    ),
)

LIMITS = (
    (
        "Small strain, linear elasticity",
        "Slopes well below one. Rough metals with slopes of 0.2 to 0.3 are at the edge.",
    ),
    (
        "Half-spaces",
        "Both bodies are much larger than the contact. The edges of a free grid are not edges of a "
        "body; a contact that "
        "reaches them is cut off.",
    ),
    (
        "Plasticity as a cap",
        "Pressure stops at the hardness and the surfaces overlap. Material does not pile up and does not harden, and "
        "stresses below are those of an elastic body under the capped pressure.",
    ),
    (
        "Friction as a number",
        "Traction is a constant times pressure everywhere; there is no stick and no partial slip.",
    ),
    (
        "Smooth film",
        "The film is that of smooth surfaces. Roughness does not steer the flow; where the film is thinner than the "
        "roughness is high, thickness is a mean and not a map.",
    ),
    (
        "Isothermal",
        "No heat: at high sliding speed and pressure the oil is warmer and thinner than here; notes say where that is "
        "likely to matter, as they do for pressures, shear stresses and films beyond what the laws describe. Shear "
        "laws limit the sliding part of the shear stress only, and do not act on the film's thickness.",
    ),
    (
        "Incompressible oil",
        "Heavily loaded incompressible films have a pressure spike that sharpens without limit: their thickness and "
        "friction are sound, the height of the spike is not. Dowson-Higginson density bounds it.",
    ),
    ("Line contact", "The lubricated kinds know cylinders: no side leakage, and nothing varies along y but roughness."),
    (
        "Immediate detachment",
        "What yields and reaches the surface is gone in the same cycle. No cracks, no fatigue, no "
        "particles that stay in "
        "the contact; the wear volume of the criterion alone is orders of magnitude too large, so volume is Archard's.",
    ),
    (
        "Particle size by mesh",
        "The mean by number follows the cell, since many particles are one cell. Means by volume "
        "converge: trust those, "
        "and look at the scene wear-mesh-convergence.",
    ),
    (
        "Tribofilm as a layer",
        "One uniform elastic layer whose hardness follows from its mean thickness (or cell by "
        "cell); hardness curves are "
        "inputs, calibrated on two numbers of the literature.",
    ),
    (
        "Generated surfaces",
        "The measured surfaces of the thesis are not public: statistics agree, individual asperities do not. Results "
        "carry a spread over seeds for that reason.",
    ),
)


def build() -> Page:
    """The guide as one page."""
    return Page("guide", "Guide", LEAD, [*_using(), *_scenes(), *_options(), *_theory(), *_contributing()])


def _using() -> list[Section]:
    files = (
        ("scene.toml", "the scene as it was understood, in SI units; it runs again and gives the same bits"),
        ("summary.json", "the figures; units are in the names"),
        ("results.nc", "all arrays with units: xarray, h5py, any netCDF reader"),
        ("volume.vtu", "stresses below the surface for ParaView"),
        ("figures/, report.html", "pictures as PNG and PDF, and one page with all"),
        ("checkpoint.bin", "while it runs; --resume goes on from it to the same bits"),
    )
    codes = (
        ("0", "done"),
        ("2", "a mistake in scene or options: one line each, nothing written"),
        ("3", "not converged: what exists is kept, and where it stopped is said"),
        ("4", "results cannot be written or read: disk full, folder in use, damaged file"),
        ("130", "interrupted; the same command with --resume goes on"),
    )
    return [
        Section(
            "First steps",
            _code(FIRST_STEPS) + table(("file of a run", "what it is"), files) + table(("exit code", "meaning"), codes),
        ),
        Section(
            "Your own surfaces",
            text(
                "Any common instrument's file will do. Read it, look at its statistics, then give its path in a scene: "
                "paths are relative to the scene file. A measured map is levelled, filled where points are "
                "missing, cut, "
                "filtered and resampled to the grid, in that order."
            )
            + _code(OWN_SURFACES)
            + text(
                "The map must be at least as large as the grid, or be mirrored; a wave needs several "
                "cells. Two maps of "
                "different spacing are brought to the finer one."
            ),
        ),
        Section(
            "Sweeps",
            text(
                "Every combination of values of any keys. Points run on all cores, or on a Dask cluster; a worker that "
                "dies is replaced. With --resume a sweep goes on and values may be added: no finished "
                "point is computed "
                "again. All figures end up in sweep.nc with the swept keys as dimensions, in sweep.csv and in a figure."
            )
            + _code(SWEEP)
            + text(
                "In Python it is bem.sweeps.run_sweep; values are ranges first:last:count, log:first:last:count, "
                "whole numbers first:last, lists, or @FILE with a value on each line. An index reaches into lists, "
                "variants[0].cells; the same keys stand behind --set."
            ),
        ),
        Section(
            "From Python",
            text("The same without files; everything public is importable from bem.")
            + _code(PYTHON)
            + _code(PYTHON_RUN),
        ),
    ]


def _scenes() -> list[Section]:
    rows = [(name, item["kind"], item["description"], item.get("redoes", "")) for name, item in library().items()]
    return [
        Section(
            "Built-in scenes",
            text("bem run NAME runs one; bem scenes --show NAME prints it, to start from.")
            + table(("name", "kind", "what it is", "redoes"), rows),
        ),
    ]


def _options() -> Iterator[Section]:
    intro = text(
        "Every key of every kind. Numbers are in SI units, quantities in quotes carry their unit; what is not given "
        "has the default. bem new KIND writes all this as a commented scene."
    )
    yield Section("Options", intro)
    for kind in kind_names():
        found = get_kind(kind)
        body = text(found.title[0].upper() + found.title[1:] + ".")
        body += table(("key", "default", "allowed", "effect"), list(_keys(found.model, "")))
        try:
            start = scene_template(kind)
        except InputError:
            start = ""
        if start:
            body += f"<details><summary>bem new {html.escape(kind)}</summary>{_code(start)}</details>"
        yield Section(f"Kind {kind}", body, level=3)


def _keys(model: Any, prefix: str) -> Iterator[tuple[str, str, str, str]]:
    """Rows of a table of keys, those of inner tables below their own."""
    shown: set[str] = set()
    for key, field in _fields(model).items():
        tables = _tables(field.annotation) or _laws_at(field)
        name = f"{prefix}{key}"
        if key == "kind" and not prefix:
            continue
        default = "" if tables else _default(field).replace("(not set)", "-").replace("...", "required")
        yield name, default, _about(field), effect_of(name)
        if key == "layers" or (key in ("material", "layer", "surface") and prefix not in ("lower.", "layer.")):
            continue  # said once, for the lower body's layer
        if len(tables) > 1:
            tags = [tag for inner in tables for tag in _tags(inner)]
            shown.add(f"{name}.kind")
            yield f"{name}.kind", "", "one of " + ", ".join(tags), effect_of(f"{name}.kind")
        for inner in tables:
            for row in _keys(inner, f"{name}."):
                if row[0] not in shown:
                    shown.add(row[0])
                    yield row


def _laws_at(field: Any) -> list[Any]:
    """Laws with parameters that may stand at a key, where these do not stand beside it."""
    keys = [item for item in field.metadata if isinstance(item, LawKey) and not item.beside]
    return [law for key in keys for law in laws_of(key.family).values() if law.parameters()]


def _tags(table: Any) -> list[str]:
    return [table.name] if issubclass(table, Law) else list(_literals(_fields(table)["kind"].annotation))


def effect_of(name: str) -> str:
    """What a dotted key does; the same word may mean different things in different tables."""
    *tables, key = name.split(".")
    return EFFECTS.get(f"{tables[-1]}.{key}" if tables else key, EFFECTS.get(key, ""))


def _tables(annotation: Any) -> list[Any]:
    """The models that may stand at a key."""
    annotation = _without_none(annotation)
    if _fields(annotation):
        return [annotation]
    return [model for item in typing.get_args(annotation) for model in _tables(_unwrap(item)[0])]


def _theory() -> list[Section]:
    body = "".join(
        f"<h4>{html.escape(title)}</h4><pre class='formula'>{_formula(formula)}</pre>"
        f"<p><b>Source:</b> {html.escape(source)}. "
        + (f"<b>Errata:</b> {html.escape(errata)} " if errata else "")
        + f"<b>In:</b> <code>{html.escape(place)}</code></p>"
        for title, formula, source, errata, place in THEORY
    )
    conventions = text(
        "x is the sliding direction, z points into the body. Pressure is positive in compression, stress in tension, "
        "displacement into the body, height out of it; friction on the lower body acts along +x. "
        "The models are those of "
        "A. Akchurin, Generation of Wear Particles in Lubricated Contacts during Running-In (thesis, Twente, 2017); "
        "errata found in it stand beside each formula."
    )
    return [
        Section("Theory", conventions + body),
        Section(
            "Laws",
            text("All that have a name, with their parameters.")
            + table(("key", "name", "what it is", "parameters"), list(_laws())),
        ),
        Section("Limits of validity", table(("assumption", "what it means"), LIMITS)),
    ]


def _laws() -> Iterator[tuple[str, str, str, str]]:
    """Rows of the registry of laws."""
    for family in FAMILIES:
        for name, law in laws_of(family).items():
            words = []
            for key, about in law.parameters().items():
                default = "required" if key in law.required() else f"default {law.__dataclass_fields__[key].default}"
                unit = f" [{about.unit}]" if about.unit else ""
                source = f"; {about.source}" if about.source else ""
                words.append(f"{key}{unit}: {about.meaning} ({default}, {about.allowed}{source})")
            yield family, name, " ".join((law.__doc__ or "").split()), ". ".join(words)


def _contributing() -> list[Section]:
    parts = (
        (
            "A viscosity law",
            "One file, of the package or your own: messages, scenes, bem schema and the table of laws know it once it "
            "is registered.",
            LAW,
        ),
        ("The same in a scene", "A parameter takes any unit of its dimension, in quotes.", LAW_SCENE),
        (
            "Your file and the command line",
            "BEM_LAWS names files or modules (several are separated as in PATH). A package of yours that is installed "
            "needs no more than an entry point of group bem.laws that names the module. A script registers, then calls "
            "bem.run_scene.",
            LAW_LOAD,
        ),
        ("A wear criterion", "One file likewise.", CRITERION),
        ("A reader", "One file and a test.", READER),
        ("A kernel and its gate", "The kernel, its gate, and an entry in the registry.", KERNEL),
    )
    intro = text(
        "A kernel knows no solver, a solver knows no file format, a plot never solves, the command "
        "line is thin; imports "
        "run one way, and a test holds that. Every tolerance says why it is what it is. A kind of scene is one file in "
        "bem/scenes/kinds/ (its docstring says what goes in), a figure one function in "
        "bem/plots/figures/, a command one "
        "file in bem/cli/. make test-fast and make lint before every commit."
    )
    return [
        Section("Contributing", intro),
        *(Section(title, text(words) + _code(snippet), level=3) for title, words, snippet in parts),
    ]


def _code(words: str) -> str:
    return f"<pre>{html.escape(words.strip())}</pre>"


def _formula(words: str) -> str:
    """Plain text with Greek letters and raised exponents."""
    greek = {"nu": "ν", "pi": "π", "mu": "μ", "rho": "ρ", "tau": "τ", "alpha": "α", "sigma": "σ", "beta": "β"}
    shown = html.escape(words)
    for name, letter in greek.items():
        shown = re.sub(rf"(?<![A-Za-z]){name}(?![a-z])", letter, shown)
    shown = re.sub(r"\bintegral\b", "∫", shown)
    shown = re.sub(r"\bdU\b", "ΔU", re.sub(r"\bdV\b", "ΔV", shown))
    shown = re.sub(r"\btheta\b", "θ", re.sub(r"\blambda\b", "λ", shown))
    shown = re.sub(r"\^\(3/2\)", "<sup>3/2</sup>", shown)
    shown = re.sub(r"\^(-\dx|-?\d\.\d+|\d|z)", r"<sup>\1</sup>", shown)
    return shown.replace("&lt;=", "≤").replace("&gt;=", "≥").replace(" * ", " ∗ ")


__all__: Sequence[str] = ("EFFECTS", "SNIPPETS", "build")
