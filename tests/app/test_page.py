"""The page in a real browser, from a surface file to results and back; nothing is lost on the way."""

import contextlib
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
import tomllib
import urllib.error
import urllib.request
from pathlib import Path

import pytest
from small_scenes import WEAR

from bem import crop, describe_surface, open_run, read_surface, run_scene
from bem.surfaces.examples import FOLDER

pytest.importorskip("nicegui")
from bem.app.workspace import Workspace
from bem.elements.element import element_template

sys.path.insert(0, str(Path(__file__).parent))
import browser as chromium

pytestmark = [
    pytest.mark.browser,
    pytest.mark.slow,
    pytest.mark.skipif(chromium.CHROMIUM is None, reason="needs chromium"),
]
ROOT = Path(__file__).resolve().parents[2]
PATIENCE = 120.0
LIBRARY = "Resize must be passed a displayed plot"
"""A mistake of the library's own: a plot that is taken away while its size is looked at."""


class Server:
    """`bem app` as a user starts it; `kill` gives it no time to say goodbye."""

    def __init__(self, folder):
        code = "import sys; sys.argv[0] = 'bem'; from bem.cli import main; main()"
        self.process = subprocess.Popen(
            [sys.executable, "-W", "error::DeprecationWarning:bem", "-c", code, "app", str(folder), "--no-browser"],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=ROOT,
        )  # fmt: skip
        line = self.process.stdout.readline()
        found = re.search(r"http://127\.0\.0\.1:\d+/\?token=\S+", line)
        assert found, line + self.process.stdout.read()
        self.address, self.base = found.group(), found.group().partition("/?")[0]
        self._until_up()

    def _until_up(self):
        end = time.monotonic() + PATIENCE
        while True:
            with contextlib.suppress(OSError):
                urllib.request.urlopen(self.address, timeout=PATIENCE).read()
                return
            assert time.monotonic() < end
            time.sleep(0.2)

    def kill(self):
        self.process.send_signal(signal.SIGKILL)
        self.process.wait(20)
        self.process.stdout.close()


@contextlib.contextmanager
def servers_of(folder):
    """A function that starts a server of this project folder; the servers and their runs end with the block."""
    servers = []

    def start():
        servers.append(Server(folder))
        return servers[-1]

    yield start
    for server in servers:
        if server.process.poll() is None:
            server.kill()
    if servers:
        workspace = Workspace(folder)
        for run in workspace.runs_folder.iterdir():  # runs outlive their server
            process = workspace.process_of(run)  # not the number in a file: the run may have ended
            if process is not None:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(process, signal.SIGKILL)


@pytest.fixture
def serve(tmp_path):
    with servers_of(tmp_path / "work") as start:
        yield start


@pytest.fixture(scope="module")
def shared_folder(tmp_path_factory):
    return tmp_path_factory.mktemp("shared") / "work"


@pytest.fixture(scope="module")
def shared_server(shared_folder):
    """A server for tests that neither end it nor look at what others left: each has a scene of its own name."""
    with servers_of(shared_folder) as start:
        yield start()


@pytest.fixture(scope="module")
def chrome():
    with chromium.Browser() as found:
        yield found


@pytest.mark.internal
def test_an_element_answers_on_its_page(shared_server, shared_folder, chrome):
    """From the first page to a bearing: a mistake is said, the answer has life and figure, the scene is one to run."""
    server, tab = shared_server, chrome.tab()
    tab.go(server.address)
    tab.click("[data-start=bearing]")
    tab.wait_text("press answer")
    tab.type("radial_load", "6 K")
    tab.click("[data-action=answer]")
    tab.wait("document.querySelector('[data-mistake]').innerText.includes('radial_load')")
    tab.type("radial_load", "6 kN")
    tab.click("[data-action=answer]")
    tab.wait_text("P = 6 kN")
    tab.wait("document.querySelector('[data-figure=rolling-bearing]')")
    tab.click('[data-action="scene of the film"]')
    tab.wait("location.pathname.includes('/scene/rolling-bearing')")
    assert (shared_folder / "rolling-bearing.toml").is_file()
    tab.go(f"{server.base}/element/gear-pair")
    tab.click('[data-action="scene of mixed friction"]')
    tab.wait("location.pathname.includes('/scene/gear-pair')")
    assert tomllib.loads((shared_folder / "gear-pair.toml").read_text())["kind"] == "friction"


