"""The one sorted list of mechanisms: name, what it is, where it comes from, its sections, its default workspace."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from .design import Design, Workspace
from .five_bar import mechanism as five_bar
from .five_bar.workspace import FIVE_BAR_WORKSPACE
from .haptic_pen import mechanism as haptic_pen
from .haptic_pen.workspace import HAPTIC_PEN_WORKSPACE
from .hit import mechanism as hit
from .hit.workspace import HIT_WORKSPACE
from .inoue import mechanism as inoue
from .inoue.workspace import INOUE_WORKSPACE
from .kaist import mechanism as kaist
from .kaist.workspace import KAIST_WORKSPACE
from .kjist import mechanism as kjist
from .kjist.workspace import KJIST_WORKSPACE
from .language.errors import LinkwrightError, UnknownNameError
from .language.mechanism import Coordinate, Mechanism
from .pathos2 import mechanism as pathos2
from .pathos2.workspace import PATHOS2_WORKSPACE
from .sensation import mechanism as sensation
from .sensation.workspace import SENSATION_WORKSPACE
from .stewart import mechanism as stewart
from .stewart.workspace import STEWART_WORKSPACE
from .twin_pantograph import mechanism as twin_pantograph
from .twin_pantograph.workspace import TWIN_PANTOGRAPH_WORKSPACE
from .uci import mechanism as uci
from .uci.workspace import UCI_WORKSPACE


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


def _entry(name: str, of: Any, cls: type[Mechanism], workspace: Workspace) -> Entry:
    """The row of a mechanism whose module holds SECTIONS and TASK."""
    return Entry(
        name=name,
        title=cls.title,
        source=cls.source,
        sections=of.SECTIONS,
        task=of.TASK,
        workspace=workspace,
        build=cls,
    )


_ENTRIES = {
    "five_bar": _entry("five_bar", five_bar, five_bar.FiveBar, FIVE_BAR_WORKSPACE),
    "haptic_pen": _entry("haptic_pen", haptic_pen, haptic_pen.HapticPen, HAPTIC_PEN_WORKSPACE),
    "hit": _entry("hit", hit, hit.Hit, HIT_WORKSPACE),
    "inoue": _entry("inoue", inoue, inoue.Inoue, INOUE_WORKSPACE),
    "kaist": _entry("kaist", kaist, kaist.Kaist, KAIST_WORKSPACE),
    "kjist": _entry("kjist", kjist, kjist.Kjist, KJIST_WORKSPACE),
    "pathos2": _entry("pathos2", pathos2, pathos2.Pathos2, PATHOS2_WORKSPACE),
    "sensation": _entry("sensation", sensation, sensation.Sensation, SENSATION_WORKSPACE),
    "stewart": _entry("stewart", stewart, stewart.Stewart, STEWART_WORKSPACE),
    "twin_pantograph": _entry(
        "twin_pantograph", twin_pantograph, twin_pantograph.TwinPantograph, TWIN_PANTOGRAPH_WORKSPACE
    ),
    "uci": _entry("uci", uci, uci.Uci, UCI_WORKSPACE),
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


class NameTakenError(LinkwrightError):
    """Two mechanisms of one name."""

    def __init__(self, name: str, title: str) -> None:
        super().__init__(f"there is already a mechanism called {name!r} ({title}); give yours another name")
        self.name = name


def add(entries: Iterable[Entry]) -> None:
    """Take up mechanisms from outside the package, all or none; an entry that is there already stays.

    Raises:
        NameTakenError: another mechanism has one of the names.
    """
    joined = dict(_ENTRIES)
    for new in entries:
        taken = joined.setdefault(new.name, new)
        if taken is not new:
            raise NameTakenError(new.name, taken.title)
    _ENTRIES.update(joined)
