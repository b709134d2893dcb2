"""Run examples of the documentation again and store their numbers and pictures."""

from __future__ import annotations

import argparse

from reports.docs.tasks import TASKS, renew

if __name__ == "__main__":
    names = list(TASKS)
    parser = argparse.ArgumentParser(prog="python -m reports.docs.tasks", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"any of {', '.join(names)}")
    for name in parser.parse_args().names or names:
        print(name, flush=True)
        renew(name)
