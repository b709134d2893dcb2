"""Build the reports: `python -m reports [NAME ...] [--pdf] [--out DIR]`, all of them where none is named."""

from __future__ import annotations

import argparse
import importlib
from pathlib import Path

from reports.builder import HERE, write_site

REPORTS = ("verification", "performance", "validation", "guide")


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(prog="python -m reports", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"any of {', '.join(REPORTS)}")
    parser.add_argument("--pdf", action="store_true", help="print each page to PDF too (needs chromium)")
    parser.add_argument("--out", type=Path, default=HERE, help="folder to write into")
    options = parser.parse_args()
    unknown = [name for name in options.names if name not in REPORTS]
    if unknown:
        parser.error(f"no report {', '.join(unknown)}; there are {', '.join(REPORTS)}")
    pages = [importlib.import_module(f"reports.{name}").build() for name in options.names or REPORTS]
    for path in write_site(pages, options.out, pdf=options.pdf):
        print(path)


if __name__ == "__main__":
    main()
