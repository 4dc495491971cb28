"""How a folder is written all or nothing: beside its place, under another name, and renamed when it is whole."""

from __future__ import annotations

import secrets
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from linkwright.designs.language.errors import ReleaseError


@contextmanager
def whole_folder(out: Path, is_ours: Callable[[Path], bool]) -> Iterator[Path]:
    """A new folder to write into; becomes `out` when the block ends well, and is gone when it does not.

    An older folder at `out` stays until the new one is whole. It is then renamed aside, the new one renamed in, and
    the old one deleted: at every moment `out` is the old folder, the new one, or for the instant between the two
    renames absent, and never a mixture.

    Args:
        out: where the folder shall be; missing parents are made, and taken away again if the block fails.
        is_ours: whether an existing folder may be replaced; an empty one always may.

    Raises:
        ReleaseError: something else is in the way, or the place cannot be written.
    """
    out = out.resolve()
    made: list[Path] = []
    draft: Path | None = None
    try:
        refuse_foreign(out, is_ours)
        _make_parents(out.parent, made)
        draft = _make_draft(out)
        yield draft
        refuse_foreign(out, is_ours)
        _swap(draft, out)
    except OSError as error:
        _withdraw(draft, made)
        raise _unwritable(out, error) from error
    except BaseException:
        _withdraw(draft, made)
        raise


def prove_writable(out: Path) -> None:
    """Find out before long work whether a folder can be made at `out`; leaves nothing there.

    Raises:
        ReleaseError: says why it cannot.
    """
    out = out.resolve()
    made: list[Path] = []
    draft: Path | None = None
    try:
        _make_parents(out.parent, made)
        draft = _make_draft(out)
    except OSError as error:
        raise _unwritable(out, error) from error
    finally:
        _withdraw(draft, made)


def refuse_foreign(out: Path, is_ours: Callable[[Path], bool]) -> None:
    """Refuse to replace what is not a folder of ours.

    Raises:
        ReleaseError: says what is in the way.
    """
    if not out.exists():
        return
    if not out.is_dir():
        raise ReleaseError(f"{out} is a file; a release needs a folder: choose another place")
    if any(out.iterdir()) and not is_ours(out):
        raise ReleaseError(f"{out} holds files that no release has written; nothing was touched: choose another place")


def _unwritable(out: Path, error: OSError) -> ReleaseError:
    return ReleaseError(f"{out} cannot be written: {error.strerror or error}: {error.filename or out.parent}")


def _make_draft(out: Path) -> Path:
    draft = out.parent / f".{out.name}.{secrets.token_hex(4)}.draft"
    draft.mkdir()
    return draft


def _make_parents(folder: Path, made: list[Path]) -> None:
    """Make what is missing and note each in `made`, so that it can be taken away even if the next one fails."""
    missing = [p for p in (folder, *folder.parents) if not p.exists()]
    for parent in reversed(missing):
        parent.mkdir()
        made.append(parent)


def _swap(draft: Path, out: Path) -> None:
    if not out.exists():
        draft.rename(out)
        return
    aside = out.parent / f".{out.name}.{secrets.token_hex(4)}.old"
    out.rename(aside)
    try:
        draft.rename(out)
    except BaseException:
        aside.rename(out)
        raise
    shutil.rmtree(aside)


def _withdraw(draft: Path | None, made: list[Path]) -> None:
    """Leave nothing behind; a parent that somebody else filled in the meantime stays."""
    if draft is not None:
        shutil.rmtree(draft, ignore_errors=True)
    for parent in reversed(made):
        if parent.is_dir() and not any(parent.iterdir()):
            parent.rmdir()
