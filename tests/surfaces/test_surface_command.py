"""`bem surface` and `bem particles` as a user calls them."""

import json
import sys

import numpy as np
import pytest

from bem import Surface, read_surface
from bem.cli import main
from bem.particles import synthetic_afm_map
from bem.surfaces import write_surface


@pytest.fixture
def call(monkeypatch, capsys):
    def run(*arguments):
        monkeypatch.setattr(sys, "argv", ["bem", *(str(a) for a in arguments)])
        with pytest.raises(SystemExit) as end:
            main()
        out = capsys.readouterr()
        return end.value.code or 0, out.out, out.err

    return run


GENERATE = ("--cells", "64", "--spacing", "100 nm", "--rms-height", "50 nm", "--seed", "3")


def test_a_spectrum_without_power_law_has_no_roll_off(call, tmp_path):
    """A Gaussian autocorrelation falls faster than any power: its fit of q^-18 had a roll-off wavelength beside it."""
    file = tmp_path / "a.npz"
    call("surface", "generate", file, *GENERATE, "--correlation-length", "0.5 um")
    _, out, _ = call("surface", "describe", file)
    assert "no power law" in out
    assert "roll-off" not in out
    assert "Hurst" not in out
    _, out, _ = call("surface", "describe", file, "--json")
    described = json.loads(out)
    assert {described[f"spectrum_{name}"] for name in ("hurst", "rolloff_wavelength", "density")} == {None}
    call("surface", "generate", file, *GENERATE, "--hurst", "0.8", "--rolloff-wavelength", "2 um")
    _, out, _ = call("surface", "describe", file)
    assert "roll-off wavelength" in out
    assert "Hurst exponent" in out


def test_generate_describe_plot(call, tmp_path):
    file = tmp_path / "a.npz"
    code, out, err = call("surface", "generate", file, *GENERATE, "--correlation-length", "0.5 um", "--kurtosis", "4")
    assert (code, err) == (0, "")
    assert "Sku, kurtosis" in out
    surface = read_surface(file, detrend="none")
    assert surface.shape == (64, 64)
    assert np.sqrt(np.mean(surface.heights**2)) == pytest.approx(50e-9, rel=1e-12)
    code, out, _ = call("surface", "describe", file, "--json")
    assert code == 0
    described = json.loads(out)
    assert described["Sku"] == pytest.approx(4, abs=1e-5)  # not levelled again, and known to be periodic
    assert described["autocorrelation_length_x"] == pytest.approx(0.5e-6, rel=0.05)
    for ending in ("png", "svg"):
        figure = tmp_path / f"a.{ending}"
        assert call("surface", "plot", file, figure)[0] == 0
        assert figure.stat().st_size > 10_000
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.npz", "a.png", "a.svg"]


def test_spikes_are_counted_and_their_removal_named(call, tmp_path):
    heights = np.random.default_rng(1).normal(0, 1e-8, (64, 64))
    heights[5, 7] = heights[40, 50] = 1e-6
    np.savez(tmp_path / "a.npz", heights=heights, spacing=(1e-6, 1e-6))
    code, out, _ = call("surface", "describe", tmp_path / "a.npz", "--detrend", "none")
    assert code == 0
    assert "2 points more than 6 standard deviations off" in out
    assert "--despike 6" in out
    code, out, _ = call("surface", "describe", tmp_path / "a.npz", "--detrend", "none", "--despike", "6")
    assert code == 0
    assert "caution" not in out
    assert "spikes taken out" in out


def test_what_is_left_after_despiking_is_said(call, tmp_path):
    """Nothing was taken out of a tilted map read with --despike 6, and the caution sent to --despike 6."""
    heights = np.random.default_rng(1).normal(0, 1e-8, (64, 64))
    np.savez(tmp_path / "a.npz", heights=heights, spacing=(1e-6, 1e-6))
    _, out, _ = call("surface", "describe", tmp_path / "a.npz", "--despike", "6")
    assert out.split("spikes taken out")[1].split()[0] == "0"
    heights[:3, 30:33] += 1e-6  # as wide as a spike, on the edge: one row goes, and then the next stands out
    np.savez(tmp_path / "a.npz", heights=heights, spacing=(1e-6, 1e-6))
    _, out, _ = call("surface", "describe", tmp_path / "a.npz", "--despike", "6")
    assert out.split("spikes taken out")[1].split()[0] == "3"
    assert "3 points still more than 6 standard deviations off the neighbours after despiking" in out


