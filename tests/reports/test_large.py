"""What the page says of large contacts is what the stored experiments found."""

import json

from reports import large
from reports.experiments import large_contact, slab_transforms


def test_large_contacts_stay_below_75_bytes_a_cell_and_are_told():
    rows = json.loads(large_contact.RESULT.read_text())
    assert {"2048", "4096"} <= set(rows)
    for size, row in rows.items():
        assert row["status"] == "converged"
        assert row["residual"] <= large_contact.TOLERANCE
        if int(size) >= 2048:
            assert max(row["surface_bytes_a_cell"], row["contact_bytes_a_cell"]) < 75
        assert f"{row['convolutions']:.1f}" in large.contacts()


def test_threads_do_less_work_than_slabs_of_processes_at_every_size():
    rows = json.loads(slab_transforms.RESULT.read_text())
    for size, row in rows.items():
        assert row["processor_s"]["bem_2"] < row["processor_s"]["slabs_of_2"]
        assert size in large.slabs()


def test_slabs_give_the_field_back():
    slabs = slab_transforms.Slabs(32, 2)
    before = slabs.field.copy()
    slabs.pair()
    slabs.end()
    assert abs(slabs.field - before).max() < 1e-14
