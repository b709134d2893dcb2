"""Build the reports: `python -m reports [NAME ...] [--pdf] [--out DIR]`, all of them where none is named."""

from __future__ import annotations

import argparse
import importlib
from pathlib import Path

from reports.builder import HERE, write_site

REPORTS = ("verification", "performance", "validation", "guide")
GALLERY = "gallery"  # runs every built-in scene: only when it is named


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(prog="python -m reports", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"any of {', '.join(REPORTS)}")
    parser.add_argument("--pdf", action="store_true", help="print each page to PDF too (needs chromium)")
    parser.add_argument("--out", type=Path, default=HERE, help="folder to write into")
    parser.add_argument("--reduced", action="store_true", help="gallery: small grids, few cycles")
    options = parser.parse_args()
    unknown = [name for name in options.names if name not in (*REPORTS, GALLERY)]
    if unknown:
        parser.error(f"no report {', '.join(unknown)}; there are {', '.join((*REPORTS, GALLERY))}")
    pages = []
    for name in options.names or REPORTS:
        report = importlib.import_module(f"reports.{name}")
        if name == GALLERY:
            pages.append(report.build(options.out / GALLERY, reduced=options.reduced))
        else:
            pages.append(report.build())
    for path in write_site(pages, options.out, pdf=options.pdf):
        print(path)


if __name__ == "__main__":
    main()
