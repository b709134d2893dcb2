"""Surfaces by process: what is drawn has the statistics stated, in scenes as from Python."""

import sys
import typing

import numpy as np
import pytest

from bem import Grid, InputError, describe_surface, generate_surface, load_scene
from bem.cli import main
from bem.scenes.build import check_surfaces, heights_of
from bem.scenes.common import GeneratedSurface
from bem.surfaces.describe import radial_spectrum
from bem.surfaces.processes import PROCESSES, ProcessName


def patch_of(process, lay="y", cells=128):
    """A grid of sixteen correlation lengths each way, or of eight roll-offs."""
    lengths = process.lengths(lay)
    sides = [16 * length for length in lengths] if lengths else [8 * process.rolloff_wavelength] * 2
    return Grid((cells, cells), (sides[0] / cells, sides[1] / cells), periodic=(True, True))


@pytest.mark.parametrize("name", PROCESSES)
def test_what_is_drawn_is_what_is_stated(name):
    process = PROCESSES[name]
    assert process.usual[0] <= process.rms_height <= process.usual[1]
    for lay in ("x", "y") if process.directional else ("y",):
        grid = patch_of(process, lay)
        heights = generate_surface(grid, seed=1, **process.statistics(lay))
        found = describe_surface(heights, grid.spacing, periodic=(True, True))
        assert found.Sq == pytest.approx(process.rms_height, rel=1e-9)
        # moments are met to 1e-6 by the generator
        assert (found.Ssk, found.Sku) == pytest.approx((process.skewness, process.kurtosis), abs=1e-5)
        lengths = process.lengths(lay)
        if lengths is None:
            spectrum = radial_spectrum(heights, grid.spacing, periodic=(True, True))
            steep = spectrum.wavenumber > 2 * 2 * np.pi / process.rolloff_wavelength
            slope = np.polyfit(np.log(spectrum.wavenumber[steep]), np.log(spectrum.density[steep]), 1)[0]
            # rings of finite width and few waves: the exponent of one sample scatters by some hundredths
            assert slope == pytest.approx(-2 - 2 * process.hurst, abs=0.05)
        else:
            pair = found.autocorrelation_length_x, found.autocorrelation_length_y
            # 0.1 % of the spectrum; with skewness its shape gives way by a few per cent
            assert pair == pytest.approx(lengths, rel=0.03)


def test_the_figures_of_ideal_cusps():
    """Parabolas of a round nose, one feed: what the source of "turned" derives."""
    feed, nose = 1e-4, 8e-4
    x = (np.arange(20000) + 0.5) / 20000 - 0.5
    z = (feed * x) ** 2 / (2 * nose)
    z -= z.mean()
    rms = np.sqrt(np.mean(z**2))
    assert rms == pytest.approx(2 / np.sqrt(45) * feed**2 / (8 * nose), rel=1e-6)
    assert PROCESSES["turned"].rms_height == pytest.approx(rms, rel=0.02)  # given to two digits
    assert np.mean(z**3) / rms**3 == pytest.approx(0.64, abs=0.005)
    assert np.mean(z**4) / rms**4 == pytest.approx(2.14, abs=0.005)
    correlation = np.fft.ifft(np.abs(np.fft.fft(z)) ** 2).real
    lag = np.argmax(correlation < correlation[0] / np.e) / 20000 * feed
    assert PROCESSES["turned"].across == pytest.approx(lag, rel=0.01)  # given to three digits


@pytest.mark.internal
def test_names_and_places():
    assert set(typing.get_args(ProcessName)) == set(PROCESSES)
    with pytest.raises(InputError, match="lay 'z'"):
        PROCESSES["ground"].statistics("z")


SCENE = {
    "kind": "contact",
    "grid": {"shape": 64, "lengths": ["100 um", "700 um"], "periodic": True},
    "lower": {"material": "steel-52100", "surface": {"process": "ground"}},
    "contact": {"mean_pressure": "50 MPa"},
}


def scene_of(**surface):
    return load_scene({**SCENE, "lower": {"material": "steel-52100", "surface": surface}})


@pytest.mark.internal
@pytest.mark.parametrize("lay", ["x", "y"])
def test_a_scene_of_a_process_is_that_surface(lay):
    ground = PROCESSES["ground"]
    surface = scene_of(process="ground", lay=lay).lower.surface
    grid = patch_of(ground, lay, 64)
    drawn = heights_of(surface, grid, 3)
    direct = generate_surface(grid, seed=3, **ground.statistics(lay))
    # the pair goes through mean and ratio and back: round-off of lengths, and of the search for the spectrum's
    np.testing.assert_allclose(drawn, direct, rtol=0, atol=1e-6 * ground.rms_height)
    assert "Aachen" in surface.source
    again = GeneratedSurface(**surface.model_dump(exclude_none=True))  # what a run's scene.toml says
    assert again == surface


def test_a_resolved_surface_keeps_its_process():
    """Its statistics would win over those of another process, without a word."""
    resolved = scene_of(process="ground").lower.surface.model_dump(exclude_none=True)
    with pytest.raises(InputError, match="process honed beside statistics of ground"):
        scene_of(**resolved | {"process": "honed"})


def test_what_is_given_beside_a_process_wins():
    surface = scene_of(process="polished", rms_height="5 nm", correlation_length="4 um").lower.surface
    assert (surface.rms_height, surface.correlation_length, surface.hurst) == (5e-9, 4e-6, None)
    assert "The scene itself gives correlation_length, rms_height" in surface.source
    surface = scene_of(process="ground", hurst=0.7).lower.surface
    assert (surface.hurst, surface.correlation_length, surface.elongation) == (0.7, None, None)


@pytest.mark.parametrize(
    ("surface", "message"),
    [
        ({"process": "grund"}, r'lower\.surface = "grund": .*did you mean "ground"'),
        ({"process": "ball", "lay": "x"}, "ball has no lay; allowed: none, or one of ground, turned"),
        ({"rms_height": "1 nm", "correlation_length": "1 um", "kind": "generated", "lay": "x"}, "lay without process"),
        ({"process": "ground", "lay": "x", "elongation": 0.5}, "ridges the other way"),
    ],
)
def test_mistakes_are_said(surface, message):
    with pytest.raises(InputError, match=message):
        scene_of(**surface)


@pytest.mark.internal
def test_a_grid_too_small_for_a_process_is_said_before_any_work():
    surface = scene_of(process="ground").lower.surface
    with pytest.raises(InputError, match=r'correlation_length .*\(set by process = "ground"'):
        check_surfaces(Grid((64, 64), (1e-6, 1e-6)), lower=surface)
    own = scene_of(process="superfinished", correlation_length="40 um").lower.surface
    with pytest.raises(InputError, match=r"a larger grid, or shorten lower\.surface\.correlation_length$"):
        check_surfaces(Grid((64, 64), (1e-6, 1e-6)), lower=own)


def test_the_command_lists_them(monkeypatch, capsys):
    for arguments, words in ((["surfaces"], "ground in one direction"), (["surfaces", "turned"], "Molnar")):
        monkeypatch.setattr(sys, "argv", ["bem", *arguments])
        with pytest.raises(SystemExit) as end:
            main()
        assert not end.value.code
        assert words in capsys.readouterr().out
