"""The command line. Every module here adds one command; heavy imports wait until a command runs.

A new command is a new file with `def register(app: typer.Typer) -> None`. `ORDER` only sorts the help text.

Thin: reads options, calls one public function, prints. Sees everything, and nothing sees it. Verified in
tests/test_cli_commands.py, tests/reliability (bad input, killed runs) and tests/packaging (what a start imports).
"""

from __future__ import annotations

import atexit
import gc
import os
import signal
import sys
from typing import TYPE_CHECKING

from bem.cli._streams import code_at_end, protect_streams
from bem.errors import BemError, interrupts_as_they_are
from bem.startup.interrupts import catch_interrupts

if TYPE_CHECKING:
    import typer

# Small dense systems only: threads of the linear algebra spin without gain, and bits may depend on their number.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

_INTERRUPTED = 130
_MOST_LINES = 50

ORDER = (
    "run",
    "app",
    "plan",
    "scenes",
    "sweep",
    "report",
    "export",
    "plot",
    "compare",
    "cite",
    "new",
    "element",
    "schema",
    "oils",
    "materials",
    "surfaces",
    "surface",
    "particles",
    "calibrate",
    "verify",
    "bench",
    "warm-up",
)


def build() -> typer.Typer:
    """The application with all commands."""
    import importlib
    import pkgutil

    import typer

    app = typer.Typer(
        name="bem",
        help="Friction, wear particles, running-in and tribofilms of rough lubricated contacts.",
        no_args_is_help=True,
        pretty_exceptions_enable=False,
        rich_markup_mode=None,  # plain help: rich would take longer to import than all the rest
        context_settings={"help_option_names": ["-h", "--help"]},
    )

    @app.callback(invoke_without_command=True)
    def version(
        show: bool = typer.Option(False, "--version", help="Show the version and leave.", is_eager=True),
    ) -> None:
        if show:
            from bem import __version__

            typer.echo(f"bem {__version__}")
            raise typer.Exit()

    names = [module.name for module in pkgutil.iter_modules(__path__) if not module.name.startswith("_")]
    for name in sorted(names, key=lambda item: (ORDER.index(item) if item in ORDER else len(ORDER), item)):
        importlib.import_module(f"bem.cli.{name}").register(app)
    return app


def main() -> None:
    """Entry point: runs the command; errors made on purpose become one message per line and their exit code.

    Nothing that takes time is imported before the `try`: an interrupt is one from the first moment.
    """
    gc.disable()  # see `bem.startup.lazy.collecting`
    try:
        atexit.register(_done)
        catch_interrupts()
        protect_streams()
        with interrupts_as_they_are():
            build()(standalone_mode=True)
    except BemError as error:
        from bem.cli._terminal import print_text

        lines = getattr(error, "messages", None) or str(error).splitlines()
        for line in lines[:_MOST_LINES]:
            print_text(f"bem: {line}", file=sys.stderr)
        if len(lines) > _MOST_LINES:
            print(f"bem: and {len(lines) - _MOST_LINES} more", file=sys.stderr)
        sys.exit(error.exit_code)
    except KeyboardInterrupt:
        print("bem: interrupted", file=sys.stderr)
        _leave_interrupted()
    except SystemExit as end:
        if end.code == _INTERRUPTED:
            _leave_interrupted()
        if not isinstance(end.code, int | None):
            raise
        sys.exit(code_at_end(end.code or 0))
    except MemoryError:
        print("bem: out of memory; `bem plan SCENE` shows what takes how much", file=sys.stderr)
        sys.exit(1)


def _leave_interrupted() -> None:
    """End with the exit code of an interrupt. CPython itself ends by the signal instead where the interrupt once passed
    through `exec` of a text (as in a dataclass being made), even if it was caught afterwards."""
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(_INTERRUPTED)


def _done() -> None:
    """Ignore signals at exit: an interrupt while Python takes itself down must not turn success into failure.
    CPython gives such signals back to the system there, unless they are ignored."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGALRM):
        signal.signal(number, signal.SIG_IGN)
