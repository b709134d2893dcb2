"""Records of finished runs: dictionaries that hold tables, packed into plain columns for a checkpoint and back."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np


def pack_record(record: Mapping[str, Any], tables: Mapping[str, np.dtype[np.void]]) -> dict[str, Any]:
    """A record with each of its `tables` (name -> fields) as columns."""
    from bem.wear.running_in import pack_table

    return {**record, **{name: pack_table(record[name]) for name in tables}}


def unpack_record(packed: Mapping[str, Any], tables: Mapping[str, np.dtype[np.void]]) -> dict[str, Any]:
    """The record that `pack_record` was given."""
    from bem.wear.running_in import unpack_table

    return {**packed, **{name: unpack_table(packed[name], fields) for name, fields in tables.items()}}
