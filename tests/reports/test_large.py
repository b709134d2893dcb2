"""What the page says of large contacts is what the stored experiments found."""

import json
import subprocess
import sys

from bem.runs.scene import plan_scene
from reports import large
from reports.experiments import kept, large_contact, large_published, slab_transforms


def test_stored_contacts_are_shown_and_whole_runs_planned_within_half_of_what_they_took():
    rows = json.loads(large_contact.RESULT.read_text())
    for size, row in rows.items():
        assert f"{row['convolutions']:.1f}" in large.contacts()
        if "run_bytes_a_cell" in row:
            planned = plan_scene(large_contact.scene_of(int(size)))[1].memory / int(size) ** 2
            assert 1 / 1.5 < planned / row["run_bytes_a_cell"] < 1.5
            assert f"{row['run_bytes_a_cell']:.0f} (" in large.contacts()


def test_the_published_contact_stands_beside_one_of_its_size_area_and_tolerance():
    own, other = (kept.found(large_published.RESULT.stem)[name] for name in ("bem", "published"))
    assert (own["cells"], own["status"]) == (other["cells"], "converged")
    assert abs(own["contact_fraction"] - other["contact_fraction"]) < 1e-3
    assert max(own["residual"], own["penetration"], own["complementarity"]) < other["tolerance"]
    assert f"{own['processor_s']:.3g}" in large.published()
    assert "161" in large.published()


def test_a_contact_takes_less_than_75_bytes_a_cell_in_a_fresh_process():
    """Bytes of each further cell: the libraries' memory and stores of bounded size come on top."""
    few, many = (
        json.loads(
            subprocess.run(
                [
                    sys.executable,
                    "-m",
                    "reports.experiments.large_contact",
                    "--alone",
                    "--size",
                    str(size),
                    "--threads",
                    "1",
                ],
                capture_output=True,
                text=True,
                check=True,
            ).stdout.splitlines()[-1]
        )
        for size in (1024, 2048)
    )
    for what in ("surface_bytes_a_cell", "contact_bytes_a_cell"):
        assert 2048**2 * many[what] - 1024**2 * few[what] < 75 * (2048**2 - 1024**2)


def test_a_run_of_16384_cells_a_side_is_planned_within_24_gigabytes():
    """One body rough and elastic, or both and capped: heights are on disk where nobody needs them."""
    scene = large_contact.scene_of(16384)
    assert plan_scene(scene)[1].memory < 20e9
    both = scene | {"upper": scene["lower"], "contact": scene["contact"] | {"behaviour": "capped", "hardness": "8 GPa"}}
    planned = plan_scene(both)[1]
    assert planned.memory < 22e9
    assert "on disk" in next(step.why for step in planned.steps if step.name == "surfaces")


def test_slabs_give_the_field_back():
    slabs = slab_transforms.Slabs(32, 2)
    before = slabs.field.copy()
    slabs.pair()
    slabs.end()
    assert abs(slabs.field - before).max() < 1e-14
