"""Mechanisms from outside the package: Python files that hold `ENTRIES`, named by the user, never by a design file.

A design file is data; code runs only where somebody names its file (`linkwright --mechanisms FILE`, the environment
variable LINKWRIGHT_MECHANISMS, or a call of `add_mechanisms`).
"""

from __future__ import annotations

import hashlib
import importlib.util
import re
import sys
import traceback
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

from . import catalogue
from .catalogue import Entry
from .file.keys import NAME_PATTERN
from .language.errors import LinkwrightError

#: Begins the names of their modules, so that none can hide another module.
_PREFIX = "linkwright_outside_"


class MechanismFileError(LinkwrightError):
    """A file of mechanisms that cannot be taken: says file, line where known, and what would be right."""

    def __init__(self, path: Path | str, line: int | None, message: str) -> None:
        super().__init__(f"{path}:{line}: {message}" if line is not None else f"{path}: {message}")
        self.path, self.line, self.message = str(path), line, message


def add_mechanisms(paths: Iterable[Path | str]) -> tuple[Entry, ...]:
    """Run the files and put their mechanisms into the catalogue; a file is run once in a process.

    Args:
        paths: Python files, or folders with an `__init__.py`, that define `ENTRIES: tuple[Entry, ...]`.

    Returns:
        the entries of all files, in their order.

    Raises:
        MechanismFileError: a file is missing, fails, holds no entries, or gives a name that is taken.
    """
    added: list[Entry] = []
    for path in dict.fromkeys(Path(p).resolve() for p in paths):
        entries = _entries_of(path)
        try:
            catalogue.add(entries)
        except catalogue.NameTakenError as error:
            raise MechanismFileError(path, None, str(error)) from error
        added += entries
    return tuple(added)


def find_place(error: BaseException) -> str:
    """File and line, as "FILE:LINE", of the innermost step of an error that lies in a file from outside; else empty."""
    places = [
        f"{step.filename}:{step.lineno}"
        for step in traceback.extract_tb(error.__traceback__)
        if any(_is_of(step.filename, module) for module in _modules())
    ]
    return places[-1] if places else ""


@cache
def _entries_of(path: Path) -> tuple[Entry, ...]:
    module = _run(path)
    entries = getattr(module, "ENTRIES", None)
    is_whole = isinstance(entries, tuple | list) and all(isinstance(entry, Entry) for entry in entries)
    if not is_whole or not entries:
        found = "has no ENTRIES" if entries is None else f"has ENTRIES = {_short(entries)}"
        raise MechanismFileError(
            path,
            None,
            f"{found}; it must define ENTRIES = (Entry(...), ...) with at least one linkwright.designs.catalogue.Entry",
        )
    for entry in entries:
        _check_entry(path, entry)
    return tuple(entries)


def _run(path: Path) -> ModuleType:
    source = path / "__init__.py" if path.is_dir() else path
    if not source.is_file():
        raise MechanismFileError(path, None, "does not exist" if source == path else "is a folder without __init__.py")
    # The path is in the name, so that two files of one name are two modules.
    name = f"{_PREFIX}{path.stem}_{hashlib.sha256(str(path).encode()).hexdigest()[:8]}"
    folders = [str(path)] if path.is_dir() else None
    spec = importlib.util.spec_from_file_location(name, source, submodule_search_locations=folders)
    if spec is None or spec.loader is None:
        raise MechanismFileError(path, None, "must be a Python file (.py) or a folder with an __init__.py")
    module = sys.modules[name] = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except SyntaxError as error:
        del sys.modules[name]
        raise MechanismFileError(error.filename or path, error.lineno, f"is no Python: {error.msg}") from error
    except Exception as error:
        failure = _failure(path, error, "fails")
        del sys.modules[name]
        raise failure from error
    return module


def _check_entry(path: Path, entry: Entry) -> None:
    """Refuse an entry that the commands could not use; its default design must build."""
    if not re.fullmatch(NAME_PATTERN, entry.name):
        raise MechanismFileError(path, None, f"name {entry.name!r} must be letters, digits, _, - and .")
    box = (entry.workspace.lower, entry.workspace.upper)
    if any(len(corner) != len(entry.task) for corner in box):
        sizes = f"{len(box[0])} and {len(box[1])} numbers"
        raise MechanismFileError(
            path, None, f"{entry.name}: the workspace's corners have {sizes}, the task {len(entry.task)} coordinates"
        )
    try:
        mechanism = entry.default_design().mechanism
    except Exception as error:
        raise _failure(path, error, f"{entry.name} cannot be built with its defaults") from error
    if mechanism.name != entry.name:
        raise MechanismFileError(
            path, None, f"the entry is called {entry.name!r}, the mechanism that it builds {mechanism.name!r}"
        )


def _failure(path: Path, error: Exception, what: str) -> MechanismFileError:
    file, _, line = find_place(error).rpartition(":")
    return MechanismFileError(file or path, int(line) if line else None, f"{what}: {type(error).__name__}: {error}")


def _modules() -> list[ModuleType]:
    return [module for name, module in list(sys.modules.items()) if name.startswith(_PREFIX)]


def _is_of(filename: str, module: ModuleType) -> bool:
    return filename == getattr(module, "__file__", None)


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
