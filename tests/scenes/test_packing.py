"""Dataclasses in checkpoints: what was packed comes back, and nothing is made by name that is not a record of `bem`."""

from dataclasses import dataclass

import numpy as np
import pytest

from bem.errors import Status
from bem.grid import Grid
from bem.lubrication import Lubricant
from bem.lubrication.line.deflection import LineOperator
from bem.packing import packed, unpacked
from bem.results.checkpoint import load_checkpoint, save_checkpoint

pytestmark = pytest.mark.internal


@dataclass(frozen=True)
class Stranger:
    number: int


def test_records_come_back_from_a_file_and_given_things_are_not_stored(tmp_path):
    grid, oil, own = (
        Grid((4, 8), (1e-6, 2e-6), periodic=(False, True)),
        Lubricant(0.1, density_law="incompressible"),
        Stranger(3),
    )
    operator = LineOperator.of(np.array([0.0, 0.1, 1 / 3])).rescale(1.7)
    tree = {"all": packed((grid, [Status.STALLED, None, "text"], operator, oil, own), given=(oil, own))}
    save_checkpoint(tmp_path / "state", tree)
    found = unpacked(load_checkpoint(tmp_path / "state")["all"], given=(oil, own))
    assert found[:2] == (grid, [Status.STALLED, None, "text"])
    assert found[1][0] is Status.STALLED
    assert (found[2].unit, found[2].factor) == (operator.unit, operator.factor)
    assert np.array_equal(found[2].nodes, operator.nodes)
    assert found[3] is oil
    assert found[4] is own


def test_tables_and_mappings_come_back_from_a_file(tmp_path):
    table = np.zeros(3, [("cycle", np.int32), ("friction", np.float64), ("converged", np.bool_)])
    table["friction"] = 0.1, 1 / 3, np.nan
    save_checkpoint(tmp_path / "state", {"all": packed((table, {2: Status.STALLED, 0: (1.5, None)}, table[:0]))})
    found, mapping, empty = unpacked(load_checkpoint(tmp_path / "state")["all"])
    assert found.dtype == table.dtype
    assert found.tobytes() == table.tobytes()
    assert mapping == {2: Status.STALLED, 0: (1.5, None)}
    assert empty.dtype == table.dtype
    assert empty.size == 0


def test_only_records_of_the_package_have_names():
    with pytest.raises(TypeError, match="give it to both sides"):
        packed([Stranger(1)])
    for name in ("os:system", "bem.errors:InputError", "bem.grid:nothing", f"{__name__}:Stranger"):
        with pytest.raises(ValueError, match="no record of this package"):
            unpacked({"record": name, "fields": {}})
