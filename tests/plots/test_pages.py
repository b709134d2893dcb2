"""Pages of a run: what fails is said, an interrupt leaves no half file, and the command goes on from there."""

import os
import signal
import subprocess
import sys

import pytest

import bem.plots.pages as pages
from bem.errors import ResultsError
from bem.plots.pictures import PlainPowers
from bem.runs import run_scene

SMALL = ["grid.shape=32", "outputs.depths=[0.0]"]


@pytest.mark.internal
def test_a_folder_that_cannot_be_made_is_said(tmp_path, monkeypatch):
    def refused(*_):
        raise ResultsError("figures: cannot be made (disk full)")

    monkeypatch.setattr(pages, "make", refused)
    with pytest.raises(ResultsError, match="disk full"):
        run_scene("hertz-sphere", tmp_path / "full", settings=SMALL)


@pytest.mark.internal
def test_a_figure_that_fails_is_said_in_summary_and_report(tmp_path, monkeypatch):
    real = pages.draw_all

    def one_fails(run, names, folder, formats, failed):
        failed("pressure-map", ZeroDivisionError("no"))
        return real(run, [name for name in names if name != "pressure-map"], folder, formats, failed)

    monkeypatch.setattr(pages, "draw_all", one_fails)
    texts = [note["text"] for note in run_scene("hertz-sphere", tmp_path / "one", settings=SMALL).summary["notes"]]
    said = "Drawing figure pressure-map failed; the results are complete. It ended with ZeroDivisionError('no')."
    assert [text for text in texts if text.startswith(said)]
    assert "Drawing figure pressure-map failed" in (tmp_path / "one" / "report.html").read_text()


CUT = """
import os, signal, sys
import bem.plots.pages as pages
signal.signal(signal.SIGINT, signal.default_int_handler)  # may be ignored where tests run
def cut(given, *_):
    (given.path / "figures").mkdir()
    (given.path / "figures" / ".writing-1-pressure-map.png").write_bytes(b"half")
    os.kill(os.getpid(), signal.SIGINT)
    signal.pause()
pages.make = cut
sys.argv = ["bem", "run", "hertz-sphere", "--set", "grid.shape=32", "--out", "run"]
from bem.cli import main
main()
"""


@pytest.mark.skipif(not hasattr(signal, "pause"), reason="the system has no signal.pause")
def test_an_interrupt_while_drawing_leaves_no_half_file(tmp_path):
    done = subprocess.run([sys.executable, "-c", CUT], cwd=tmp_path, capture_output=True, text=True, timeout=400)
    assert done.returncode in (130, -signal.SIGINT), done.stderr
    assert "Traceback" not in done.stderr
    assert not list(tmp_path.rglob(".*"))
    assert not (tmp_path / "run" / "summary.json").exists()
    assert "--resume goes on" in done.stderr
    again = [sys.executable, "-m", "bem", "run", "hertz-sphere", "--set", "grid.shape=32", "--out", "run"]
    subprocess.run([*again, "--resume"], cwd=tmp_path, capture_output=True, timeout=400, check=True)
    assert (tmp_path / "run" / "summary.json").is_file()
    assert os.listdir(tmp_path / "run" / "figures")


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
