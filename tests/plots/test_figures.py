"""Figures: drawn from data alone, labelled with units, of the asked size, and never solving."""

import re
from types import SimpleNamespace

import numpy as np
import pytest
from PIL import Image

from bem.errors import InputError
from bem.plots.draw import Drawn, draw, draw_all, figure_kind
from bem.plots.figures import all_figures
from bem.plots.report import spelled, write_report
from bem.plots.style import BLUE, ORANGE, SKY, VERMILION, prefix
from bem.results.arrays import Arrays
from bem.results.directory import RunDirectory
from bem.scenes import get_kind, kind_names
from bem.scenes.context import Variable

pytestmark = pytest.mark.internal


def contact_run(path, nx=40, ny=30, depths=6, roughness=True):
    """A run with an invented pressure: nothing of it was solved."""
    x, y = (np.arange(nx) - nx / 2) * 1e-6, (np.arange(ny) - ny / 2) * 1e-6
    pressure = np.maximum(1e9 * (1 - (x[:, None] / 8e-6) ** 2 - (y[None, :] / 8e-6) ** 2), 0.0)
    z = np.linspace(0, 5e-6, depths)
    variables = {
        "x": Variable(("x",), x, "m", "x"),
        "y": Variable(("y",), y, "m", "y"),
        "pressure": Variable(("x", "y"), pressure, "Pa", "pressure"),
        "gap": Variable(("x", "y"), np.where(pressure > 0, 0.0, 1e-7), "m", "gap"),
        "undeformed_gap": Variable(("x", "y"), 1e-7 - 1e-16 * pressure, "m", "gap"),
        "contact_state": Variable(("x", "y"), (pressure > 0).astype(np.int8), "1", "state"),
        "iteration": Variable(("iteration",), np.arange(5), "1", "iteration"),
        "residual_history": Variable(("iteration",), 10.0 ** -np.arange(5), "1", "residual"),
        "depth": Variable(("depth",), z, "m", "depth"),
        "von_mises": Variable(
            ("depth", "x", "y"), pressure * np.exp(-((z[:, None, None] / 2e-6) ** 2)), "Pa", "stress"
        ),
    }
    if roughness:
        heights = 1e-7 * np.sin(x[:, None] * 1e6) + 0 * y
        variables["lower_height"] = Variable(("x", "y"), heights, "m", "height")
    scene = {"contact": {"tolerance": 1e-8}, "lower": {"material": {"hardness": 1.4e9}}, "outputs": {"body": "lower"}}
    summary = {
        "scene": "invented", "kind": "contact", "version": "1", "seed": 1, "wall_time_s": 1.0, "status": "converged",
        "where": "", "approach_m": 1e-7, "load_N": 2.0, "notes": ["<b>&"], "seconds_by_stage": {"contact": 1.0},
    }  # fmt: skip
    return SimpleNamespace(path=path, scene=scene, summary=summary, dataset=Arrays(variables, {}))


NAMES = (
    *("pressure-map", "contact-map", "contact-section", "pressure-histogram", "von-mises-section", "von-mises-depth"),
    *("convergence", "surface-maps"),
)


def axes_of(run, name):
    from matplotlib.figure import Figure

    figure = Figure(figsize=all_figures()[name].size)
    all_figures()[name].draw(run, figure)
    return figure, figure.axes


@pytest.mark.parametrize("name", NAMES)
def test_every_axis_says_what_it_is_and_in_which_unit(tmp_path, name):
    run = contact_run(tmp_path)
    assert all_figures()[name].fits(run)
    _, axes = axes_of(run, name)
    without_unit = {"iteration", "relative residual", "share of the contact area"}
    for ax in axes:
        for text in (ax.get_xlabel(), ax.get_ylabel()):
            if text and text not in without_unit:
                assert re.search(r"\((p|n|µ|m|k|M|G)?(m|Pa)\)$", text), text
    labels = [ax.get_xlabel() + ax.get_ylabel() for ax in axes]
    assert sum(bool(text) for text in labels) == len(axes)


def test_pressure_map_shows_the_pressure_with_x_to_the_right(tmp_path):
    run = contact_run(tmp_path)
    _, (axes, _) = axes_of(run, "pressure-map")
    (image,) = axes.images
    shown = np.ma.filled(image.get_array(), np.nan)
    pressure = run.dataset["pressure"].values
    np.testing.assert_allclose(np.nan_to_num(shown), pressure.T * 1e-9, rtol=1e-12)
    assert image.origin == "lower"
    left, right, bottom, top = image.get_extent()
    assert (right - left, top - bottom) == pytest.approx((40, 30))


def test_depth_runs_downwards(tmp_path):
    _, axes = axes_of(contact_run(tmp_path), "von-mises-section")
    bottom, top = axes[0].get_ylim()
    assert bottom > top == 0