def test_a_share_of_filled_points_is_said_as_in_a_plan(call, tmp_path):
    heights = np.random.default_rng(1).normal(0, 1e-8, (64, 64))
    heights[np.random.default_rng(2).random((64, 64)) < 0.05] = np.nan
    np.savez(tmp_path / "a.npz", heights=heights, spacing=(1e-6, 1e-6))
    _, out, _ = call("surface", "describe", tmp_path / "a.npz")
    said = " ".join(out.split())
    assert "% of the map was filled smoothly from neighbouring points" in said
    assert "may be rougher" in said


@pytest.mark.parametrize(("factor", "told"), [(1e6, True), (1.0, False), (1e-3, True)])
def test_a_wrong_unit_of_heights_is_doubted_first(call, tmp_path, factor, told):
    heights = np.random.default_rng(1).normal(0, 1e-7 * factor, (32, 32))
    np.savez(tmp_path / "a.npz", heights=heights, spacing=(1e-6, 1e-6))
    _, out, _ = call("surface", "describe", tmp_path / "a.npz")
    assert ("is the height unit right?" in out.splitlines()[0]) == told


def test_measured(call, measured, tmp_path):
    code, out, _ = call("surface", "describe", measured / "opd-1.opd")
    assert code == 0
    assert "640 x 480" in out
    assert "points filled" in out
    code, out, _ = call("surface", "read", measured / "di-3.di", tmp_path / "di.npz", "--detrend", "curvature")
    assert code == 0
    assert read_surface(tmp_path / "di.npz").metadata["channel"] == "ZSensor"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("surface", "describe", "nothing.di"), "no such file"),
        (("surface", "generate", "a.npz", *GENERATE), "exactly one of --correlation-length"),
        (("surface", "generate", "a.txt", *GENERATE, "--hurst", "0.8"), "ending"),
        (("surface", "generate", "a.npz", *GENERATE, "--hurst", "0.8", "--cutoff-wavelength", "1 N"), "not a length"),
        (("surface", "generate", "a.npz", *GENERATE, "--correlation-length", "1 um,2 um,3 um"), "two separated"),
        (("surface", "generate", "a.npz", "--cells", "a", *GENERATE[2:], "--hurst", "0.8"), "--cells"),
        (("surface", "plot", "nothing.di", "a.gif"), "ending"),
        (("particles", "nothing.di"), "no such file"),
        (("particles", "nothing.di", "--threshold", "50"), "no such file"),
        (("particles", "nothing.di", "--threshold", "50 s"), "not a length"),
        (("particles", "nothing.di", "--figure", "a.bmp"), "ending"),
    ],
)
def test_bad_input_is_one_message_and_code_2(call, monkeypatch, tmp_path, arguments, message):
    monkeypatch.chdir(tmp_path)
    code, out, err = call(*arguments)
    assert code == 2
    assert out == ""
    assert message in err
    assert err.startswith("bem: ")
    assert len(err.splitlines()) == 1
    assert list(tmp_path.iterdir()) == []


def test_output_that_cannot_be_written(call, tmp_path):
    code, _, err = call("surface", "generate", tmp_path / "none" / "a.npz", *GENERATE, "--hurst", "0.8")
    assert code == 4
    assert "cannot write" in err


def test_particles(call, tmp_path):
    sample = synthetic_afm_map(seed=2, shape=(256, 256), lengths=(10e-6, 10e-6), count=30)
    file = write_surface(tmp_path / "afm.npz", Surface(sample.heights, sample.spacing))
    code, out, err = call(
        "particles", file, "--table", tmp_path / "p.csv", "--json", tmp_path / "p.json", "--figure", tmp_path / "p.png"
    )
    assert (code, err) == (0, "")
    figures = json.loads((tmp_path / "p.json").read_text())
    assert f"{figures['count']} particles" in out
    assert 24 <= figures["count"] <= 30
    assert figures["number_mean_radius_nm"] < figures["area_mean_radius_nm"] < figures["volume_mean_radius_nm"]
    table = np.genfromtxt(tmp_path / "p.csv", delimiter=",", names=True)
    assert len(table) == figures["count"]
    assert 1e9 * table["length_m"].mean() == pytest.approx(figures["length_nm"])
    assert (tmp_path / "p.png").stat().st_size > 10_000
    code, out, _ = call("particles", file, "--threshold", "5 um", "--json", tmp_path / "none.json")
    assert code == 0
    assert "no particles" in out
    assert json.loads((tmp_path / "none.json").read_text())["length_nm"] is None


