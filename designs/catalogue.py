"""The one sorted list of mechanisms: name, what it is, where it comes from, its sections, its default workspace."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from .design import Design, Workspace
from .hit import mechanism as hit
from .hit.workspace import HIT_WORKSPACE
from .language.errors import UnknownNameError
from .language.mechanism import Coordinate, Mechanism


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """A mechanism of the catalogue.

    Attributes:
        sections: table of the design file -> dataclass of its numbers, in the order in which they are written.
        workspace: the box that the default design must serve.
        build: makes the mechanism from instances of the sections; missing ones take their defaults.
    """

    name: str
    title: str
    source: str
    sections: Mapping[str, type]
    task: tuple[Coordinate, ...]
    workspace: Workspace
    build: Callable[[Mapping[str, Any]], Mechanism]

    def default_sections(self) -> dict[str, Any]:
        """Instances of all sections with their default numbers."""
        return {key: section() for key, section in self.sections.items()}

    def default_design(self) -> Design:
        """The design that `linkwright new` writes down."""
        return Design(name=self.name, mechanism=self.build(self.default_sections()), workspace=self.workspace)


_ENTRIES = {
    "hit": Entry(
        name="hit",
        title=hit.Hit.title,
        source=hit.Hit.source,
        sections=hit.SECTIONS,
        task=hit.TASK,
        workspace=HIT_WORKSPACE,
        build=hit.Hit,
    ),
}


def names() -> tuple[str, ...]:
    """Catalogue names, sorted."""
    return tuple(sorted(_ENTRIES))


def entry(name: str) -> Entry:
    """The entry of this name.

    Raises:
        UnknownNameError: lists the known names.
    """
    if name not in _ENTRIES:
        raise UnknownNameError("mechanism", name, names())
    return _ENTRIES[name]