@pytest.mark.internal
def test_the_file_of_an_element_opens_in_its_form(shared_server, shared_folder, chrome):
    """From the list of scenes, where it stands as an element, and by any address that names it."""
    server, tab = shared_server, chrome.tab()
    file = shared_folder / "pump.toml"
    file.write_text(element_template("plain-bush").replace("500 N", "432 N"))
    tab.go(server.address)
    tab.click("[data-scene=pump]")
    tab.wait("document.querySelector('input[data-key=radial_load]').value === '432 N'")
    for path in ("/scene/pump", "/element/pump"):
        tab.go(server.base + path)
        tab.wait("document.querySelector('input[data-key=radial_load]').value === '432 N'")
    tab.click('[data-action="scene of the film"]')
    tab.wait("location.pathname.includes('/scene/pump-traction')")
    file.unlink()


@pytest.mark.internal
def test_coatings_are_added_changed_and_taken_out(shared_server, shared_folder, chrome):
    """Rows of a stack: what is typed is the file, what is taken out is gone, on a wide and on a narrow page."""
    file = shared_folder / "stack.toml"
    file.write_text(
        'kind = "contact"\n[lower]\nmaterial = "steel-52100"\nlayers = [{ material = "dlc", thickness = "2 um" }]\n'
        '[grid]\nshape = 32\nlengths = "100 um"\n[shape]\nkind = "sphere"\nradius = "3 mm"\n'
        '[contact]\nload = "1 N"\n'
    )

    def layers():
        return tomllib.loads(file.read_text())["lower"].get("layers")

    def wait_for(expected):
        end = time.monotonic() + PATIENCE
        while layers() != expected:
            assert time.monotonic() < end, layers()
            time.sleep(0.1)

    tab = chrome.tab()
    tab.go(f"{shared_server.base}/scene/stack")
    tab.click('[data-row="lower.layers:add"]')
    wait_for([{"material": "dlc", "thickness": "2 um"}] * 2)
    tab.wait("document.querySelector('input[data-key=\"lower.layers[1].thickness\"]')")
    tab.type("lower.layers[1].thickness", "-1 um")
    tab.wait("document.querySelector('[data-mistake]').innerText.includes('lower.layers[1].thickness')")
    tab.type("lower.layers[1].thickness", "0.5 um")
    tab.choose("lower.layers[1].material", "Cr")
    tab.type("lower.layers[0].residual_stress", "-1 GPa")
    chrome_layer = {"material": "Cr", "thickness": "0.5 um"}
    wait_for([{"material": "dlc", "thickness": "2 um", "residual_stress": "-1 GPa"}, chrome_layer])
    tab.wait_text("on 500 nm of Cr")
    tab.narrow()
    tab.wait("document.documentElement.scrollWidth <= window.innerWidth")
    assert tab.unnamed() == []
    tab.click('[data-row="lower.layers:remove:0"]')
    wait_for([chrome_layer])
    tab.wait("document.querySelector('input[data-key=\"lower.layers[0].material\"]').value === 'Cr'")
    tab.click('[data-row="lower.layers:remove:0"]')
    wait_for(None)
    assert tab.errors == []


