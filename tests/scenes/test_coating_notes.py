"""What scenes of coated bodies say: thickness, residual stress, hardness in HV, keys and sources."""

import pytest
from pydantic import TypeAdapter, ValidationError

from bem import InputError, load_scene, plan_scene
from bem.campaigns.cited import catalogue_sources
from bem.notes import has_code
from bem.notes.checks import LAYER_THICKNESS_UNUSUAL, RESIDUAL_STRESS, TRIBOFILM_ON_COATING
from bem.plots.tables import input_share_tables
from bem.scenes.checks import examine, scene_warnings
from bem.scenes.common import PositivePressure
from bem.scenes.uncertain import deviations

STACK = 'lower.layers=[{{material="CrN",thickness="{}"}},{{material="Cr",thickness="0.3 um"}}]'


def notes(name, *settings):
    scene, _ = plan_scene(name, list(settings))
    return scene_warnings(examine(scene))


def stack(thickness="3 um", *settings):
    return notes("coated-sphere", "lower.layer=", STACK.format(thickness), *settings)


@pytest.mark.parametrize(
    ("thickness", "unusual"), [("3 um", False), ("20 um", True), ("3 mm", True), ("10 um", False), ("0.1 um", True)]
)
def test_a_thickness_outside_the_catalogues_range_is_a_caution(thickness, unusual):
    assert has_code(stack(thickness), LAYER_THICKNESS_UNUSUAL) is unusual


def test_a_residual_stress_under_a_tribofilm_speaks_of_no_stresses_of_that_kind():
    coat = 'lower.layer={material="dlc",thickness="2 um",residual_stress="-1 GPa"}'
    for name, words in (("tribofilm-ball", "no result of this kind"), ("coated-sphere", "von Mises")):
        (note,) = [one for one in notes(name, coat) if one.code == RESIDUAL_STRESS.code]
        assert words in str(note)
        assert "layers[0] (dlc)" in str(note)
    (growth,) = [
        one
        for one in notes("tribofilm-ball", coat)
        if one.code == TRIBOFILM_ON_COATING.code and one.values["reason"] == "growth"
    ]
    assert str(growth).count("steel") == 1


def test_vickers_hardness_is_a_pressure_and_other_scales_are_not():
    hardness = TypeAdapter(PositivePressure)
    assert hardness.validate_python("800 HV") == pytest.approx(7.84532e9, rel=1e-12)
    assert hardness.validate_python("2000 HV0.05") == pytest.approx(19.6133e9, rel=1e-12)
    with pytest.raises(ValidationError, match="convert to HV first"):
        hardness.validate_python("60 HRC")


def test_a_key_without_the_layers_number_names_the_outermost_layer():
    scene, _ = plan_scene("coated-sphere", ["lower.layer=", STACK.format("3 um")])
    scene = scene.model_copy(update={"uncertain": {"lower.layers.thickness": "5 %"}})
    with pytest.raises(InputError, match=r'did you mean "lower\.layers\[0\]\.thickness"'):
        deviations(scene)


def test_shares_of_layers_say_that_they_are_of_all_layers_and_small_ones_are_zero():
    shares = {"layer_max_von_mises_Pa": {"a": 2.02e-28, "b": 1.0}, "load_N": {"a": 0.25, "b": 0.75}}
    summary = {"input_shares": shares, "layer_material": ["CrN", "Cr"]}
    (table,) = input_share_tables(summary)
    assert table.rows == (
        ("layer max von Mises (all layers together)", "100 %", "0 %"),
        ("load", "75 %", "25 %"),
    )


def test_profiles_of_the_catalogue_have_their_sources():
    found = catalogue_sources(load_scene("wheel-rail"))
    assert "Netter" in found["profile s1002"]
    assert "EN 13674" in found["profile 60e1"]


def test_refusals_say_that_a_table_of_constants_is_allowed_and_what_is_not_given():
    with pytest.raises(
        InputError, match="allowed: a table with youngs_modulus, poissons_ratio and other constants, or one of"
    ):
        plan_scene("coated-sphere", ['lower.material="tool-steel"'])
    with pytest.raises(InputError, match="none of correlation_length, hurst is given"):
        plan_scene("coated-sphere", ['lower.surface={kind="generated",rms_height="10 nm"}'])


def test_a_list_of_another_length_says_what_its_values_are():
    with pytest.raises(InputError, match=r"3 values; allowed: 2 \(The two times between which the wear depth"):
        plan_scene("tribofilm-ball", ['rubbing.report=["1 h","2 h","3 h"]'])