@pytest.fixture
def table(tmp_path):
    """Heights of 100 nm rms in nanometres, as numbers alone."""
    heights = 1e-7 * np.random.default_rng(5).standard_normal((48, 48))
    np.savetxt(tmp_path / "disk.txt", heights / 1e-9)
    return tmp_path / "disk.txt"


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--spacing", "1 um"), "in metres they would have an rms slope of"),
        (("--spacing", "1"), "a number alone is in metres"),
        (("--height-unit", "nm"), 'how far its points are apart; give --spacing "0.5 um"'),
        ((), 'give --spacing "0.5 um" --height-unit nm'),
    ],
)
def test_a_table_without_its_scale_is_refused_by_every_command(call, table, options, message):
    # `bem particles` asked for spacing=(dx, dy), which is Python
    npz = table.with_suffix(".npz")
    for command in (("surface", "describe", table), ("surface", "read", table, npz), ("particles", table)):
        code, out, err = call(*command, *options)
        assert (code, out) == (2, "")
        assert message in err
    assert not table.with_suffix(".npz").exists()


@pytest.mark.parametrize(
    ("command", "message"),
    [
        (("particles", "--separate", "3"), "bem: --separate 3.0 must lie between 0 and 1\n"),
        (("particles", "--border", "both"), "bem: --border 'both' is not one of exclude, include\n"),
        (("surface", "describe", "--detrend", "plan"), "bem: --detrend 'plan' is not one of plane, curvature, none\n"),
        (("surface", "describe", "--despike", "1"), "bem: --despike 1.0 must be at least 3 standard deviations\n"),
    ],
)
def test_mistakes_are_said_of_the_options_and_not_of_the_library(call, table, command, message):
    code, _, err = call(*command, table, "--spacing", "1 um", "--height-unit", "nm")
    assert (code, err) == (2, message)


def test_a_spectrum_is_asked_for_by_its_options(call, tmp_path):
    surface = ("surface", "generate", tmp_path / "a.npz", "--cells", "64", "--spacing", "1 um", "--rms-height", "1 um")
    assert call(*surface)[2] == "bem: give exactly one of --correlation-length and --hurst\n"
    assert call(*surface, "--hurst", "2")[2].startswith("bem: --hurst 2.0 must lie")


def test_a_scale_is_for_the_maps_that_do_not_say_it(call, table):
    code, out, err = call(
        "surface", "describe", table, "example/ground-disk.al3d", "--spacing", "0.5 um", "--height-unit", "nm", "--json"
    )
    assert code == 0, err
    heights = json.loads(out)["parameters"]["Sq"]["values"]
    assert heights[0] == pytest.approx(1e-7, rel=0.05, abs=0)
    assert heights[1] == pytest.approx(read_surface("example/ground-disk.al3d").heights.std(), rel=1e-9, abs=0)


@pytest.mark.parametrize("separator", [" ", ";", "\t"])
def test_decimal_commas_are_named(call, table, separator):
    table.write_text(table.read_text().replace(".", ",").replace(" ", separator))
    code, _, err = call("surface", "describe", table, "--spacing", "1 um", "--height-unit", "nm")
    assert code == 2
    assert "its numbers have decimal commas; write decimal points" in err


def test_spikes_are_said_before_the_unit_which_is_judged_without_them(call, tmp_path):
    """25 spikes of 50 um: the unit of heights was doubted first, and spikes were named last."""
    rng = np.random.default_rng(0)
    waves = np.sin(np.arange(96) / 5)
    heights = 300 * (waves[:, None] + waves) + rng.standard_normal((96, 96))
    heights.ravel()[rng.choice(heights.size, 25, replace=False)] += 5e4
    np.savetxt(tmp_path / "a.txt", heights)
    _, out, _ = call("surface", "describe", tmp_path / "a.txt", "--spacing", "0.5 um", "--height-unit", "nm")
    assert out.startswith("caution: 25 points more than 6 standard deviations off the neighbours")
    assert "height unit right" not in out
