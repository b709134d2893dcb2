"""Cases of the golden net, each run once in a test session, by whichever worker comes to it first."""

import json
import os

from filelock import FileLock

from reports.golden.groups import run_case
from reports.golden.record import Record


def shared_folder(tmp_path_factory):
    """Folder that all workers of this session see."""
    base = tmp_path_factory.getbasetemp()
    folder = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "golden"
    folder.mkdir(exist_ok=True)
    return folder


def record_of(folder, group, case):
    """The record of a case, and the folder in which it ran; other workers wait for the one that runs it."""
    place = folder / f"{group}-{case}"
    path = place.with_suffix(".json")
    with FileLock(place.with_suffix(".lock")):
        if not path.exists():
            path.write_text(json.dumps(run_case(group, case, folder=place).plain()))
    return Record.of(json.loads(path.read_text())), place
