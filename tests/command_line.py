"""The command `bem` in the process of the test: a process of its own takes a second and a half to start."""

import contextlib
from types import SimpleNamespace

from typer.testing import CliRunner

from bem.cli import build
from bem.errors import BemError


def run_command(*words, cwd):
    """Run `bem` with these arguments in a folder; return its `returncode`, `stdout` and `stderr` as a process has them.

    That `main` turns an error into its exit code and messages is tested in tests/test_cli_commands.py.
    """
    with contextlib.chdir(cwd):
        done = CliRunner().invoke(build(), [str(word) for word in words])
    error = done.exception
    if isinstance(error, BemError):
        messages = getattr(error, "messages", None) or [str(error)]
        stderr = done.stderr + "".join(f"bem: {message}\n" for message in messages)
        return SimpleNamespace(returncode=error.exit_code, stdout=done.stdout, stderr=stderr)
    if error is not None and not isinstance(error, SystemExit):
        raise error
    return SimpleNamespace(returncode=done.exit_code, stdout=done.stdout, stderr=done.stderr)
