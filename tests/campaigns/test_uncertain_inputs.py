"""Errors by uncertain inputs in results: by derivatives, by repeated runs, beside the figures and in the dataset."""

import dataclasses
import math

import numpy as np
import pytest

from bem import InputError, load_scene, plan_scene
from bem.campaigns import campaign_of, compute
from bem.campaigns.uncertain import with_inputs
from bem.errors import Status
from bem.plots.report import with_error
from bem.plots.tables import figure_tables, input_share_tables
from bem.scenes import get_kind
from bem.scenes.context import PlainContext
from bem.scenes.uncertain import moved, value_of

CONTACT = {
    "kind": "contact",
    "grid": {"shape": 48, "spacing": "1 um"},
    "lower": {
        "material": {"youngs_modulus": "200 GPa", "poissons_ratio": 0.3},
        "surface": {"kind": "generated", "rms_height": "50 nm", "correlation_length": "6 um"},
    },
    "shape": {"kind": "sphere", "radius": "0.5 mm"},
    "contact": {"load": "0.5 N", "tolerance": 1e-12},
}
KEYS = {
    "contact.load": "1 %",
    "lower.surface.rms_height": "1 %",
    "lower.material.youngs_modulus": "2 GPa",
    "lower.material.poissons_ratio": 0.002,
    "shape.radius": "1 %",
}
FIGURES = ("contact_area_fraction", "max_pressure", "mean_gap", "approach", "mean_contact_pressure")


def outcome_of(table):
    return compute(campaign_of(load_scene(table))).outcome


def test_the_share_of_each_input_in_a_figures_variance_is_shown():
    found = outcome_of(CONTACT | {"uncertain": {key: KEYS[key] for key in ("contact.load", "shape.radius")}})
    shares = found.summary["input_shares"]["max_pressure_Pa"]
    changes = {
        key: float(found.variables[f"max_pressure_change_{key.replace('.', '_')}"].values) ** 2 for key in shares
    }
    for key, share in shares.items():
        assert share == pytest.approx(changes[key] / sum(changes.values()), rel=1e-12)
    (table,) = input_share_tables(found.summary)
    assert set(table.head) == {"figure", "contact.load", "shape.radius"}
    alone = outcome_of(CONTACT | {"uncertain": {"contact.load": "1 %"}})
    assert "input_shares" not in alone.summary


def test_derivatives_of_a_contact_are_those_of_runs_close_by():
    scene = get_kind("contact").resolved(load_scene(CONTACT | {"uncertain": KEYS}))
    found = outcome_of(CONTACT | {"uncertain": KEYS})
    for key in KEYS:
        deviation = {"lower.material.youngs_modulus": 2e9, "lower.material.poissons_ratio": 0.002}.get(key)
        step = 1e-4 if deviation is None else 0.01
        deviation = deviation or 0.01 * _at(scene, key)
        ends = [
            compute(campaign_of(moved(scene, key, deviation, side * step).model_copy(update={"uncertain": None})))
            for side in (-1, 1)
        ]
        name = key.replace(".", "_")
        for figure in FIGURES:
            before, after = (float(end.outcome.variables[figure].values) for end in ends)
            change = float(found.variables[f"{figure}_change_{name}"].values)
            size = abs(float(found.variables[figure].values)) * 0.01
            assert change == pytest.approx((after - before) / (2 * step), rel=1e-3, abs=1e-3 * size), (key, figure)


def _at(scene, key):
    for part in key.split("."):
        scene = getattr(scene, part)
    return scene


def test_independent_inputs_add_in_quadrature_and_stand_behind_the_figure():
    found = outcome_of(CONTACT | {"uncertain": KEYS})
    changes = [found.variables[f"approach_change_{key.replace('.', '_')}"].values for key in KEYS]
    total = math.sqrt(sum(float(change) ** 2 for change in changes))
    assert found.summary["approach_input_scatter_m"] == pytest.approx(total, rel=1e-12, abs=0)
    _, shown = with_error("approach_m", dict(found.summary))
    assert "(numerical), ±" in shown
    assert shown.endswith("(inputs)")
    assert "approach_input_scatter" in found.variables
    assert "approach_input_scatter_m" not in outcome_of(CONTACT).summary


def test_keys_without_a_derivative_are_run_on_both_sides():
    settings = ["grid.shape=96", 'uncertain={"grid.spacing"="1 %"}']
    found = compute(campaign_of(load_scene("uncertain-contact", settings))).outcome
    # the load is the mean pressure on the area of the cells
    assert found.summary["load_input_scatter_N"] == pytest.approx(0.02 * found.summary["load_N"], rel=1e-3)


def test_a_repeated_run_that_does_not_converge_gives_no_scatter():
    """Only the case itself converges, whose spacing is the scene's."""
    kind = get_kind("contact")

    def run(scene, context):
        record = kind.run(scene, context)
        return record if scene.grid.spacing == 1e-6 else dataclasses.replace(record, status=Status.STALLED)

    scene = kind.resolved(load_scene(CONTACT | {"uncertain": {"grid.spacing": "1 %"}}))
    context = PlainContext(scene.seed)
    record = kind.run(scene, context)
    found = with_inputs(dataclasses.replace(kind, run=run), scene, record, context, lambda one: PlainContext(one.seed))
    assert "grid.spacing" not in found.input_changes
    assert [note.code for note in context.notes].count("input-unpropagated") == 1


