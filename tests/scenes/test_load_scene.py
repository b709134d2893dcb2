"""Scenes: every mistake is one message that names key, value, what is allowed and the nearest right spelling."""

import copy
import os
import tomllib

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bem.elements.element import load_element
from bem.errors import InputError
from bem.runs import plan_scene
from bem.scenes import dump_scene, get_kind, kind_names, load_scene
from bem.scenes.load import scenes_over, unit_at
from bem.scenes.planner import available_memory

SCENE = {
    "kind": "contact",
    "grid": {"shape": 32, "spacing": "1 um", "periodic": True},
    "lower": {"material": "steel-disk"},
    "upper": {"material": "steel-cylinder"},
    "contact": {"mean_pressure": "10 MPa"},
}


def changed(**keys):
    """The scene with dotted keys (dots written as two underscores) changed."""
    data = copy.deepcopy(SCENE)
    for key, value in keys.items():
        *path, last = key.split("__")
        table = data
        for part in path:
            table = table.setdefault(part, {})
        table[last] = value
    return data


def messages(data):
    with pytest.raises(InputError) as caught:
        plan_scene(data)
    return caught.value.messages


def refusal(data):
    """Messages of the InputError, None for a good scene; any other exception is a failure of the test."""
    try:
        plan_scene(data)
    except InputError as error:
        return error.messages
    return None


def test_the_plain_scene_is_good():
    scene, _ = plan_scene(SCENE)
    assert scene.grid.spacing == (1e-6, 1e-6)
    assert scene.grid.periodic == (True, True)


@pytest.mark.parametrize(
    ("data", "parts"),
    [
        (changed(kind="contct"), ["kind", '"contct"', 'did you mean "contact"?']),
        (changed(sead=1), ["sead", "unknown key", 'did you mean "seed"?']),
        (changed(load=3), ["load: unknown key - it is a key of [contact]"]),
        (changed(contact__radius="5 mm"), ["contact.radius", "it is a key of [shape]"]),
        (changed(upper__shape={"kind": "sphere"}), ["upper.shape", "it is a key at the top of the scene: [shape]"]),
        (changed(grid__shpae=1), ["grid.shpae", 'did you mean "shape"?', "spacing"]),
        (changed(contact__load="10 nm"), ["contact.load", '"10 nm"', "is not a force"]),
        (changed(contact__behaviour="elstic"), ["contact.behaviour", '"elstic"', 'did you mean "elastic"?', '"capped"']),  # noqa: E501
        (changed(lower__material="steel-disc"), ["lower.material", "steel-disc", 'did you mean "steel-disk"?']),
        (changed(lower__material={"youngs_modulus": "210 GPa", "poissons_ratio": 0.5}), ["lower.material.poissons_ratio", "0.5", "less than 0.5"]),  # noqa: E501
        (changed(lower__material={"youngs_modulus": "210 GPa", "poissons_ratio": -1}), ["poissons_ratio", "-1", "greater than -1"]),  # noqa: E501
        (changed(lower__material={"poissons_ratio": 0.3}), ["lower.material.youngs_modulus", "missing", "a pressure"]),
        (changed(lower__surface={"kind": "genrated"}), ["lower.surface.kind", "genrated", 'did you mean "generated"?']),
        (changed(lower__surface={"rms_height": "1 nm"}), ["lower.surface.kind", "missing", '"measured"']),
        (changed(lower__surface={"kind": "generated", "rms_height": "1 nm"}), ["lower.surface", "correlation_length", "hurst"]),  # noqa: E501
        (changed(lower__surface={"kind": "generated", "rms_height": 1e-9, "hurst": 0.8, "skewness": 3, "kurtosis": 4}), ["kurtosis 4", "skewness 3"]),  # noqa: E501
        (changed(lower__surface={"kind": "measured", "path": "nowhere.di"}), ["lower.surface.path", "nowhere.di", "no such file"]),  # noqa: E501
        (changed(grid__shape=0), ["grid.shape = 0", "greater than or equal to 1"]),
        (changed(grid__shape=[32, -1]), ["grid.shape[1] = -1"]),
        (changed(grid__shape=[32, 32, 32]), ["grid.shape", "3 values; allowed: 2"]),
        (changed(grid__shape=32.5), ["grid.shape = 32.5", "integer"]),
        (changed(grid__spacing="0 nm"), ["grid.spacing", "greater than 0 m"]),
        (changed(grid__spacing=float("nan")), ["grid.spacing", "not finite"]),
        (changed(grid__periodic="yes"), ["grid.periodic"]),
        (changed(contact__approach="1 nm"), ["contact", "mean_pressure and approach", "exactly one of"]),
        (changed(contact=5), ["contact = 5", "not a table"]),
        (changed(contact__behaviour="capped", contact__mean_pressure="3 GPa"), ["contact.mean_pressure", "3 GPa is beyond the hardness"]),  # noqa: E501
        (changed(contact__hardness="1 GPa"), ["contact", "hardness is given but behaviour is elastic"]),
        (changed(shape={"kind": "sphere"}), ["shape", "radius"]),
        (changed(outputs__depths=["2 um", "1 um"]), ["outputs.depths", "rising"]),
        (changed(outputs__depths=[-1e-9]), ["outputs.depths", "greater than or equal to 0 m"]),
        (changed(seed=2**64), ["seed", "less than"]),
        (changed(seed=True), ["seed = true"]),
        (changed(name="../../etc"), ["name", "pattern"]),
        (changed(upper={"layer": {"material": "dlc", "thickness": "1 um"}}), ["upper", "layer without a material"]),
    ],
)  # fmt: skip
def test_one_mistake_one_message(data, parts):
    found = messages(data)
    assert len(found) == 1, found
    for part in parts:
        assert part in found[0], found[0]
    assert "allowed" in found[0] or "must" in found[0] or "should" in found[0], found[0]