@pytest.mark.internal
def test_from_a_file_to_results_and_back(serve, chrome, tmp_path):
    """Drop a surface, treat it, press it, see it, take it away; in another tab the same; two runs overlaid."""
    server, own = serve(), tmp_path / "mine.al3d"
    shutil.copy(FOLDER / "ground-disk.al3d", own)
    tab = chrome.tab()
    tab.go(server.address)
    tab.click("[data-new=contact]")
    tab.wait_text("grid and smooth contact")

    tab.go(f"{server.base}/surfaces")
    tab.wait_text("statistics")
    tab.drop(own)
    tab.wait_text("no height for 40 points")
    tab.type("despike", "6")
    tab.wait_text("Despiking took out 12 points")
    tab.type("crop", "60 um")
    tab.wait_text("75 x 75")
    for detrend in ("none", "curvature"):  # levelled anew, and the statistics are those of the same from Python
        tab.pick("detrend", detrend)
        direct = crop(read_surface(own, despike=6, detrend=detrend), (60e-6, 60e-6))
        tab.wait(f"/Sq\\s+{describe_surface(direct).Sq * 1e9:.4g} nm/.test(document.body.innerText)")
    tab.type("high_pass", "many")
    tab.wait("document.querySelector('[data-mistake]').innerText.startsWith('high_pass')")
    tab.type("high_pass", "")
    tab.wait("!document.querySelector('[data-mistake]') && document.querySelector('.main-svg')")
    put = "[...document.querySelectorAll('button')].find(b => b.innerText.includes('as lower')).click()"
    tab.look(put)
    tab.wait_text("lower.surface is this one")
    file = tmp_path / "work" / "contact.toml"
    surface = tomllib.loads(file.read_text())["lower"]["surface"]
    assert (surface["despike"], surface["crop"], surface["detrend"]) == (6, "60 um", "curvature")

    scene = chrome.tab()
    scene.go(f"{server.base}/scene/contact")
    scene.wait_text("the map only")  # the plan says so at once: the grid is larger
    scene.close()
    tab.type("cells", "32")
    tab.wait_text("32 x 32")
    tab.look(put)
    tab.wait_text("the grid has its 32 x 32 cells")
    assert tomllib.loads(file.read_text())["grid"] == {"shape": [32, 32], "lengths": ["60 um", "60 um"]}

    tab.go(f"{server.base}/scene/contact")
    assert tab.look(
        "document.querySelector('[data-table=\"lower.layer\"]') === null"
    )  # advanced keys lie behind a fold
    tab.click("[data-level='lower:advanced'] .q-item")
    tab.click("[data-table='lower.layer'] .q-item")  # a coating
    tab.type("lower.layer.thickness", "1 um")
    tab.choose("lower.layer.material", "tungsten-carbide")
    tab.wait_text("1 um of tungsten-carbide")  # in the plan
    layer = tomllib.loads(file.read_text())["lower"]["layer"]
    assert layer == {"material": "tungsten-carbide", "thickness": "1 um"}
    # what a key means stands by it
    tab.wait_text("Normal load; instead of hertz_pressure, mean_pressure, approach or mean_gap [N].")
    tab.type("contact.load", "2 M")
    tab.wait("document.querySelector('[data-mistake]').innerText.startsWith('contact.load')")
    tab.type("contact.load", "0.3 N")
    tab.wait("!document.querySelector('[data-mistake]') && document.querySelector('[data-plan]')")

    other = chrome.tab()  # a second tab sees what the first one typed
    other.go(f"{server.base}/scene/contact")
    other.wait("document.querySelector('input[data-key=\"contact.load\"]').value === '0.3 N'")
    other.type("contact.load", "0.4 N")
    tab.wait("document.querySelector('input[data-key=\"contact.load\"]').value === '0.4 N'")
    tab.wait("document.querySelector('[data-plan]')")

    for number in ("001", "002"):
        tab.go(f"{server.base}/scene/contact")
        tab.wait("document.querySelector('[data-plan]')")
        if number == "002":
            tab.type("contact.load", "0.2 N")
            tab.wait_text("200 mN")  # in the plan
        tab.click("[data-action=run]")
        tab.wait(f"location.pathname === '/run/contact-{number}'")
        tab.wait("document.querySelector('[data-state]').innerText === 'converged'")
        tab.wait_text("contact area fraction")
        tab.wait("document.querySelectorAll('.main-svg').length > 2")
    summary = (tmp_path / "work" / "runs" / "contact-001" / "summary.json").read_text()
    assert '"converged"' in summary
    asked = tomllib.loads((tmp_path / "work" / "runs" / "contact-001" / "scene.toml").read_text())
    assert asked["lower"]["layer"]["material"]["youngs_modulus"] == 620e9

    tab.go(f"{server.base}/run/contact-001")  # a reload: the same
    tab.wait_text("contact area fraction")
    kinds = tab.look(
        "Promise.all([...document.querySelectorAll('[data-download]')].map(async a => "
        "[a.dataset.download, (await (await fetch(a.href)).arrayBuffer()).byteLength]))"
    )
    assert {name for name, size in kinds if size > 100} == {
        "scene.toml", "results.nc", "figures.zip", "points.csv", "run.py", "report.html"
    }  # fmt: skip
    tab.go(f"{server.base}/compare?runs=contact-001,contact-002")
    tab.wait_text("contact: load")
    tab.wait(r"/\bload\s+[0-9.]+ (± [0-9.e-]+ )?mN/.test(document.body.innerText)")
    tab.wait("document.querySelector('[data-overlay] .main-svg')")

    path = tmp_path / "work" / "runs" / "contact-002" / "summary.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | {"outside_model": ["half of it"]}))
    tab.go(f"{server.base}/runs")
    tab.wait("document.querySelector('[data-beyond=contact-002]').innerText === 'outside the model'")
    summaries = [json.loads(one.read_text()) for one in (tmp_path / "work" / "runs").glob("*/summary.json")]
    marked = sum(bool(one.get("outside_model")) for one in summaries)
    assert tab.look("document.querySelectorAll('[data-beyond]').length") == marked

    assert [text for text in (*tab.errors, *other.errors) if LIBRARY not in text] == []
    elsewhere = [a for a in tab.addresses if not a.startswith((server.base, "data:", "blob:"))]
    assert elsewhere == []  # nothing from a network


