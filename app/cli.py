"""The command line: one group whose words load what they need when they are used."""

from __future__ import annotations

import importlib
import json
import sys
import traceback
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from linkwright.designs.language.errors import DesignFileError, LinkwrightError

from .options import mechanisms_option

PASS, FINDINGS, FAILURE, INTERRUPTED = 0, 1, 2, 130

#: Word -> module below `app.commands`; each holds a click command called `command`.
COMMANDS = {
    "list": "listing",
    "new": "new",
    "show": "show",
    "ik": "inverse",
    "fk": "forward",
    "dexterity": "dexterity",
    "check": "check",
    "release": "release",
    "schema": "schema",
}


class Door(click.Group):
    """Loads words lazily and turns every failure into one clear line and an exit code."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """The words, in the order of work."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """The command of this word, its module loaded now."""
        if cmd_name not in COMMANDS:
            return None
        return importlib.import_module(f".commands.{COMMANDS[cmd_name]}", __package__).command

    def main(  # type: ignore[override]
        self, args: Sequence[str] | None = None, *, standalone_mode: bool = True, **extra: Any
    ) -> Any:
        """Run, and exit with 0 (pass), 1 (findings), 2 (usage or internal error) or 130 (interrupted)."""
        words = list(sys.argv[1:] if args is None else args)
        if not standalone_mode:
            return super().main(words, standalone_mode=False, **extra)
        try:
            code = super().main(words, standalone_mode=False, **extra)
        except click.Abort:
            click.echo("linkwright: interrupted", err=True)
            sys.exit(INTERRUPTED)
        except Exception as error:  # the door: nothing above it could handle this
            _tell(error, as_json="--json" in words, debug="--debug" in words)
            sys.exit(FAILURE)
        sys.exit(code if isinstance(code, int) else PASS)


def _tell(error: Exception, *, as_json: bool, debug: bool) -> None:
    """The error on stderr, with --json as an object on stdout."""
    if debug:
        traceback.print_exc()
    if as_json:
        click.echo(json.dumps({"error": _facts(error)}, indent=2, ensure_ascii=False))
        return
    if isinstance(error, click.UsageError):
        error.show()
        return
    for line in _message(error).splitlines():
        click.echo(click.style("error: ", fg="red", bold=True) + line, err=True)
    if not _is_expected(error) and not debug:
        click.echo(f"a fault of {_culprit(error)}; run again with --debug for the details", err=True)


def _culprit(error: Exception) -> str:
    from linkwright.designs.outside import find_place

    place = find_place(error)
    return f"the mechanism at {place}" if place else "linkwright, not of the design"


def _message(error: Exception) -> str:
    if isinstance(error, click.ClickException):
        return error.format_message()
    if isinstance(error, LinkwrightError):
        return str(error)
    if isinstance(error, OSError) and error.filename is not None:
        return f"{error.filename}: {error.strerror}"
    return f"{type(error).__name__}: {error}"


def _is_expected(error: Exception) -> bool:
    """The user can cause or cure it."""
    return isinstance(error, LinkwrightError | click.ClickException | OSError)


def _facts(error: Exception) -> dict[str, Any]:
    kind = "UsageError" if isinstance(error, click.UsageError) else type(error).__name__
    facts: dict[str, Any] = {"kind": kind, "message": _message(error)}
    if isinstance(error, DesignFileError):
        facts["errors"] = [
            {"path": e.path, "line": e.line, "key": e.key, "value": _plain(e.value), "allowed": e.allowed}
            for e in getattr(error, "errors", (error,))
        ]
    return facts


def _plain(value: object) -> Any:
    """JSON knows no infinity and no dates: such a value is shown as text."""
    is_finite = not isinstance(value, float) or value - value == 0.0
    return value if value is None or (isinstance(value, bool | int | float | str) and is_finite) else str(value)


@click.group(cls=Door, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110})
@click.version_option(package_name="linkwright", prog_name="linkwright")
@mechanisms_option
def cli(mechanisms: tuple[Path, ...]) -> None:
    """From one design file to a mechanism that can be built, checked and controlled.

    DESIGN is a design file (.toml) or a name of the catalogue.

    Exit codes: 0 pass, 1 findings or poses out of reach, 2 wrong usage or an error, 130 interrupted.
    """
    if mechanisms:
        from linkwright.designs.outside import add_mechanisms

        add_mechanisms(mechanisms)


def main() -> None:
    """Entry point of the installed script."""
    cli()