SPHERE_REMOVED = 'the law "sphere" was removed; allowed: "averaged_von_mises" or "junction"'


@pytest.mark.parametrize(
    ("name", "setting", "key", "said"),
    [
        ("stribeck-mineral-oil", "sharing.striated_exit=true", "sharing.striated_exit: ", "removed; leave it out"),
        ("wear-steel-steel", "wear.criterion=sphere", "wear.criterion", SPHERE_REMOVED),
        ("wear-steel-steel", 'wear.criterion={kind="sphere"}', "wear.criterion", SPHERE_REMOVED),
        (
            "wear-steel-steel",
            'variants=[{name="one", criterion={kind="sphere", diameter="1 um"}}]',
            "variants[0].criterion",
            SPHERE_REMOVED,
        ),
    ],
)
def test_a_removed_key_says_what_to_do_instead(name, setting, key, said):
    with pytest.raises(InputError) as refused:
        load_scene(name, [setting])
    (message,) = refused.value.messages
    assert message.startswith(key)
    assert said in message


def test_all_mistakes_at_once():
    data = changed(sead=1, contact__load="1 m", contact__behaviour="plastic", lower__material="stee", grid__shape=-1)
    found = messages(data)
    assert len(found) == 5
    for key in ("sead", "contact.load", "contact.behaviour", "lower.material", "grid.shape"):
        assert sum(message.startswith(key) for message in found) == 1, found


def test_capped_without_any_hardness():
    data = changed(contact__behaviour="capped", lower__material="phosphor-bronze", upper={})
    (found,) = messages(data)
    assert "contact.hardness: missing" in found


def test_a_key_that_only_over_sets_has_its_first_value():
    """What a scene without it lacks is not refused; a wrong first value is, and the scene is stored as written."""
    data = changed(over={"contact.mean_pressure": ["2 MPa", "3 MPa"]})
    data["contact"] = {}
    loaded = load_scene(data)
    assert loaded.contact.mean_pressure == 2e6
    assert [one.contact.mean_pressure for one in scenes_over(loaded)] == [2e6, 3e6]
    assert loaded.source["contact"] == {}
    with pytest.raises(InputError, match="unknown unit"):
        load_scene(data | {"over": {"contact.mean_pressure": ["2 X", "3 MPa"]}})
    with pytest.raises(InputError, match="none of load"):
        load_scene(data | {"over": {"contact.friction": [0.1, 0.2]}})


def test_settings_change_the_scene():
    scene = load_scene(
        SCENE,
        [
            "contact.mean_pressure=20 MPa",
            "grid.shape=[16,8]",
            "lower.material.hardness=2 GPa",
            "seed=7",
            'name="other"',
        ],
    )
    assert scene.contact.mean_pressure == 20e6
    assert scene.grid.shape == (16, 8)
    assert scene.lower.material.hardness == 2e9
    assert scene.lower.material.youngs_modulus == 210e9
    assert scene.lower.build().material.yield_stress == 2e9 / 2.8
    assert (scene.seed, scene.name) == (7, "other")