LONG = WEAR.replace("count = 12", "count = 30000")


def test_a_section_by_a_click_and_pictures_in_space(serve, chrome, tmp_path):
    """A real click on a map moves the sections there; surface, stresses and particles are drawn in space."""
    runs = tmp_path / "work" / "runs"
    small = ["grid.shape=24", "outputs.von_mises=true", "outputs.depths=[0.0, 1e-4, 2e-4]", "outputs.errors=false"]
    run_scene("hertz-sphere", runs / "ball-001", settings=small, figures=False)
    run_scene(tomllib.loads(WEAR) | {"name": "wear"}, runs / "wear-001", figures=False)
    server, tab = serve(), chrome.tab()
    tab.go(server.address)
    tab.go(f"{server.base}/run/ball-001")
    tab.wait("document.querySelector('.js-plotly-plot .nsewdrag')")
    legend = "[...document.querySelectorAll('.legendtext')].map(one => one.textContent).join()"
    tab.wait(f"{legend}.includes('along x, y = ')")
    before = tab.look(legend)
    tab.look("document.querySelector('.js-plotly-plot .nsewdrag').scrollIntoView({block: 'center'})")
    x, y, width, height = tab.look(
        "(() => { const r = document.querySelector('.js-plotly-plot .nsewdrag').getBoundingClientRect(); "
        "return [r.x, r.y, r.width, r.height] })()"
    )
    tab.mouse(x + 0.26 * width, y + 0.69 * height)  # the middle of a cell of the 24: the 7th along x, the 8th along y
    lengths = open_run(runs / "ball-001").arrays
    at = [1e6 * float(lengths[axis].values[i]) for axis, i in (("y", 7), ("x", 6))]
    tab.wait(f"{legend} === 'along x, y = {at[0]:.4g} µm,along y, x = {at[1]:.4g} µm'")
    assert tab.look(legend) != before
    drawn = "document.querySelectorAll('.gl-container canvas').length"
    tab.click("[data-solids] .q-item")
    tab.wait(f"{drawn} === 1")
    tab.click("[data-key='map.solid']")
    tab.wait(f"{drawn} === 2")
    assert "WebGL" not in tab.text()
    tab.go(f"{server.base}/run/wear-001")
    tab.wait("document.querySelector('[data-solids]')")
    tab.click("[data-solids] .q-item")
    tab.wait(f"{drawn} === 1")
    tab.wait("document.querySelector('[data-solids] .gtitle').textContent.includes('particles where they came off')")
    assert [text for text in tab.errors if LIBRARY not in text] == []


