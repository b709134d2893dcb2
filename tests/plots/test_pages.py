"""Pages made by a copy that was started before the run: same bytes, nothing left over, and what fails is done here."""

import os
import subprocess
import sys

import pytest

from bem.plots.pictures import PlainPowers

LINUX = pytest.mark.skipif(sys.platform != "linux", reason="copies are made on Linux only")

RUN = """
import os, signal, sys
import bem.plots.pages as pages
import bem.plots.side_by_side as module
module.cores = lambda: 2
real, started = os.fork, []
os.fork = lambda: started.append(real()) or started[-1]
from bem.runs import run_scene
def run(folder, **more):
    settings = ["grid.shape=32", "outputs.depths=[0.0]"]
    return run_scene("hertz-sphere", folder, settings=settings, **more)
def none_left():
    try:
        os.waitpid(-1, os.WNOHANG)
    except ChildProcessError:
        return True
"""


def told(code, folder):
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}  # a process of several threads is not copied
    done = subprocess.run(
        [sys.executable, "-c", RUN + code, folder], capture_output=True, text=True, timeout=400, env=environment
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@LINUX
def test_a_run_loads_nothing_that_draws_and_its_pictures_are_the_same(tmp_path):
    code = """
run(sys.argv[1] + "/ahead", pdf=True)
assert "matplotlib" not in sys.modules and "jinja2" not in sys.modules
assert len(started) == 1 and none_left()
run(sys.argv[1] + "/alone", workers=1, pdf=True)
assert "matplotlib" in sys.modules
assert len(started) == 1
run(sys.argv[1] + "/bare", figures=False)
assert len(started) == 1
"""
    told(code, tmp_path)
    ahead, alone = tmp_path / "ahead" / "figures", tmp_path / "alone" / "figures"
    names = sorted(os.listdir(alone))
    assert len(names) >= 10
    assert sorted(os.listdir(ahead)) == names
    for name in names:
        assert (ahead / name).read_bytes() == (alone / name).read_bytes(), name
    assert (tmp_path / "ahead" / "report.html").is_file()
    assert not (tmp_path / "bare" / "figures").exists()


@LINUX
@pytest.mark.parametrize(
    "what",
    [
        "pages.load_what_draws = lambda: os._exit(1)",
        "pages.stored_arrays = lambda *_: os._exit(1)",
        "pages.stored_arrays = lambda *_: 1 / 0",
        "pages._MOST_READ = 1000",
        "module.PATIENCE = 1; pages.stored_arrays = lambda *_: signal.pause()",  # hangs, drawing
        "module.PATIENCE = 1; pages.load_what_draws = lambda: os.kill(os.getpid(), signal.SIGSTOP)",
    ],
)
def test_what_the_copy_does_not_do_is_done_here(tmp_path, what):
    code = f"""
{what}
done = run(sys.argv[1] + "/run")
assert "matplotlib" in sys.modules
assert none_left()
assert not [note for note in done.summary["notes"] if note["code"] == "side-task-failed"]
"""
    told(code, tmp_path)
    assert len(os.listdir(tmp_path / "run" / "figures")) >= 5
    assert (tmp_path / "run" / "report.html").is_file()


@LINUX
def test_what_goes_wrong_in_the_copy_is_said_here(tmp_path):
    code = """
from bem.errors import InputError, ResultsError
real_make = pages.make
def refused(*_):
    raise ResultsError("figures: cannot be made (disk full)")
pages.make = refused
try:
    run(sys.argv[1] + "/full")
except ResultsError as error:
    print(error)
assert none_left()
try:
    run_scene("hertz-sphere", sys.argv[1] + "/bad", settings=["contact.load=-1 N"])
except InputError:
    print("bad scene")
assert none_left() and len(started) == 2
pages.make = real_make
real_figures = pages.draw_all
def one_fails(run, names, folder, formats, failed, processes):
    failed("pressure-map", ZeroDivisionError("no"))
    return real_figures(run, names[1:], folder, formats, failed, processes)
pages.draw_all = one_fails
print([note["text"] for note in run(sys.argv[1] + "/one").summary["notes"]])
"""
    full, bad, notes = told(code, tmp_path).splitlines()
    assert full == "figures: cannot be made (disk full)"
    assert bad == "bad scene"
    assert (
        "Drawing figure pressure-map failed; the results are complete. It ended with ZeroDivisionError('no')." in notes
    )
    assert "Drawing figure pressure-map failed" in (tmp_path / "one" / "report.html").read_text()
    assert not (tmp_path / "bad").exists()


CUT = """
import os, signal, sys, time
import bem.plots.pages as pages
import bem.plots.side_by_side as module
module.cores = lambda: 2
signal.signal(signal.SIGINT, signal.default_int_handler)  # may be ignored where tests run
def cut(*given):
    if given:  # in the middle of a picture
        (given[0].path / "figures").mkdir()
        (given[0].path / "figures" / ".writing-1-pressure-map.png").write_bytes(b"half")
    open("copy", "w").write(str(os.getpid()))
    {sent}
    time.sleep(600)
pages.{where} = cut
sys.argv = ["bem", "run", "hertz-sphere", "--set", "grid.shape=32", "--out", "run"]
from bem.cli import main
main()
"""


@LINUX
@pytest.mark.parametrize(
    ("where", "sent"),
    [("load_what_draws", "os.killpg(0, signal.SIGINT)"), ("make", "os.kill(os.getppid(), signal.SIGINT)")],
)
def test_an_interrupt_ends_the_copy_and_leaves_no_half_file(tmp_path, where, sent):
    """The copy interrupts, as Ctrl-C would, and sleeps for longer than the test may take."""
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run(
        [sys.executable, "-c", CUT.format(where=where, sent=sent)],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=400,
        env=environment,
        start_new_session=True,
    )
    assert done.returncode == 130, done.stderr
    assert "Traceback" not in done.stderr
    with pytest.raises(ProcessLookupError):
        os.kill(int((tmp_path / "copy").read_text()), 0)
    assert not list(tmp_path.rglob(".*"))
    assert not (tmp_path / "run" / "summary.json").exists()
    if where == "make":
        assert "--resume goes on" in done.stderr
        again = [sys.executable, "-m", "bem", "run", "hertz-sphere", "--set", "grid.shape=32", "--out", "run"]
        subprocess.run([*again, "--resume"], cwd=tmp_path, capture_output=True, timeout=400, check=True)
        assert (tmp_path / "run" / "summary.json").is_file()


@pytest.mark.internal
@pytest.mark.parametrize(
    ("value", "text"), [(1e-3, "10⁻³"), (1.0, "10⁰"), (1e12, "10¹²"), (0.002, "2×10⁻³"), (-1e-3, "−10⁻³")]
)
def test_powers_of_ten_are_plain_text(value, text):
    from matplotlib.figure import Figure

    axes = Figure().add_subplot()
    axes.set_yscale("symlog" if value < 0 else "log")
    axes.set_ylim(value / 2, value * 3)
    formatter = PlainPowers(labelOnlyBase=False)
    formatter.set_axis(axes.yaxis)
    formatter.set_locs([value])
    assert formatter(value).replace("-", "−") == text


def test_what_is_drawn_for_nobody_leaves_the_fonts_of_all_figures(tmp_path):
    code = """
from matplotlib import font_manager
from bem.plots.draw import draw_all, draw_for_nobody
draw_for_nobody()
read = []
usual = font_manager._get_font
font_manager._get_font = lambda *given, **more: read.append(usual.cache_info().misses) or usual(*given, **more)
before = usual.cache_info().misses
done = run(sys.argv[1] + "/run", workers=1)
assert before > 0 and read
assert usual.cache_info().misses == before, (before, usual.cache_info())
"""
    told(code, tmp_path)
