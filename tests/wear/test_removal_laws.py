"""Removal as a law: by name, table or object the same pieces; one of your own; what is refused."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest

import bem
from bem import InputError
from bem.laws import parameter, unregister
from bem.wear import WearModel, segment
from bem.wear.removal import Cap, RemovalLaw, TopRun

DEPTHS = np.linspace(0, 9e-8, 10)
STACK = np.abs(np.random.default_rng(4).normal(size=(10, 24, 20))).cumsum(axis=0)[::-1] / 4


@pytest.mark.internal
@pytest.mark.parametrize(("name", "law"), [("cap", Cap()), ("top_run", TopRun())])
def test_a_name_a_table_and_a_law_are_the_same(name, law):
    named = segment(STACK, DEPTHS, yield_stress=1.5, removal=name)
    assert named.count > 0
    for other in (law, {"kind": name}):
        same = segment(STACK, DEPTHS, yield_stress=1.5, removal=other)
        assert (same.labels == named.labels).all()
        assert (same.thickness == named.thickness).all()
    assert WearModel(removal=name).removal == law


@pytest.mark.internal
def test_a_law_of_your_own():
    """Pieces thinner than a least thickness stay: those of `cap` without them, counted anew."""

    @dataclass(frozen=True)
    class Thick(RemovalLaw):
        """As `cap`, but only thick pieces leave."""

        name: ClassVar[str] = "thick"
        least: float = parameter("thickness that leaves", "m", above=0)

        def remove(self, runs, parent, labels, thickness):
            count = Cap().remove(runs, parent, labels, thickness)
            deepest = np.zeros(count + 1)
            np.maximum.at(deepest, labels, thickness)
            kept = deepest >= self.least
            labels[:] = np.where(kept, np.cumsum(kept), 0)[labels]
            thickness[labels == 0] = 0
            return int(kept.sum())

    bem.register(Thick)
    try:
        rng = np.random.default_rng(5)
        stack = 2 * rng.random((1, 24, 20)) * np.linspace(1, 0.2, 10)[:, None, None]
        whole = segment(stack, DEPTHS, yield_stress=1.5)
        ours = segment(stack, DEPTHS, yield_stress=1.5, removal={"kind": "thick", "least": 1e-8})
        assert 0 < ours.count < whole.count
        assert ours.thickness[ours.labels > 0] == pytest.approx(whole.thickness[ours.labels > 0], rel=0)
        assert all(ours.thickness[ours.labels == k].max() >= 1e-8 for k in range(1, ours.count + 1))
        assert WearModel(removal=Thick(least=1e-8)).removal == Thick(least=1e-8)
    finally:
        unregister(Thick)


def test_an_unknown_name_is_refused():
    with pytest.raises(InputError, match="removal 'cup' is unknown - did you mean 'cap'"):
        segment(STACK, DEPTHS, yield_stress=1.5, removal="cup")
    with pytest.raises(InputError, match="WearModel: removal 'cup' is unknown - did you mean 'cap'"):
        WearModel(removal="cup")
