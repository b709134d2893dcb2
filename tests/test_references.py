"""Sources: every key that a law or a method cites has an entry, and scenes cite what they use."""

import tomllib

import pytest
from typer.testing import CliRunner

from bem.campaigns import cited
from bem.cli import build
from bem.elements.element import element_template, load_element
from bem.elements.sources import sources_of_element
from bem.laws import FAMILIES, laws_of
from bem.materials import CATALOGUE
from bem.references import references
from bem.runs import plan_scene, run_scene
from bem.scenes import sources as cited_methods
from bem.scenes.kind import kind_names, sources_of_kind
from bem.scenes.load import library_text


def sources(name, *settings):
    return cited.sources_of(plan_scene(name, settings)[0])


def test_every_entry_is_read_whole():
    known = references()
    assert len(known) > 50
    for key, one in known.items():
        assert {"author", "title", "year"} <= set(one.fields), key
        assert one.bibtex.count("{") == one.bibtex.count("}")
        assert not set("{}\\") & set(one.text), key
    assert known["briscoe1978"].text == (
        "Briscoe, B. J. and Tabor, D. (1978). Shear properties of thin polymeric films. Journal of Adhesion 9, "
        "145-155. (title and pages not checked against the paper)"
    )


def test_every_key_that_is_cited_has_an_entry():
    keys = {key for family in FAMILIES for law in laws_of(family).values() for key in law.cites}
    keys |= {key for kind in kind_names() for key in sources_of_kind(kind)}
    tables = [table for name, table in vars(cited_methods).items() if name.isupper()]
    assert len(tables) > 20
    keys |= {key for table in tables if table is not cited_methods.HEAT for key in table}
    keys |= {key for table in cited_methods.HEAT.values() for key in table}
    assert keys <= set(references())
    assert all(sources_of_kind(kind) for kind in kind_names())


def test_a_layer_of_oil_at_the_inlet_is_no_layered_body():
    assert "burmister1945" not in sources("starved-ball")
    assert "burmister1945" in sources("coated-sphere")


def test_contacts_cite_what_adheres_relaxes_and_rolls():
    assert {"johnson1971", "derjaguin1975", "tabor1977", "maugis1992"} <= set(sources("adhesive-sphere"))
    assert "johnson1971" not in sources("contact-challenge")
    assert "hunter1961" in sources("sliding-hysteresis")
    assert "ting1966" in sources("viscoelastic-ball")
    assert not {"hunter1961", "ting1966", "maugis1992"} & set(sources("hertz-sphere"))
    assert "kalker1971" in sources("rolling-from-rest")
    assert "kalker1971" not in sources("rolling-creepage")


def test_scenes_cite_the_laws_and_methods_that_they_use():
    found = sources("traction-curve")
    assert found["eyring1936"] == ["shear law base_oil"]
    assert sources("traction-curve", "oil.shear_law=eyring", 'oil.shear_stress_limit="5 MPa"')["eyring1936"] == [
        "shear law eyring"
    ]
    assert "density law dowson_higginson" in found["dowson1966"]
    assert "roelands1966" in found
    assert "barus1893" in sources("traction-curve", "oil.viscosity_law=barus")
    assert "cheng1965" not in found
    assert "cheng1965" in sources("traction-curve", "thermal=full")
    assert not {"crook1961", "cheng1965"} & set(sources("traction-curve", "thermal=off"))
    assert "burmister1945" in sources("coated-sphere")
    assert "burmister1945" not in sources("hertz-sphere")
    assert "hu1992" in sources("rough-contact")
    assert "fouvry2003" in sources(
        "wear-cylinder-scar", 'wear.criterion={kind="energy",energy_wear_rate="1e-15 m^2/N",distance="1 mm"}'
    )


@pytest.mark.parametrize("finished", [False, True])
def test_the_command_prints_text_and_bibtex(finished, tmp_path):
    name = "hertz-sphere"
    if finished:
        name = str(run_scene(name, tmp_path / "run", settings=("grid.shape=16",), figures=False).path)
    done = CliRunner().invoke(build(), ["cite", name])
    assert done.exit_code == 0
    assert "Kalker, J. J. (1977)" in done.output
    alone = CliRunner().invoke(build(), ["cite", name, "--bibtex"]).output.splitlines()
    assert alone
    assert all(line.startswith("@") and line.endswith("}") for line in alone)
    assert set(alone) <= {one.bibtex for one in references().values()}


