"""Copies of the tree: one that stays as it is, and scratch copies in which one line is changed at a time.

Compiled loops are kept in the package's `__pycache__/loops`, in folders named by a hash of what they are compiled from
(`bem.compiled`), so a scratch copy begins with those of the unchanged copy and compiles only what a change reaches.
Inside such a folder numba names the folder of a module by a hash of its path, which `in_tree` translates. After a
mutant the file gets its old text and time back, and each cache file that differs from that of the unchanged copy is
put back.
"""

from __future__ import annotations

import hashlib
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
WORK = ROOT / "build" / "mutants"
PACKAGE = "bem"


def sources(root: Path) -> list[str]:
    """Return the paths of the files that git tracks or would add."""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    listed = subprocess.run(command, cwd=root, capture_output=True, check=True).stdout.decode().split("\0")
    return sorted({name for name in listed if name and (root / name).is_file()})


def unchanged(root: Path = ROOT, work: Path = WORK) -> Path:
    """Return the unchanged copy of the tree, made or brought up to date; its caches stay."""
    copy, wanted = work / "unchanged", sources(root)
    new = not copy.exists()
    for name in wanted:
        source, target = root / name, copy / name
        if target.is_file() and target.read_bytes() == source.read_bytes():
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(source, target)
    kept = set(wanted)
    for path in [path for path in copy.rglob("*") if path.is_file() and "__pycache__" not in path.parts]:
        if path.relative_to(copy).as_posix() not in kept:
            path.unlink()
    if new:  # the checkout's compiled loops serve
        for name in caches(root):
            target = copy / in_tree(copy, name)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(root / name, target)
    link_shared(work, root)
    return copy


def link_shared(folder: Path, root: Path = ROOT) -> None:
    """Link the folder of measured surfaces, which tests look for beside the checkout, into the folder of a copy."""
    shared = root.parent / "shared"
    if shared.is_dir() and not (folder / "shared").exists():
        (folder / "shared").symlink_to(shared.resolve())


def caches(tree: Path) -> Iterator[str]:
    """Return the paths of the package's cached files in a tree: byte code and compiled loops."""
    for path in sorted((tree / PACKAGE).rglob("*")):
        if "__pycache__" in path.parts and path.is_file():
            yield path.relative_to(tree).as_posix()


def in_tree(tree: Path, name: str) -> str:
    """Return the path that a cached file of another tree has in this one."""
    parts = Path(name).parts
    if "loops" not in parts[:-1]:
        return name
    module, _, _ = parts[-3].rpartition("-")
    home = tree.resolve().joinpath(*module.split(".")[:-1])
    return Path(*parts[:-2], f"{home.name}_{hashlib.sha1(str(home).encode()).hexdigest()}", parts[-1]).as_posix()


class Scratch:
    """A scratch copy of the unchanged tree, for one change at a time."""

    def __init__(self, original: Path, folder: Path) -> None:
        self.original, self.folder = original, folder
        shutil.copytree(original, folder, ignore=shutil.ignore_patterns(".hypothesis", "loops"))
        self._put_back()
        link_shared(folder.parent)

    def write(self, file: str, text: str) -> None:
        """Replace the text of a file; it is then newer than all caches."""
        (self.folder / file).write_text(text, encoding="utf-8")

    def restore(self, file: str) -> None:
        """Undo a change: the file's text and time, and all cached files that are not those of the unchanged tree."""
        shutil.copy2(self.original / file, self.folder / file)
        self._put_back()

    def _put_back(self) -> None:
        wanted = {in_tree(self.folder, name): self.original / name for name in caches(self.original)}
        for name in list(caches(self.folder)):
            if name not in wanted:
                (self.folder / name).unlink()
        for name, source in wanted.items():
            target = self.folder / name
            if not target.exists() or _stamp(target) != _stamp(source):
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(source, target)


def _stamp(path: Path) -> tuple[int, int]:
    status = path.stat()
    return status.st_mtime_ns, status.st_size