def test_a_killed_server_and_a_pause_lose_nothing(serve, chrome, tmp_path):
    """The run goes on without its server; paused by the next one it keeps its checkpoint, and goes on to its end."""
    server = serve()
    work = tmp_path / "work"
    (work / "long.toml").write_text(LONG)
    tab = chrome.tab()
    tab.go(server.address)
    tab.go(f"{server.base}/scene/long")
    tab.wait("document.querySelector('[data-plan]')")
    tab.click("[data-action=run]")
    tab.wait("location.pathname === '/run/long-001'")
    folder = work / "runs" / "long-001"
    wait(lambda: (folder / "scene.toml").is_file() and (folder / ".app" / "pid").is_file())
    process = int((folder / ".app" / "pid").read_text())
    server.kill()
    os.kill(process, 0)  # it lives
    wait(lambda: list(folder.glob("cases/*.bin")) or (folder / "checkpoint.bin").is_file())

    server = serve()
    tab = chrome.tab()
    tab.go(server.address)
    tab.go(f"{server.base}/runs")
    tab.wait("document.querySelector('[data-state=long-001]').innerText === 'running'")
    tab.click("[data-action=pause]")
    tab.wait("document.querySelector('[data-state=long-001]').innerText === 'paused'")
    kept = [path.name for path in folder.glob("cases/*.bin")] + [path.name for path in folder.glob("checkpoint.bin")]
    assert kept
    assert not (folder / "summary.json").exists()
    tab.click("[data-action=resume]")
    tab.wait("document.querySelector('[data-state=long-001]').innerText === 'running'")
    tab.look("void (window.kept = document.querySelector('[data-action=pause]'))")
    tab.wait("document.querySelector('[data-progress=long-001]').innerText.includes(' of ')")  # it goes on
    tab.wait(r"/ so far.* left of cycles/.test(document.querySelector('[data-progress=long-001]').innerText)")
    assert tab.look("window.kept.isConnected")  # a button that is drawn anew under the mouse loses its click
    one = chrome.tab()
    one.go(f"{server.base}/run/long-001")
    one.wait("document.querySelector('[data-partial] .main-svg')")  # what is known up to now
    last = "document.querySelector('[data-partial]').data[0].x.at(-1)"
    before = one.look(last)
    one.wait(f"{last} > {before}")
    assert one.errors == []
    one.close()
    tab.click("[data-action=pause]")
    tab.click("[data-action=cancel]")
    tab.click("[data-answer=no]")
    tab.wait("!document.querySelector('[data-answer=no]')")
    tab.click("[data-action=cancel]")
    tab.click("[data-answer=yes]")
    tab.wait_text("No runs yet")
    tab.click("[data-action=undo]")
    tab.wait("document.querySelector('[data-state=long-001]').innerText === 'paused'")
    tab.wait("!document.querySelector('[data-answer=yes]')")
    tab.click("[data-action=cancel]")
    tab.click("[data-answer=yes]")
    tab.wait_text("No runs yet")
    assert (work / "runs" / ".cancelled" / "long-001" / "scene.toml").is_file()  # nothing is deleted
    assert tab.errors == []


