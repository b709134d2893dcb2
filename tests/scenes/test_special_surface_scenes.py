"""Crystals and surfaces under tension in scenes: refusals that both have."""

import pytest

from bem import InputError, load_scene
from bem.scenes.starts import start_scene

SPECIAL = {
    "is a crystal": "copper-crystal",
    "has surface tension": {"youngs_modulus": "5 kPa", "poissons_ratio": 0.49, "surface_tension": "31 mN/m"},
}


def pressed(material, **tables):
    return {
        "kind": "contact",
        "grid": {"shape": 32, "lengths": "60 um"},
        "lower": {"material": material},
        "shape": {"kind": "sphere", "radius": "100 um"},
        "contact": {"load": "1 uN"},
    } | tables


@pytest.mark.parametrize("words", SPECIAL)
@pytest.mark.parametrize(
    ("tables", "message"),
    [
        ({"contact": {"load": "1 uN", "friction": 0.1}}, "contact.friction, and lower.material {}"),
        ({"outputs": {"von_mises": True}}, "stresses below the surface of lower, whose material {}"),
    ],
)
def test_a_contact_under_pressure_alone_is_all_that_they_have(words, tables, message):
    with pytest.raises(InputError) as raised:
        load_scene(pressed(SPECIAL[words], **tables))
    assert message.format(words) in str(raised.value)


@pytest.mark.parametrize("words", SPECIAL)
def test_layers_on_them_are_refused(words):
    lower = {"material": SPECIAL[words], "layer": {"material": "TiN", "thickness": 1e-6}}
    with pytest.raises(InputError, match=f"layers on a body whose material {words}"):
        load_scene(pressed("TiN") | {"lower": lower})


@pytest.mark.parametrize("words", SPECIAL)
def test_other_kinds_refuse_them(words):
    start = start_scene("partial-slip")
    with pytest.raises(InputError, match=rf"lower\.material {words}"):
        load_scene(start | {"lower": start["lower"] | {"material": SPECIAL[words]}})
