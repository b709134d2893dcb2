"""Build the reports: `python -m reports [NAME ...] [--pdf] [--out DIR]`, all of them where none is named.

`gallery` is built only where it is named: it runs every built-in scene, and goes on where it was interrupted. The exit
code is 1 where a scene failed or did not converge.
"""

from __future__ import annotations

import argparse
import importlib
import sys
from pathlib import Path

from reports.builder import HERE, write_site

REPORTS = ("verification", "performance", "validation", "friction")
NEEDED = "needed"
GALLERY = "gallery"  # runs every built-in scene: only when it is named


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(prog="python -m reports", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"any of {', '.join(REPORTS)}")
    parser.add_argument("--pdf", action="store_true", help="print each page to PDF too (needs chromium)")
    parser.add_argument("--out", type=Path, default=HERE, help="folder to write into")
    parser.add_argument("--reduced", action="store_true", help="gallery: small grids, few cycles")
    parser.add_argument(
        "--renew",
        nargs="*",
        metavar="RESULT",
        help="validation: run the named results, or all that are not of this commit; `needed`: those that are not "
        "stored, of another scene text or settings, or failed to reproduce",
    )
    parser.add_argument(
        "--set", action="append", default=[], metavar="RESULT:KEY=VALUE", help="renewal: a setting of a scene"
    )
    options = parser.parse_args()
    unknown = [name for name in options.names if name not in (*REPORTS, GALLERY)]
    if unknown:
        parser.error(f"no report {', '.join(unknown)}; there are {', '.join((*REPORTS, GALLERY))}")
    pages, failed = [], []
    if options.renew is not None:
        failed += renewed(parser, options.renew, options.set)
    for name in options.names or REPORTS:
        report = importlib.import_module(f"reports.{name}")
        if name == GALLERY:
            try:
                runs = report.run_gallery(options.out / GALLERY, reduced=options.reduced, say=say)
            except KeyboardInterrupt:
                say("interrupted; the same command goes on where it stopped")
                sys.exit(130)
            failed += report.unfinished(runs)
            pages.append(report.page(runs, reduced=options.reduced))
        else:
            pages.append(report.build())
    for path in write_site(pages, options.out, pdf=options.pdf):
        print(path)
    for words in failed:
        say(f"failed: {words}")
    sys.exit(1 if failed else 0)


def renewed(parser: argparse.ArgumentParser, names: list[str], settings: list[str]) -> list[str]:
    """Renew stored results of the validation; return a line for each that could not be renewed."""
    from reports.validation_renewal import is_needed, is_of_this_commit, jobs, renew, rerun, scripts

    given: dict[str, list[str]] = {}
    for setting in settings:
        name, colon, words = setting.partition(":")
        if not colon:
            parser.error(f"--set {setting}: allowed: RESULT:KEY=VALUE")
        given.setdefault(name, []).append(words)
    known, others = jobs(given), scripts()
    everything = {**known, **others}
    unknown = sorted({*names, *given} - {*everything, NEEDED} | {*given} & {*others})
    if unknown:
        parser.error(f"no stored result {', '.join(unknown)}; there are {', '.join(everything)}, and {NEEDED}")
    wanted = [name for name in names if name != NEEDED]
    if NEEDED in names:
        wanted += [name for name, job in everything.items() if is_needed(job) and name not in wanted]
    elif not names:
        wanted = [name for name, job in everything.items() if not is_of_this_commit(job)]
    try:
        failed = rerun([others[name] for name in wanted if name in others], say=say)
        return failed + renew([known[name] for name in wanted if name in known], say=say)
    except KeyboardInterrupt:
        say("interrupted; the same command goes on where it stopped")
        sys.exit(130)


def say(words: str) -> None:
    """A line on the error stream."""
    print(f"reports: {words}", file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
