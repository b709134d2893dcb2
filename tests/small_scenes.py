"""Small scenes that several tests run: a contact, a patch in mixed lubrication, a film, wear."""

CONTACT = {
    "kind": "contact",
    "name": "small",
    "seed": 3,
    "grid": {"shape": 16, "spacing": "0.5 um", "periodic": True},
    "lower": {
        "material": "steel-disk",
        "surface": {"kind": "generated", "rms_height": "100 nm", "correlation_length": "2 um"},
    },
    "contact": {"mean_pressure": "80 MPa", "behaviour": "capped"},
}

OIL = {
    "viscosity": "0.36 Pa*s",
    "pressure_viscosity": "25 1/GPa",
    "density_law": "incompressible",
    "shear_law": "limited",
}
"""Oil of the thesis' papers A and D, with the laws that `Lubricant` has by default."""

PATCH = {
    "lower": {
        "material": "steel-disk-110HV",
        "surface": {"kind": "generated", "rms_height": "120 nm", "correlation_length": "2 um"},
    },
    "upper": {"material": "steel-cylinder"},
    "contact": {"radius": "2 mm", "width": "6 mm", "loads": ["5.5 N"], "boundary_friction": 0.15},
    "oil": OIL,
    "grid": {"shape": [64, 32], "spacing": "0.8 um", "periodic": [False, True]},
}

FILM = {
    "kind": "film",
    "lower": {"material": {"youngs_modulus": "210 GPa", "poissons_ratio": 0.3}},
    "upper": {"material": {"youngs_modulus": "210 GPa", "poissons_ratio": 0.3}},
    "cylinder": {"radius": "2 mm", "width": "6 mm", "load": "5.5 N"},
    "oil": OIL,
}
"""Wants `motion` and `march`."""

WEAR = """
kind = "wear"
repetitions = 1
[lower]
material = "steel-disk"
surface = { kind = "generated", rms_height = "120 nm", correlation_length = "0.4 um" }
[upper]
material = "steel-cylinder"
surface = { kind = "generated", rms_height = "30 nm", correlation_length = "0.3 um" }
[cylinder]
radius = "2 mm"
width = "6 mm"
loads = ["2.5 N"]
friction = 0.16
[domain]
cells = 40
lengths = "4 um"
[depths]
count = 20
spacing = "95 nm"
[cycles]
count = 12
settled = 4
"""


def oiled_ball(kind, ball, oil, **tables):
    """A steel ball on a steel flat with oil between them, as the kinds of point films take it."""
    steel = {"material": "steel-52100"}
    return {"kind": kind, "lower": steel, "upper": steel, "ball": ball, "oil": oil | _COMPRESSED, **tables}


_COMPRESSED = {"density_law": "dowson_higginson"}


def pressed_ball(kind, cells):
    """A steel ball on a steel flat under 20 N, as kinds with stick and slip take it."""
    return {
        "kind": kind,
        "grid": {"shape": cells, "lengths": "300 um"},
        "lower": {"material": "steel-52100"},
        "upper": {"material": "steel-52100"},
        "shape": {"kind": "sphere", "radius": "10 mm"},
        "contact": {"load": "20 N"},
    }