def test_curves_have_a_scatter_at_every_speed():
    settings = ["repetitions=1", "speeds.count=3", "grid.shape=64", "film.points=400", 'sharing.models=["elastic"]',
                'uncertain={"oil.viscosity"="5 %","contact.boundary_friction"="0.01"}']  # fmt: skip
    found = compute(campaign_of(load_scene("stribeck-mineral-oil", settings))).outcome
    scatter = found.summary["friction_input_scatter"]
    assert len(scatter) == 3
    # boundary lubrication has the scatter of its coefficient, full film that of the viscosity
    assert scatter[0] == pytest.approx(0.01, rel=0.02)
    change = found.variables["friction_change_oil_viscosity"].values.ravel()
    assert scatter[-1] == pytest.approx(abs(change[-1]), rel=1e-9)
    assert np.all(found.variables["friction_change_contact_boundary_friction"].values >= 0)
    (table, *_) = figure_tables(dict(found.summary), ["speed_m_s", "friction"])
    assert all("(inputs)" in row[1] for row in table.rows)


@pytest.mark.parametrize(
    ("name", "settings", "key", "value", "figure", "rel"),
    [
        ("adhesive-sphere", ["grid.shape=48", "contact.approach=0.0", "contact.approach_path=[]"],
         "contact.adhesion.work", 0.05, "load", 1e-3),
        ("coated-sphere", ["grid.shape=24", 'outputs={"von_mises"=false}'],
         "lower.layer.material.youngs_modulus", None, "max_pressure", 1e-3),
        ("wear-cylinder-scar", ["cycles.count=4", "cycles.settled=2"],
         "wear.criterion.specific_wear_rate", 1e-15, "worn_volume_per_cycle", 1e-3),
        ("stribeck-mineral-oil",
         ["repetitions=1", 'speeds={values=["0.1 m/s"]}', "grid.shape=48", "film.points=200",
          'sharing.models=["elastic"]', 'contact.boundary_friction={kind="speed_dependent",static_friction=0.2,'
          'kinetic_friction=0.1,speed_scale="0.1 m/s"}'],
         "contact.boundary_friction.static_friction", 0.2, "friction", 1e-3),
        ("stribeck-mineral-oil",
         ["repetitions=1", 'speeds={values=["3 m/s"]}', "grid.shape=48", "film.points=200",
          'sharing.models=["elastic"]', 'oil.shear_law="eyring"', 'oil.shear_stress_limit="5 MPa"', 'thermal="off"'],
         "oil.shear_stress_limit", 5e6, "friction", 0.02),
    ],
)  # fmt: skip
def test_parameters_of_laws_and_layers_are_uncertain_inputs(name, settings, key, value, figure, rel):
    """They were refused as no quantity. The change is that of scenes whose files have the parameter changed."""
    quiet = [*settings] if name.startswith("wear") else [*settings, "outputs.errors=false"]
    if value is None:
        value = value_of(get_kind("contact").resolved(load_scene(name, quiet)), key)
    deviation, step = 0.02 * value, 0.25
    found = compute(campaign_of(load_scene(name, [*quiet, f'uncertain={{"{key}"="2 %"}}']))).outcome
    ends = [
        compute(campaign_of(load_scene(name, [*quiet, f"{key}={value + side * step * deviation!r}"]))).outcome
        for side in (-1, 1)
    ]
    before, after = (float(np.ravel(end.variables[figure].values)[0]) for end in ends)
    change = float(np.ravel(found.variables[f"{figure}_change_{key.replace('.', '_')}"].values)[0])
    assert before != after
    assert change == pytest.approx((after - before) / (2 * step), rel=rel, abs=0)


SCAR = ["cycles.count=4", "cycles.settled=2", 'uncertain={"wear.criterion.specific_wear_rate"="2 %"}']


def test_a_case_with_another_law_has_no_error_by_a_parameter_of_the_first():
    """It stopped the case: the parameter is none of its keys."""
    energy = '{name="energy",criterion={kind="energy",energy_wear_rate=1e-14,distance="107 mm"}}'
    laws = [f'variants=[{{name="archard"}},{energy}]', "cylinder.friction=0.1"]
    found = compute(campaign_of(load_scene("wear-cylinder-scar", [*SCAR, *laws]))).outcome
    volume = found.variables["worn_volume_per_cycle"].values.ravel()
    change = found.variables["worn_volume_per_cycle_change_wear_criterion_specific_wear_rate"].values.ravel()
    assert change[0] == pytest.approx(0.02 * volume[0], rel=1e-6, abs=0)
    assert volume[1] > 0
    assert np.isnan(change[1])


def test_a_key_in_a_list_that_cases_replace_is_refused_before_the_run():
    laws = 'variants=[{name="archard",criterion={kind="archard",specific_wear_rate=1e-15,distance="107 mm"}}]'
    key = 'uncertain={"variants[0].criterion.specific_wear_rate"="2 %"}'
    with pytest.raises(InputError, match="take their own values from this list"):
        plan_scene("wear-cylinder-scar", ["cycles.count=4", "cycles.settled=2", laws, key])
