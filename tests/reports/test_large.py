"""What the page says of large contacts is what the stored experiments found."""

import json

from bem.runs.scene import plan_scene
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


def test_whole_runs_stay_below_80_bytes_a_cell_and_are_planned_within_half_of_it():
    """Each further cell: libraries and stores of bounded size have 30 to 120 bytes a cell at 4096 and 2048."""
    rows = {int(size): row for size, row in json.loads(large_contact.RESULT.read_text()).items()}
    runs = {size: row for size, row in rows.items() if "run_bytes_a_cell" in row}
    assert {2048, 4096} <= set(runs)
    for size, row in runs.items():
        assert row["run_status"] == "converged"
        assert row["run_pictures"] == 6
        planned = plan_scene(large_contact.scene_of(size))[1].memory / size**2
        assert 1 / 1.5 < planned / row["run_bytes_a_cell"] < 1.5
        assert f"{row['run_bytes_a_cell']:.0f} (" in large.contacts()
    few, many = (runs[size]["run_bytes_a_cell"] * size**2 for size in (2048, 4096))
    assert many - few < 80 * (4096**2 - 2048**2)


def test_a_run_of_16384_cells_a_side_is_planned_within_24_gigabytes():
    """One body rough and elastic, or both and capped: heights are on disk where nobody needs them."""
    scene = large_contact.scene_of(16384)
    assert plan_scene(scene)[1].memory < 20e9
    both = scene | {"upper": scene["lower"], "contact": scene["contact"] | {"behaviour": "capped", "hardness": "8 GPa"}}
    planned = plan_scene(both)[1]
    assert planned.memory < 22e9
    assert "on disk" in next(step.why for step in planned.steps if step.name == "surfaces")


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
