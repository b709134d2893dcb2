"""Crystals and surfaces under tension: what is not known of them is refused in the words of each."""

import pytest

from bem import Body, Grid, InputError, Layer, Material, displacement_operator
from bem.contact import sensitivities, solve_contact
from bem.kernels import coefficients, spectral
from bem.kernels.loads import Load
from bem.materials import CATALOGUE

STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3)
SPECIAL = {
    "crystal": CATALOGUE["silicon-crystal"].material,
    "surface (under )?tension": Material("gel", youngs_modulus=10e3, poissons_ratio=0.45, surface_tension=0.03),
}
FREE, BOTH = Grid((8, 8), (1e-6, 1e-6)), Grid((8, 8), (1e-6, 1e-6), periodic=(True, True))
UNKNOWN = {
    "stresses": lambda body: coefficients.stress_coefficients(FREE, body, 1e-6, Load.NORMAL),
    "stresses of waves": lambda body: spectral.stress_response(BOTH, body, 1e-6, Load.NORMAL),
    "in plane": lambda body: coefficients.in_plane_coefficients(FREE, body),
    "in plane of waves": lambda body: spectral.in_plane_response(BOTH, body),
    "traction": lambda body: coefficients.surface_coefficients(FREE, body, Load.TANGENTIAL),
    "friction": lambda body: displacement_operator(FREE, body, friction=0.1),
}


@pytest.mark.parametrize("words", SPECIAL)
@pytest.mark.parametrize("name", UNKNOWN)
def test_responses_that_no_kernel_knows_are_refused(words: str, name: str) -> None:
    with pytest.raises(InputError, match=f"not known of a {words}"):
        UNKNOWN[name](Body(SPECIAL[words]))


@pytest.mark.parametrize("words", SPECIAL)
def test_layers_are_refused(words: str) -> None:
    for body, layer in ((SPECIAL[words], STEEL), (STEEL, SPECIAL[words])):
        with pytest.raises(InputError, match=f"{words} in a body with layers"):
            Body(body, layer=Layer(layer, 1e-6))


def test_sensitivities_of_a_contact_under_tension_are_refused() -> None:
    gap = (FREE.x[:, None] ** 2 + FREE.y**2) / 2e-5
    operator = displacement_operator(FREE, Body(SPECIAL["surface (under )?tension"]))
    solution = solve_contact(gap, operator, load=1e-9)
    with pytest.raises(InputError, match="surface tension"):
        sensitivities(solution, gap, operator)