def test_a_section_is_at_the_reported_one_of_two_mirrored_maxima(tmp_path):
    """Equal maxima at +y and -y: tables report the last one (`bem.stress.layer_places.highest_point`)."""
    run = contact_run(tmp_path)
    field = run.dataset["von_mises"].values
    field[:] = 1e8
    field[2, 20, 9] = field[2, 20, 21] = 7e8
    _, axes = axes_of(run, "von-mises-section")
    assert axes[0].get_xlabel().endswith(", at y = 6 µm (µm)")
    run.summary["max_von_mises_Pa"] = 7.5e8
    _, axes = axes_of(run, "von-mises-section")
    assert "maximum of the points" in axes[0].get_legend().get_texts()[-1].get_text()


def test_interfaces_of_a_section_are_in_its_legend_and_no_title_lies_under_it(tmp_path):
    """Dotted interfaces were taken for the yield stress, which an entry beside them calls white."""
    run = contact_run(tmp_path)
    bare = axes_of(run, "von-mises-section")[1][0].get_legend()
    assert not any("interface" in text.get_text() for text in bare.get_texts())
    run.scene["lower"]["layers"] = [{"thickness": 2e-6, "material": {"name": "Ti", "hardness": 1.0e9}}]
    _, axes = axes_of(run, "von-mises-section")
    texts = [text.get_text() for text in axes[0].get_legend().get_texts()]
    assert "dotted: interface" in texts
    assert any(text.startswith("white: yield stress") for text in texts)
    assert not any(axes[0].get_title(loc=side) for side in ("left", "center", "right"))


def test_files_have_the_asked_format_and_size(tmp_path):
    from PIL import Image

    run = contact_run(tmp_path)
    kind = all_figures()["convergence"]
    draw(run, kind, tmp_path, ("png", "pdf", "svg"), (4.0, 3.0))
    with Image.open(tmp_path / "convergence.png") as image:
        assert image.size == (800, 600)  # 200 dots an inch
    assert (tmp_path / "convergence.pdf").read_bytes().startswith(b"%PDF")
    assert b"<svg" in (tmp_path / "convergence.svg").read_bytes()[:2000]


def test_only_what_fits_is_drawn(tmp_path):
    run = contact_run(tmp_path, ny=1, roughness=False)
    drawn = {item.kind.name for item in draw_all(run, NAMES, tmp_path, ("png",))}
    assert drawn == {"contact-section", "pressure-histogram", "von-mises-section", "von-mises-depth", "convergence"}
    with pytest.raises(InputError, match="cannot be drawn from this run"):
        figure_kind(run, "surface-maps")
    with pytest.raises(InputError, match="no such figure"):
        figure_kind(run, "surfacemaps")


def test_a_contact_that_is_open_everywhere_can_be_drawn(tmp_path):
    run = contact_run(tmp_path)
    run.dataset["pressure"].values[:] = 0.0
    run.dataset["contact_state"].values[:] = 0
    drawn = {item.kind.name for item in draw_all(run, NAMES, tmp_path, ("png",))}
    assert "pressure-map" not in drawn
    assert "contact-map" in drawn


def test_colours_can_be_told_apart_in_grey():
    """Luminance differs between the colours that stand side by side (contact map, lines)."""

    def luminance(colour):
        red, green, blue = (int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5))
        return 0.2126 * red + 0.7152 * green + 0.0722 * blue

    assert abs(luminance(BLUE) - luminance(ORANGE)) > 0.2
    assert abs(luminance(BLUE) - luminance(VERMILION)) > 0.05
    assert abs(luminance(SKY) - luminance(BLUE)) > 0.2


@pytest.mark.parametrize(
    ("value", "unit", "expected"),
    [
        (45e-9, "m", (1e9, "nm")),
        (1e-6, "m", (1e6, "µm")),
        (999e-9, "m", (1e9, "nm")),
        (1.8e9, "Pa", (1e-9, "GPa")),
        (2.0, "N", (1.0, "N")),
        (0.0, "m", (1.0, "m")),
        (3.0, "1", (1.0, "")),
        (5e3, "rad", (1.0, "rad")),
        (1e-30, "m", (1e12, "pm")),
        (999.0, "nm", (1.0, "nm")),
        (129100.0, "nm", (1e-3, "µm")),
        (4e-12, "m²", (1e12, "µm²")),
        (4e6, "m²", (1.0, "m²")),
    ],
)
def test_prefixes(value, unit, expected):
    factor, text = prefix([value], unit)
    assert (factor, text) == (pytest.approx(expected[0], rel=1e-12), expected[1])