def test_too_many_cells_are_refused_and_the_map_leads_to_a_result(shared_server, chrome):
    """The mistake stands on the page without an old picture; nothing that is asked for ends the server.

    From the map a scene, a button for a grid that became too large, a run, and its answers.
    """
    server, tab = shared_server, chrome.tab()
    tab.go(server.address)
    tab.go(f"{server.base}/surfaces")
    tab.wait("document.querySelector('.main-svg')")
    tab.type("cells", "60000")
    tab.wait("document.querySelector('[data-mistake]').innerText.startsWith('cells: 60000 x 60000')")
    assert tab.look("document.querySelector('.main-svg') === null")
    tab.type("cells", "0")
    tab.wait("document.querySelector('[data-mistake]').innerText.startsWith('cells = 0')")
    tab.type("cells", "32")
    tab.wait_text("32 x 32")
    assert server.process.poll() is None
    tab.click("[data-begin=contact]")
    tab.wait("location.pathname === '/scene/ground-disk-contact'")
    tab.wait("document.querySelector('[data-plan]')")
    tab.type("grid.lengths", "1 mm")
    tab.wait("document.querySelector('[data-action=run]').disabled && document.querySelector('[data-remedy=grid]')")
    tab.click("[data-remedy=grid]")
    tab.wait("document.querySelector('[data-plan]')")
    tab.type("grid.shape", "32")
    tab.wait_text("32 x 32")
    tab.wait("document.querySelector('[data-plan]')")
    tab.click("[data-action=run]")
    tab.wait("document.querySelector('[data-answer-of=\"contact area fraction\"]')")
    tab.wait("document.querySelectorAll('.main-svg').length > 2")
    assert tab.look("[...document.querySelectorAll('time')].every(one => one.innerText)")
    assert [text for text in tab.errors if LIBRARY not in text] == []


def test_errors_of_the_server_are_told_on_the_page(serve, chrome, tmp_path):
    """Of what is asked for in an address: a run that is not there, too many runs, a file that is gone."""
    server, tab = serve(), chrome.tab()
    tab.go(server.address)
    many = ",".join(f"x-{i:03d}" for i in range(300))
    for path, words in (
        ("/run/none-001", "there is none"),
        ("/scene/none", "not found"),
        ("/scene/a%20b", "allowed"),
        ("/element/none", "no machine element"),
        ("/element/plain-bush?file=none", "not found"),
        ("/compare", "allowed: 2 to"),
        (f"/compare?runs={many}", "300 to compare"),
        ("/compare?runs=a-001,b-001", "there is none"),
    ):
        tab.go(server.base + path)
        tab.wait(f"document.querySelector('[data-mistake]').innerText.includes({json.dumps(words)})")
    folder = tmp_path / "work" / "runs" / "gone-001"
    folder.mkdir()
    assert tab.look("fetch('/download/gone-001/results.nc').then(a => a.status)") == 404
    assert tab.errors == []


EDITED = """kind = "contact"
seed = 3
lower = { material = "steel-disk", surface = { kind = "generated", rms_height = "100 nm", correlation_length = "2 um" }}
upper = { material = "steel-52100" }

[grid]
shape = 16
spacing = "0.5 um"
periodic = true

[contact]
mean_pressure = "80 MPa"
behaviour = "capped"

[outputs]
errors = false
"""
FIELD = "document.querySelector('input[data-key=\"contact.{}\"]').value"


def write_in_editor(tab, text):
    """The whole text of the tab TOML, as a person would type it."""
    tab.click("[data-action=text]")
    tab.wait("document.querySelector('.cm-content')")
    tab._do("Page.bringToFront")
    tab.look("document.querySelector('.cm-content').focus()")
    select = {"key": "a", "code": "KeyA", "modifiers": 2, "windowsVirtualKeyCode": 65, "commands": ["selectAll"]}
    tab._do("Input.dispatchKeyEvent", type="keyDown", **select)
    tab.wait("document.getSelection().toString().length > 100")
    tab._do("Input.insertText", text=text)