@pytest.mark.parametrize(("name", "own"), [("gear-pair", "blok1937"), ("rolling-bearing", "iso281")])
def test_a_machine_element_cites_its_ratings_and_its_film(name, own, tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(element_template(name))
    done = CliRunner().invoke(build(), ["cite", str(path), "--bibtex"])
    assert done.exit_code == 0
    for key in (own, "zhou1991", "roelands1966"):
        assert references()[key].bibtex in done.output


def test_a_fit_that_the_answer_names_is_cited():
    """Schlenk's friction of gears, and Palmgren's stiffness of rollers, which balls do not have."""
    tables = {name: tomllib.loads(element_template(name)) for name in ("gear-pair", "rolling-bearing")}
    tables["roller"] = tables["rolling-bearing"] | {"rolling": "roller", "length": "11 mm"}
    del tables["roller"]["groove"]
    cited = {name: set(sources_of_element(load_element(table | {"name": "mine"}))) for name, table in tables.items()}
    assert "schlenk1994" in cited["gear-pair"]
    assert "palmgren1959" in cited["roller"]
    assert "palmgren1959" not in cited["rolling-bearing"]
    assert {"schlenk1994", "palmgren1959"} <= set(references())
    assert "Freßtragfähigkeit von Großzahnrädern. Technische Universität München" in references()["schlenk1994"].text


def test_laws_without_a_source_are_constants_tables_and_definitions():
    bare = {name for family in FAMILIES for name, law in laws_of(family).items() if not law.cites}
    assert bare <= {
        *("isoviscous", "incompressible", "newtonian", "constant", "table", "gross_sliding"),
        *("table_over_pressure", "table_over_speed", "table_over_temperature", "temperature_dependent"),
    }


def test_rough_contacts_cite_their_indices_and_despiked_maps_their_rule():
    rough = sources("rough-contact")
    assert {"nayak1971", "greenwood1966", "mikic1974"} <= set(rough)
    assert "hampel1974" not in rough
    assert not {"nayak1971", "mikic1974"} & set(sources("hertz-sphere"))
    pair = ("lower.surface.path=example/ground-disk.al3d", "upper.surface.path=example/polished-pin.x3p")
    own = sources("measured-surfaces", *pair, "lower.surface.despike=6")
    assert {"persson2001", "bush1975", "hampel1974"} <= set(own)


def test_conditional_methods_are_cited_where_a_scene_uses_them_alone():
    assert "dundurs1969" not in sources("hertz-sphere")  # steel on steel: traction does not move the gap
    assert "dundurs1969" in sources("hertz-sphere", "upper.material=silicon-nitride")
    assert "dundurs1969" not in sources("hertz-sphere", "upper.material=silicon-nitride", "contact.friction=0")
    assert "anderson1965" in sources("hot-film")
    assert "anderson1965" not in sources("traction-curve")
    assert "iso25178" in sources("rough-contact")
    assert "iso25178" not in sources("hertz-sphere")
    both = ("elastic", "uncoupled_elastic")
    for models in (both, both[:1]):
        found = sources("asperities-given-film", f"sharing.models={list(models)}")
        assert ("uncoupled asperities" in found.get("greenwood1966", ())) == (models == both)
    defect = 'wear.film_defect={adsorption_energy="0.6 eV",sliding_speed="1 m/s",temperature="60 degC"}'
    for settings in ((), (defect,)):
        assert ("kingsbury1958" in sources("wear-cylinder-scar", *settings)) == bool(settings)
    assert "patir1978" in sources("stribeck-mineral-oil", "sharing.flow_factors=surfaces")
    fatigue = {"dangvan1973", "morales2011"}
    assert not fatigue & set(sources("running-in-life")), "its plan says: fatigue skipped"
    assert fatigue <= set(sources("micropitting-rig"))
    assert "dangvan1973" not in sources("micropitting-rig", 'fatigue.criterion="crossland"')
    waves = {"greenwood1994", "hooke2000", "morales2011"}
    for smooth, rough in (("traction-curve", "rough-roller-waves"), ("film-ball", "rough-film-waves")):
        assert not waves & set(sources(smooth))
        assert waves <= set(sources(rough))


@pytest.mark.parametrize(
    ("name", "used", "unused"),
    [
        (
            "running-in-ball",
            {"love1929", "johnson1985", "kalker1977", "venner2000", "jaeger1942", "blok1937"},
            "lee1960",
        ),
        ("running-in-stribeck", {"love1929", "johnson1985"}, "venner2000"),
        ("stribeck-mineral-oil", {"love1929", "kalker1977"}, "blok1937"),
        ("tribofilm-ball", {"love1929", "johnson1985"}, "venner2000"),
        ("crystal-ball", {"ting1996", "willis1966"}, "lee1960"),
        ("viscoelastic-ball", {"lee1960", "ting1966"}, "ting1996"),
        ("tense-gel-ball", {"hajji1978", "long2013"}, "lee1960"),
    ],
)
def test_kernels_stresses_heat_and_materials_are_cited_where_they_are_used(name, used, unused):
    found = sources(name)
    assert used <= set(found)
    assert unused not in found
    line = "elastohydrodynamic line contact" in found.get("dowson1966", [])
    assert line is (name in ("running-in-stribeck", "stribeck-mineral-oil"))


def test_stresses_below_are_cited_where_a_criterion_asks_for_them():
    archard = 'wear.criterion={kind="archard",specific_wear_rate=1e-16,distance=0.01}'
    for settings, cites in (((), True), ((archard,), False), ((archard, "wear.particle_criterion=von_mises"), True)):
        assert ("stresses below the surface" in sources("running-in-ball", *settings)["love1929"]) is cites


def test_constants_of_the_catalogues_are_told_with_their_sources():
    scene = plan_scene("coated-sphere")[0]
    found = cited.catalogue_sources(scene)
    assert set(found) == {"material dlc", "material steel-52100", "material silicon-nitride"}
    assert found["material dlc"] == CATALOGUE["dlc"].source
    own = cited.catalogue_sources(plan_scene("coated-sphere", ("upper.material.youngs_modulus=300 GPa",))[0])
    assert own["material silicon-nitride"].endswith("The scene itself gives youngs_modulus")
    oil = cited.catalogue_sources(plan_scene("hot-film")[0])
    assert "ISO 3448" in oil["oil ISO VG 68"]
    assert "Stachowiak" in oil["oil ISO VG 68, pressure-viscosity"]
    assert "Modelica" in oil["oil ISO VG 68, heat capacity"]
    assert "Mann (1995)" in oil["oil ISO VG 68, shear_stress_limit"]
    given = cited.catalogue_sources(plan_scene("hot-film", ("oil.pressure_viscosity=20 1/GPa",))[0])
    assert "oil ISO VG 68, pressure-viscosity" not in given


def test_another_parser_reads_the_bibtex():
    """pybtex, which comes with the extra `docs`."""
    database = pytest.importorskip("pybtex.database")
    whole = "\n".join(one.bibtex for one in references().values())
    parsed = database.parse_string(whole, "bibtex").entries
    assert set(parsed) == set(references())
    for key, entry in parsed.items():
        fields = dict(references()[key].fields)
        authors = fields.pop("author").split(" and ")
        assert len(entry.persons["author"]) == len(authors), key
        assert dict(entry.fields) == fields, key


def test_every_scene_and_element_cites_this_program(tmp_path):
    assert "bem2026" in sources("hertz-sphere")
    path = tmp_path / "mine.toml"
    path.write_text(element_template("gear-pair"))
    assert references()["bem2026"].bibtex in CliRunner().invoke(build(), ["cite", str(path), "--bibtex"]).output


def test_maps_made_periodic_cite_the_method():
    pair = ("lower.surface.path=example/ground-disk.al3d", "upper.surface.path=example/polished-pin.x3p")
    mirrored = ("lower.surface.mirror=both", "upper.surface.mirror=both")
    assert "moisan2011" in sources("measured-surfaces", *pair, "grid.periodic=true")
    assert "moisan2011" in sources("measured-surfaces", *pair, "grid.periodic=true", mirrored[0])
    assert "moisan2011" not in sources("measured-surfaces", *pair, "grid.periodic=true", *mirrored)
    assert "moisan2011" not in sources("rough-contact")


def test_a_sweep_a_file_of_a_run_and_a_wrong_name(tmp_path):
    run = tmp_path / "s" / "points" / "1"
    run.mkdir(parents=True)
    (run / "scene.toml").write_text(library_text("hertz-sphere"))
    (run / "results.nc").write_bytes(b"")

    def cite(name):
        done = CliRunner().invoke(build(), ["cite", str(name)])
        return done.output + str(done.exception)

    assert "Kalker, J. J. (1977)" in cite(tmp_path / "s")
    assert f"allowed: the folder of the run, {run}, or" in cite(run / "results.nc")
    assert "without a run or a sweep" in cite(tmp_path)
    assert 'did you mean "hertz-sphere"?' in cite("hertz-sphre")
    assert "did you mean" not in cite("nothere")


def test_gears_and_bearings_cite_geometry_load_sharing_and_concepts(tmp_path):
    wanted = {"gear-pair": ("iso21771", "isotr15144", "isots6336"), "rolling-bearing": ("sjovall1933",)}
    for name, keys in wanted.items():
        file = tmp_path / f"{name}.toml"
        file.write_text(element_template(name))
        said = CliRunner().invoke(build(), ["cite", str(file), "--bibtex"]).output
        assert all(f"{{{key}," in said for key in keys), name


def test_a_scene_of_measured_surfaces_is_cited_without_its_maps(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(build(), ["cite", "measured-surfaces"])
    assert done.exit_code == 0
    assert "Greenwood" in done.output
