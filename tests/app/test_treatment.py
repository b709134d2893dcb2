"""Surfaces of the page: what memory does not hold is refused before any work, and mistakes name their field."""

import pytest

from bem import InputError
from bem.app import treatment
from bem.app.treatment import treated

pytestmark = pytest.mark.internal

FILE = "example/ground-disk.al3d"


def test_a_surface_is_resampled_and_says_so_in_the_words_of_a_scene():
    found = treated(FILE, {"cells": 32, "detrend": "plane", "crop": "", "centre": ""})
    assert dict(found.figures)["cells"] == "32 x 32"
    assert found.grid["shape"] == [32, 32]
    assert found.surface == {"kind": "measured", "path": FILE, "detrend": "plane"}
    assert treated(FILE, {}).grid is None


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({"cells": 0}, "cells = 0"),
        ({"cells": 10**9}, "cells = 1000000000"),
        ({"cells": "many"}, "cells"),
        ({"centre": ["5 um", "0 um"]}, "centre: moves the crop"),
        ({"detrend": "curved"}, "detrend"),
    ],
)
def test_mistakes_name_their_field(asked, message):
    with pytest.raises(InputError) as refused:
        treated(FILE, asked)
    assert refused.value.messages[0].startswith(message)


def test_more_cells_than_memory_holds_are_refused_before_any_work(monkeypatch):
    monkeypatch.setattr(treatment, "available_memory", lambda: 1e6)
    monkeypatch.setattr(treatment, "fitted", None)  # would be called
    with pytest.raises(InputError, match=r"cells: 4000 x 4000 need about .* allowed: at most about 91 x 91"):
        treated(FILE, {"cells": 4000})
