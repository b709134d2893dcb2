"""The tests that guard each room, public doors first: files and folders of `tests`."""

from __future__ import annotations

GATES = ["tests/verification"]
"""Comparisons with finite elements and closed forms: run for survivors of any room, last of all."""

GUARDS: dict[str, list[str]] = {
    "kernels": ["tests/kernels", "tests/test_convolution.py", "tests/test_stress.py"],
    "transforms": ["tests/test_transforms.py", "tests/test_convolution.py", "tests/test_column_products.py",
                   "tests/test_stress.py", "tests/stress", "tests/tangential/test_slip_transforms.py"],
    "operator": ["tests/test_convolution.py", "tests/contact", "tests/kernels"],
    "contact": ["tests/contact", "tests/scenes/test_contact_scenes.py", "tests/accuracy/test_contact_bars.py"],
    "stress": ["tests/test_stress.py", "tests/stress", "tests/numerics/test_subcell.py", "tests/wear"],
    "lubrication": ["tests/lubrication"],
    "friction": ["tests/friction"],
    "wear": ["tests/wear"],
    "tribofilm": ["tests/tribofilm", "tests/scenes/test_tribofilm_kind.py"],
    "surfaces": ["tests/surfaces"],
    "particles": ["tests/particles"],
    "distributed": ["tests/distributed"],
    "profiles": ["tests/profiles", "tests/scenes/test_wheel_rail.py"],
    "viscoelastic": ["tests/viscoelastic"],
    "tangential": ["tests/tangential", "tests/scenes/test_partial_slip_kind.py", "tests/scenes/test_rolling_kind.py"],
    "results": ["tests/results", "tests/reliability/test_damaged_runs.py"],
}  # fmt: skip
"""For each room the files and folders whose tests are run, in this order."""

LEFT_OUT = "not fem and not browser"
"""Tests that need programs from outside are never run."""
