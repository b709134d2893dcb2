"""Hints for keys and names that users expect, and messages that name the place to write instead."""

import pytest

from bem.cli.new import _check_kind
from bem.errors import InputError
from bem.runs import plan_scene


@pytest.mark.parametrize(
    ("scene", "setting", "message"),
    [
        ("coated-sphere", 'lower.coating="dlc"', "lower.coating: unknown key; write layer = "),
        ("hertz-sphere", 'shape.diameter="1 mm"', "shape.diameter: unknown key; write radius, half of the diameter"),
        ("hertz-sphere", 'lower.material="chromium"', 'did you mean "Cr"?'),
        ("hertz-sphere", 'contact.load="-1 N"', "negative loads in contact.load_path"),
        ("hertz-sphere", 'contact.adhesion={work="50 mJ/m^2"}', "law, taken as no kind is given, without range"),
        (
            "multilayer-coating",
            'uncertain={"lower.layer.thickness"="5 %"}',
            'did you mean "lower.layers[0].thickness"?',
        ),
        ("tribofilm-ball", 'rubbing.report=["0 s", "1 s", "2 s"]', "3 values; allowed: 2"),
        (
            "hertz-sphere",
            'contact={load="1 N",rolling_speed="1 m/s"}',
            "steel-52100 without relaxation data; allowed: relaxation =",
        ),
    ],
)
def test_a_mistake_is_answered_by_what_to_write(scene, setting, message):
    with pytest.raises(InputError) as caught:
        plan_scene(scene, [setting])
    assert message in str(caught.value)


def test_words_for_what_a_kind_can_do_name_the_built_in_scene():
    for word, scene in (("adhesion", "adhesive-sphere"), ("hysteresis", "sliding-hysteresis")):
        with pytest.raises(InputError, match=f'built-in scene "{scene}"'):
            _check_kind(word)


def test_quotes_around_a_dotted_key_of_uncertain_are_no_part_of_it():
    for key in ('uncertain."contact.load"', "uncertain.contact.load"):
        assert plan_scene("hertz-sphere", [f'{key}="5 %"'])[0].uncertain == {"contact.load": "5 %"}