@pytest.mark.parametrize(
    ("name", "value", "expected"),
    [
        ("mean_contact_pressure_Pa", 1.2341e9, ("mean contact pressure", "1.234 GPa")),
        ("contact_area_fraction", 0.05, ("contact area fraction", "5 %")),
        ("approach_m", 4.2e-7, ("approach", "420 nm")),
        ("particle_equivalent_radius_nm", 151.23, ("particle equivalent radius", "151.2 nm")),
        ("cycles", 200, ("cycles", "200")),
        ("worn_depth_nm", 129100.0, ("worn depth of the contact region", "129.1 µm")),
        ("spacing_um", 2500.0, ("spacing", "2.5 mm")),
        ("yielded_volume_m3", 5.697e-16, ("yielded volume", "569.7 µm³")),
        ("friction", [0.1, 0.2], ("friction coefficient", "0.1, 0.2")),
        ("speed_m_s", [0.001, 0.3], ("speed", "0.001, 0.3 m/s")),
        ("status", "converged", ("status", "converged")),
        ("residual", None, ("solver residual (relative)", "-")),
        ("max_von_mises_Pa", 0.0, ("max von Mises", "0 Pa")),
    ],
)
def test_figures_spelt_for_people(name, value, expected):
    assert spelled(name, value) == expected


def make_report(tmp_path):
    run = contact_run(tmp_path / "run")
    with RunDirectory.start(run.path, "invented", 'kind = "contact"\n') as directory:
        drawn = draw_all(run, NAMES, directory.figures, ("png",))
        return write_report(run, drawn, ("load_N",)), len(drawn)


def test_report_is_one_file_that_needs_nothing_else(tmp_path):
    path, count = make_report(tmp_path)
    page = path.read_text("utf-8")
    assert count == len(NAMES)
    assert page.count('src="data:image/png;base64,') == count
    assert "http" not in page
    assert "&lt;b&gt;&amp;" in page
    assert not re.search(r"<(script|link|iframe)", page)


