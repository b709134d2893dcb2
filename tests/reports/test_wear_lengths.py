"""The chapter on wear criteria shows the stored experiment, and changes over meshes are of the seeds that both have."""

import pytest

from reports import wear_lengths


def test_a_change_over_meshes_is_of_the_seeds_that_both_have(monkeypatch):
    def row(mesh, seed, size):
        return {"criterion": "any", "group": "cells", "value": mesh, "seed": seed, "size": size}

    stored = (row("51 nm", 1, 2.0), row("51 nm", 2, 9.0), row("25 nm", 1, 4.0), row("25 nm", 2, None))
    monkeypatch.setattr(wear_lengths, "rows", lambda: stored)
    assert wear_lengths.change("any", "size") == pytest.approx(0.5)
    assert wear_lengths.by_seed("any", "cells", "25 nm", "size") == {1: 4.0}


def test_verdicts_are_drawn_and_tables_have_every_group():
    assert "data:image/png" in wear_lengths.verdicts().body
    tables = wear_lengths.tables()
    assert len(tables) == 2 + len(wear_lengths._BESIDE)
    assert all("fatigue" in section.body for section in tables)
