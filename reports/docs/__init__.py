"""Documentation: Markdown pages, the Sphinx extension that fills their tables, the runs behind the examples."""

from __future__ import annotations

from pathlib import Path

EXAMPLES = Path(__file__).resolve().parent / "examples"
"""Files of code and scenes that pages show and tests run."""