def test_settings_reach_into_lists():
    scene = load_scene(
        "wear-mesh-convergence", ["variants[0].name=first", "variants.1.cells=96", "cylinder.loads=[3.0]"]
    )
    assert scene.variants[0].name == "first"
    assert scene.variants[1].cells == 96
    before = load_scene("wear-mesh-convergence")
    assert scene.variants[0].model_copy(update={"name": before.variants[0].name}) == before.variants[0]
    assert load_scene(SCENE, ["grid.shape[1]=8"]).grid.shape == (32, 8), "one value that stands for both axes"


def test_a_setting_from_a_file(tmp_path):
    (tmp_path / "loads").write_text("# from the tester\n2.5 N\n\n5\n")
    assert load_scene("wear-steel-steel", [f"cylinder.loads=@{tmp_path}/loads"]).cylinder.loads == [2.5, 5.0]


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("grid.shape[2]=8", "grid.shape[2]: grid.shape has 2 entries; allowed: grid.shape[0] to grid.shape[1]"),
        ("seed[0]=8", "seed[0]: seed is not set and so has no entries; allowed: all of it, seed=..."),
        ("contact[0]=8", "contact[0]: contact is a table, not a list; allowed: no index"),
        ("contact.mean_pressure[0]=8", "contact.mean_pressure[0]: contact.mean_pressure is one value, not a list"),
        ("outputs.depths.x=8", "outputs.depths.x: outputs.depths is a list; allowed: outputs.depths[0]"),
        ("outputs.depths[0].x[1]=8", "outputs.depths[0].x[1]: outputs.depths[0].x is not set"),
    ],
)
def test_a_bad_index_is_one_message(setting, message):
    scene = SCENE | {"outputs": {"depths": ["1 um"]}}
    with pytest.raises(InputError) as caught:
        load_scene(scene, [setting, "nonsense"])
    assert caught.value.messages[0].startswith(message)
    assert len(caught.value.messages) == 2, "all mistakes at once"


@pytest.mark.parametrize("setting", ["nothing", "=3", "a..b=3", ".=1", "a[]=1", "a[x]=1", "0.a=1", "a=@", "a=@/"])
def test_bad_settings(setting):
    with pytest.raises(InputError, match="--set"):
        load_scene(SCENE, [setting])


def test_settings_do_not_reach_into_the_callers_table():
    before = copy.deepcopy(SCENE)
    load_scene(SCENE, ["contact.mean_pressure=20 MPa", "lower.material=brass-disk"])
    assert before == SCENE


def test_paths_of_a_file_are_relative_to_it_and_of_a_setting_to_the_shell(tmp_path, monkeypatch):
    folder = tmp_path / "scenes"
    folder.mkdir()
    (folder / "map.di").write_bytes(b"x")
    (tmp_path / "other.di").write_bytes(b"x")
    file = folder / "a.toml"
    file.write_text(
        'kind = "contact"\nlower = {material = "steel-disk", surface = {kind = "measured", path = "map.di"}}\n'
        'contact = {load = "1 N"}\n'
    )
    monkeypatch.chdir(tmp_path)
    assert load_scene(file).lower.surface.path == str(folder / "map.di")
    assert load_scene(str(file), ["lower.surface.path=other.di"]).lower.surface.path == str(tmp_path / "other.di")
    assert load_scene(file).name == "a"


def test_unknown_scene_names_the_nearest():
    with pytest.raises(InputError, match='did you mean "rough-contact"'):
        load_scene("rough-contakt")


@pytest.mark.parametrize(
    "text",
    [b"kind = ", b"\xff\xfe", b"[" * 5000, b"a" * 1_000_001, b"kind = 3", b'kind = "contact"\nkind = "contact"', b""],
)
def test_unreadable_scene_files(tmp_path, text):
    file = tmp_path / "bad.toml"
    file.write_bytes(text)
    with pytest.raises(InputError):
        load_scene(file)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("load = 1\nload = 2\nother = 3\n", "the key load stands twice, the second time in line 2"),
        ("[contact]\na = 1\n[contact]\nb = 1\n", "the table [contact] stands twice, the second time in line 3"),
        ("[contact]\na.b = 1\na.b = 2", "the key a.b stands twice, the second time in line 3"),
        ("a = 1\na = [\n1,\n2]\nb = 1\n", "a key stands twice, the second time in line 4"),
    ],
)
def test_keys_given_twice_are_named(tmp_path, text, said):
    """Was "Cannot overwrite a value (at line 8, column 18)"."""
    path = tmp_path / "twice.toml"
    path.write_text(text)
    with pytest.raises(InputError) as scene:
        load_scene(str(path))
    with pytest.raises(InputError) as element:
        load_element(path)
    for caught in (scene, element):
        assert f"({said})" in str(caught.value)