def test_what_is_outside_its_model_says_so_on_the_report_and_on_every_picture(tmp_path):
    run = contact_run(tmp_path / "run")
    told = "outside the model: half of it is beside; more of it"
    beyond = SimpleNamespace(**vars(run))
    beyond.summary = {**run.summary, "notes": [told], "outside_model": ["half of it is beside"]}
    (tmp_path / "beyond").mkdir()
    for item in draw_all(beyond, NAMES, tmp_path / "beyond", ("png",)):
        picture = np.asarray(Image.open(item.paths[0]).convert("RGB")).astype(int)
        red = (picture[..., 0] > 180) & (picture[..., 1] < 130) & (picture[..., 2] < 60)
        assert red[: len(red) // 8].any(), item.kind.name
    with RunDirectory.start(run.path, "invented", 'kind = "contact"\n'):
        page = write_report(beyond, [], ("load_N",)).read_text("utf-8")
        assert 'badge bad">outside the model' in page
        assert f'class="note beyond">{told}' in page
        assert "are not to be taken as they are: half of it is beside." in page
        assert "badge bad" not in write_report(run, [], ("load_N",)).read_text("utf-8")


@pytest.mark.browser
@pytest.mark.slow
def test_report_in_a_browser(tmp_path):
    """A real browser shows every picture: their widths are not zero."""
    import shutil
    import subprocess

    browser = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if browser is None:
        pytest.skip("no chromium")
    path, count = make_report(tmp_path)
    probe = path.with_name("probe.html")
    script = (
        "<script>window.onload = () => { const all = [...document.images]; "
        "document.title = all.filter(i => i.naturalWidth > 100).length + ' of ' + all.length; }</script></body>"
    )
    probe.write_text(path.read_text("utf-8").replace("</body>", script))
    done = subprocess.run(
        [browser, "--headless", "--no-sandbox", "--disable-gpu", "--dump-dom", probe.as_uri()],
        capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    assert f"<title>{count} of {count}</title>" in done.stdout


def test_a_figure_that_fails_does_not_cost_the_others(tmp_path, monkeypatch):
    from bem.plots import draw as module
    from bem.plots.figures import FigureKind

    def broken(run, figure):
        raise ZeroDivisionError("no")

    known = all_figures() | {"broken": FigureKind("broken", "", (), broken)}
    monkeypatch.setattr(module, "all_figures", lambda: known)
    failed = []
    run = contact_run(tmp_path)
    drawn = draw_all(run, ("broken", "convergence"), tmp_path, ("png",), lambda name, error: failed.append(name))
    assert [item.kind.name for item in drawn] == ["convergence"]
    assert failed == ["broken"]
    with pytest.raises(ZeroDivisionError):
        draw_all(run, ("broken",), tmp_path, ("png",))


def test_a_picture_takes_both_columns_of_a_report_where_it_is_that_wide(tmp_path):
    """A lone map of a figure that has room for two was shown at twice its size."""
    from PIL import Image

    run, kind = contact_run(tmp_path), all_figures()["surface-maps"]
    assert kind.size[0] > 7
    (tmp_path / "scene.toml").write_text('kind = "contact"\n')
    for inches, wide in ((4.5, False), (9.0, True)):
        path = tmp_path / f"{kind.name}.png"
        Image.new("RGB", (round(200 * inches), 760)).save(path)
        page = write_report(run, [Drawn(kind, (path,))], ("load_N",)).read_text("utf-8")
        assert ('<figure id="surface-maps" class="wide">' in page) is wide


def test_a_picture_is_drawn_once_after_its_layout(tmp_path, monkeypatch):
    """The layout is found without drawing: matplotlib's `savefig` would make it three passes."""
    from matplotlib.figure import Figure

    passes = []
    old = Figure.draw
    monkeypatch.setattr(Figure, "draw", lambda self, renderer: passes.append(1) or old(self, renderer))
    size = all_figures()["pressure-map"].size
    (path,) = draw(contact_run(tmp_path), all_figures()["pressure-map"], tmp_path, size=size).paths
    assert len(passes) == 1
    from PIL import Image

    width, height = size
    with Image.open(path) as image:
        assert image.size == (round(200 * width), round(200 * height))
        assert image.info["dpi"] == pytest.approx((200, 200), rel=1e-3)  # stored per metre, in whole numbers


def test_every_figure_of_the_package_is_drawn_by_a_kind():
    """A figure that no kind names is never drawn, in silence."""
    named = {name for kind in kind_names() for name in get_kind(kind).figures}
    of_campaigns = {"figures-over-keys"}
    assert set(all_figures()) == named | of_campaigns


def layered_run(path):
    """Two layers of 2 and 6 um on a body; the stress xx is twice as high in the second layer, xz is continuous."""
    run = contact_run(path)
    depth = np.array([0.0, 1e-6, 2e-6, 2.002e-6, 5e-6, 8e-6, 8.002e-6, 12e-6])
    stress = np.zeros((6, len(depth), 40, 30))
    inside = np.searchsorted([2e-6, 8e-6], depth)  # an interface belongs to the layer above it
    stress[0, :, 20, 15] = np.array([1e9, 2e9, -1e9])[inside]
    stress[4, :, 10, 15] = 3e8 - 1e13 * depth
    stress[2, :, 10, 10] = -1e8
    mises = np.abs(stress[0]) + np.sqrt(3) * stress[4]
    variables = {name: run.dataset[name] for name in ("x", "y")}
    variables |= {
        "depth": Variable(("depth",), depth, "m", "depth"),
        "von_mises": Variable(("depth", "x", "y"), mises, "Pa", "stress"),
        "stress": Variable(("component", "depth", "x", "y"), stress, "Pa", "stress"),
    }
    soft, hard = ({"name": name, "hardness": value} for name, value in (("soft", 2.8e9), ("hard", 28e9)))
    layers = [{"material": soft, "thickness": 2e-6}, {"material": hard, "thickness": 6e-6}]
    scene = {"lower": {"material": {"name": "body"}, "layers": layers}, "outputs": {"body": "lower"}}
    return SimpleNamespace(path=path, scene=scene, summary=run.summary, dataset=Arrays(variables, {}))


def test_stresses_of_layers_jump_at_interfaces_inside_and_not_across(tmp_path):
    run = layered_run(tmp_path)
    assert all_figures()["layer-stresses"].fits(run)
    _, (inside, across) = axes_of(run, "layer-stresses")
    lines = {line.get_label(): line.get_xdata() for axes in (inside, across) for line in axes.lines}
    gap = [np.nan]
    np.testing.assert_allclose(lines["tension (principal)"][:9], [1, 1, 1, *gap, 2, 2, 2, *gap, 0.22], rtol=1e-2)
    np.testing.assert_allclose(lines["shear across the plane"], 300 - 10 * run.dataset["depth"].values * 1e6, rtol=1e-9)
    assert not lines["tension across the plane"].any()
    assert "yield stress" in lines
    (yields,) = (line for line in inside.lines if line.get_linestyle() == "--" and len(line.get_xdata()))
    np.testing.assert_allclose([*yields.get_xdata(), *yields.get_ydata()], [1, 1, 0, 1])  # of the soft layer alone
    assert [tick.get_text() for tick in inside.get_yticklabels()] == ["0", "2", "8", "12"]
    assert [text.get_text() for text in across.texts] == ["soft", "hard", "body"]
    run.scene["lower"]["layers"][0]["material"]["hardness"] = 28e9  # no yield stress is near
    _, (inside, _) = axes_of(run, "layer-stresses")
    assert "yield stress" not in {line.get_label() for line in inside.lines}


def test_a_body_without_layers_has_no_stresses_of_layers(tmp_path):
    run = layered_run(tmp_path)
    run.scene["lower"]["layers"] = []
    assert not all_figures()["layer-stresses"].fits(run)
