"""The stored Contact-Mechanics Challenge: its surface, theories of the contact area, and what the page says of it."""

import math
from pathlib import Path

import numpy as np
import pytest

from reports.experiments import contact_challenge, kept

PAGE = Path(kept.__file__).parents[1] / "docs" / "theory" / "contact.md"


def rows(way):
    found = kept.found(contact_challenge.RESULT.stem)
    return {row["cells"]: row for row in found if row["way"] == way}


def test_the_slope_is_one_with_all_waves_and_grids_share_their_waves():
    surfaces = {cells: contact_challenge.surface_of(cells) for cells in (128, 256)}
    spectra = {cells: np.fft.rfft2(heights) / cells**2 for cells, (_, heights) in surfaces.items()}
    waves = {}
    for cells, spectrum in spectra.items():
        shift = np.exp(-1j * math.pi * np.arange(1, 20) / cells)  # of the cells' centres
        waves[cells] = (spectrum[:20, 1:20] * shift * np.exp(-1j * math.pi * np.arange(20) / cells)[:, None]).ravel()
    assert np.abs(waves[128] / waves[256] - 1).max() < 0.02  # of one rms height, with more waves on the finer grid
    assert rows("without")[4096]["rms_slope"] == pytest.approx(1.0, abs=0.02)  # differences of cells of a quarter wave


def test_the_area_without_adhesion_lies_between_the_theories():
    """Persson's area at light load is sqrt(8 / pi) p / (E* slope), that of Bush, Gibson and Thomas sqrt(2 pi)."""
    row = rows("without")[4096]
    factor = row["contact_area_fraction"] * row["rms_slope"] / 0.01
    assert math.sqrt(8 / math.pi) < factor < math.sqrt(2 * math.pi)


def test_adhesion_adds_area_and_more_after_a_higher_load():
    dry, towards, back, resolved = (rows(way) for way in contact_challenge.WAYS)
    for cells, row in towards.items():
        assert dry[cells]["contact_area_fraction"] < resolved[cells]["contact_area_fraction"]
        assert resolved[cells]["contact_area_fraction"] < row["contact_area_fraction"]
        assert row["mean_gap_nm"] < dry[cells]["mean_gap_nm"]
    for cells, row in back.items():
        assert row["contact_area_fraction"] > towards[cells]["contact_area_fraction"]


def test_the_page_has_the_stored_figures():
    text = PAGE.read_text("utf-8")
    for way in contact_challenge.WAYS:
        for row in rows(way).values():
            assert f"{100 * row['contact_area_fraction']:.2f}" in text