def test_parameters_of_laws_have_their_units():
    """The swept range of adhesion stood without one: 3e-07."""
    scene, _ = plan_scene(
        "hertz-sphere", ["contact.friction=0", 'contact.adhesion={ work = "50 mJ/m^2", range = "300 nm" }']
    )
    assert unit_at(scene, "contact.adhesion.range") == "m"
    assert unit_at(scene, "contact.load") == "N"
    assert unit_at(scene, "contact.adhesion.nothing") == "1"


def test_resolved_scene_says_units():
    text = dump_scene(plan_scene("rough-contact")[0])
    assert "mean_pressure = 50000000.0  # Pa" in text or "# Pa" in text
    assert "spacing = [3.90625e-07, 3.90625e-07]  # m" in text


def test_every_kind_is_registered_under_its_file():
    for name in kind_names():
        kind = get_kind(name)
        assert kind.title
        assert kind.model.model_fields["kind"].default == name


@pytest.mark.internal
def test_a_scene_too_large_for_the_memory_is_refused_before_any_work():
    from bem.runs import run_scene

    side = 65536
    assert 12 * 8 * side**2 > available_memory(), "this machine is too large for this test"
    with pytest.raises(
        InputError, match=r"memory: this scene needs about .* available \(grids of .* % of the cells fit"
    ):
        run_scene(changed(grid__shape=side), "/nonexistent/never-made")


def test_peak_of_a_plan_counts_what_is_kept():
    from bem.scenes import Plan, Step

    steps = (
        Step("a", "", memory=100, kept=10),
        Step("b", "", memory=50),
        Step("skipped", "", skipped=True, memory=1e9),
        Step("c", "", memory=70, kept=0),
        Step("d", "", memory=60),
    )
    process = Plan(()).memory
    assert Plan(steps).memory - process == 130  # a: 100; b: 10 + 50; c: 60 + 70; d: 60 + 60
    assert Plan(steps[:1]).memory - process == 100


words = st.sampled_from(
    [
        *(
            "kind",
            "contact",
            "grid",
            "shape",
            "spacing",
            "periodic",
            "lengths",
            "lower",
            "upper",
            "material",
            "surface",
        ),
        *("load", "hardness", "seed", "name", "depths", "values", "behaviour", "capped", "elastic", "steel-disk"),
        *("generated", "measured", "smooth", "rms_height", "hurst", "path", "outputs", "von_mises"),
    ]
)
leaves = st.one_of(
    words,
    st.integers(-3, 200),
    st.floats(),
    st.booleans(),
    st.text(max_size=8),
    st.sampled_from(["10 N", "1 um", "3 GPa", "60 degC", "10 %", "5 N/m"]),
    st.dates(),
)
values = st.recursive(
    leaves, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(words, inner, max_size=4), max_leaves=8
)


@given(st.dictionaries(words | st.text(max_size=6), values, max_size=5))
@settings(deadline=None, max_examples=150)
def test_random_tables_are_refused_in_words(data):
    found = refusal({"kind": "contact"} | data)
    assert found is None or all(message and "\n" not in message for message in found)


@given(st.sampled_from(["grid", "lower", "upper", "shape", "contact", "outputs", "seed", "name"]), words, values)
@settings(deadline=None, max_examples=200)
def test_random_damage_to_a_good_scene(table, key, value):
    data = copy.deepcopy(SCENE)
    if isinstance(data.get(table), dict):
        data[table][key] = value
    else:
        data[table] = value
    found = refusal(data)
    if found is None:
        scene, _ = plan_scene(data)
        assert load_scene(tomllib.loads(dump_scene(scene))) == scene
    else:
        assert all(message and "\n" not in message for message in found)


def test_nothing_in_a_scene_is_executed(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for text in ("__import__('os').mkdir('x') m", "{{7*7}} m", "$(touch x) m", "!!python/object"):
        with pytest.raises(InputError):
            load_scene(changed(contact={"load": text}))
    assert os.listdir(tmp_path) == []