def test_text_that_was_typed_is_what_runs(shared_server, shared_folder, chrome):
    server, tab = shared_server, chrome.tab()
    file = shared_folder / "typed.toml"
    file.write_text(EDITED)
    tab.go(server.address)
    tab.go(f"{server.base}/scene/typed")
    tab.wait("document.querySelector('[data-plan]')")
    text = EDITED.replace("80 MPa", "70 MPa").replace("[contact]", "# by hand\n[contact]")
    write_in_editor(tab, text)
    tab.click("[data-action=run]")  # at once: nothing has to be taken over
    tab.wait("location.pathname === '/run/typed-001'")
    asked = tomllib.loads((shared_folder / "runs" / "typed-001" / ".app" / "scene.toml").read_text())
    assert asked["contact"]["mean_pressure"] == "70 MPa"
    assert file.read_text() == text
    assert tab.errors == []


def test_a_file_broken_by_hand_is_left_alone(shared_server, shared_folder, chrome):
    """What is typed into the form before the page knows it writes nothing; the text can be mended on the page."""
    server, tab = shared_server, chrome.tab()
    file = shared_folder / "broken.toml"
    file.write_text(EDITED)
    tab.go(server.address)
    tab.go(f"{server.base}/scene/broken")
    tab.wait("document.querySelector('[data-plan]')")
    broken = EDITED.replace('"80 MPa"', '"80 MPa')
    file.write_text(broken)
    tab.type("contact.mean_pressure", "60 MPa")
    tab.wait("document.querySelector('[data-broken]')")
    assert file.read_text() == broken
    assert tab.look("document.querySelector('[data-action=run]').disabled")
    write_in_editor(tab, EDITED.replace("80 MPa", "50 MPa"))
    tab.wait("document.querySelector('[data-plan]')")
    assert tomllib.loads(file.read_text())["contact"]["mean_pressure"] == "50 MPa"
    assert tab.errors == []


def test_two_tabs_keep_each_others_edits(shared_server, shared_folder, chrome):
    """Different keys at once: both stay. The same key: it is asked. Open sections and the focus stay as they are."""
    server, one, two = shared_server, chrome.tab(), chrome.tab()
    file = shared_folder / "tabs.toml"
    file.write_text(EDITED)
    for tab in (one, two):
        tab.go(server.address)
        tab.go(f"{server.base}/scene/tabs")
        tab.wait("document.querySelector('[data-plan]')")
    two.click("[data-level='lower:advanced'] .q-item")
    opened = "document.querySelector('[data-table=\"lower.layer\"]').checkVisibility()"
    two.wait(opened)
    two._do("Page.bringToFront")
    file.write_text(file.read_text().replace("80 MPa", "81 MPa"))
    two.type("seed", "7")  # perhaps before it has seen the other
    wait(lambda: "seed = 7" in file.read_text() and '"81 MPa"' in file.read_text())
    for tab in (one, two):
        tab.wait(FIELD.format("mean_pressure") + " === '81 MPa'")
    assert two.look("document.activeElement.dataset.key") == "seed"
    assert two.look(opened)
    assert two.look("document.querySelector('input[data-key=\"seed\"]').value") == "7"

    asks = "document.querySelector('[data-answer=no]') !== null"
    for number in range(20):  # until it is typed before the page has looked into the file
        text = re.sub(r"8\d+ MPa", f"8{number:02d} MPa", file.read_text())
        file.write_text(text)
        two.type("contact.mean_pressure", f"9{number:02d} MPa")
        mine = f'"9{number:02d} MPa"'
        wait(lambda mine=mine: mine in file.read_text() or two.look(asks))
        if mine not in file.read_text():
            break
        file.write_text(file.read_text().replace(mine, '"80 MPa"'))
    two.click("[data-answer=no]")
    two.wait(FIELD.format("mean_pressure") + f" === '8{number:02d} MPa'")
    assert file.read_text() == text
    assert one.errors + two.errors == []


def test_every_page_can_be_read_and_used(serve, chrome, tmp_path):
    """Names of controls, contrast in light and dark, a mark on what has the focus, all of it in a telephone's width."""
    runs = tmp_path / "work" / "runs"
    run_scene("hertz-sphere", runs / "ball-001", settings=["grid.shape=16", "outputs.errors=false"], figures=False)
    for name in ("ball-002", "ball-003"):
        shutil.copytree(runs / "ball-001", runs / name)
    path = runs / "ball-003" / "summary.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | {"outside_model": ["half of it"]}))
    (tmp_path / "work" / "own.toml").write_text(EDITED)
    server, tab = serve(), chrome.tab()
    tab.narrow()
    tab.go(server.address)
    for path, there in (
        ("/", "document.querySelector('[data-start=gear]')"),
        ("/scene/own", "document.querySelector('[data-plan]')"),
        ("/surfaces", "document.querySelector('.main-svg')"),
        ("/element/gear-pair", "document.querySelector('[data-action=answer]')"),
        ("/runs", "document.querySelector('[data-tick]')"),
        ("/run/ball-001", "document.querySelectorAll('.main-svg').length > 2"),
        ("/compare?runs=ball-001,ball-002", "document.querySelector('[data-overlay] .main-svg')"),
        ("/element/gear-pair", "document.querySelector('input')"),
        ("/run/none-001", "document.querySelector('[data-mistake]')"),
    ):
        tab.go(server.base + path)
        tab.wait(there)
        tab.wait("document.querySelector('[inert]') === null")
        assert tab.unnamed() == [], path
        assert tab.look("document.documentElement.scrollWidth") == 390, path
        assert tab.look("document.documentElement.lang"), path
        assert tab.look("document.querySelectorAll('h1').length") == 1, path
        for dark in (False, True):
            tab.dark(dark)
            tab.settle()
            assert tab.faint() == [], (path, dark)
        assert tab.unfocused(8) == [], path
        if path == "/run/ball-001":  # the answer comes first
            first, then = (f"document.querySelector('{one}')" for one in ("[data-answer-of]", ".main-svg"))
            assert tab.look(f"{first}.getBoundingClientRect().bottom < {then}.getBoundingClientRect().top")
        if path == "/runs":  # no green beside what is outside its model
            colour = "getComputedStyle(document.querySelector('[data-state={}]')).backgroundColor"
            assert tab.look(colour.format("ball-003")) != tab.look(colour.format("ball-001"))
        tab.dark(False)
    tab.look("document.querySelector('[data-mistake]').style.color = '#999'")  # what is looked for is seen
    assert [text.partition(":")[0] for text, _ in tab.faint()] == ["run 'none-001'"]
    unmarked = "<style>@layer theme { html :focus-visible { outline: none !important } }</style>"
    tab.look(f"document.head.insertAdjacentHTML('beforeend', {json.dumps(unmarked)})")
    assert tab.unfocused(2)
    tab.look("document.activeElement.blur()")
    tab.go(f"{server.base}/scene/own")
    tab.wait("document.querySelector('[data-plan]')")
    tab.look("window.scrollTo(0, document.body.scrollHeight)")  # the button stays in view, and on top
    box = "document.querySelector('[data-action=run]').getBoundingClientRect()"
    tab.wait(f"document.elementFromPoint({box}.x + 5, {box}.y + 5).closest('[data-action=run]')")
    assert tab.errors == []


def wait(what):
    end = time.monotonic() + PATIENCE
    while not what():
        assert time.monotonic() < end
        time.sleep(0.1)


def test_without_the_token_there_is_nothing(shared_server):
    server = shared_server
    for address in (server.base, f"{server.base}/?token=wrong", f"{server.base}/runs"):
        with pytest.raises(urllib.error.HTTPError, match="403"):
            urllib.request.urlopen(address)
    elsewhere = urllib.request.Request(server.address, headers={"Host": "example.org"})
    with pytest.raises(urllib.error.HTTPError, match="403"):
        urllib.request.urlopen(elsewhere)
    with urllib.request.urlopen(server.address) as answer:
        assert "default-src 'self'" in answer.headers["content-security-policy"]
        assert '"inert":' in answer.read().decode()  # nothing takes a click that the server would not hear
