"""Which distinct parts an assembly consists of, under which names they are drawn, stocked and filed."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from linkwright.designs.language.bodies import Part
from linkwright.generator.assembly import Assembly
from linkwright.generator.solids import Solid


@dataclass(frozen=True, slots=True, kw_only=True)
class Use:
    """One place where a product sits."""

    body: str
    kind: str
    part: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Product:
    """One distinct part: equal solid, equal material, equal designation.

    Attributes:
        name: unique among the products of an assembly and fit for a file name.
        part: the first part that uses it (material, designation, fit).
        solid: its shape in its own frame.
        uses: every place, in the order of the bodies.
    """

    name: str
    part: Part
    solid: Solid
    uses: tuple[Use, ...]

    @property
    def is_made(self) -> bool:
        """It is made, not bought."""
        return not self.part.purchased


ProductKey = tuple[str, str, str]


def product_key(part: Part, solid: Solid) -> ProductKey:
    """What makes two parts one product."""
    return solid.key, part.material, part.purchased


def products_of(assembly: Assembly) -> dict[ProductKey, Product]:
    """The distinct parts in the order of their first use."""
    first: dict[ProductKey, tuple[Part, Solid]] = {}
    uses: dict[ProductKey, list[Use]] = {}
    for body in assembly.bodies:
        for placed in body.parts:
            key = product_key(placed.part, placed.solid)
            first.setdefault(key, (placed.part, placed.solid))
            uses.setdefault(key, []).append(Use(body=body.body.name, kind=body.body.kind, part=placed.part.name))
    names = _distinct([list(_candidates(first[key][0], uses[key])) for key in first])
    return {
        key: Product(name=name, part=first[key][0], solid=first[key][1], uses=tuple(uses[key]))
        for key, name in zip(first, names, strict=True)
    }


def _candidates(part: Part, uses: Sequence[Use]) -> Iterator[str]:
    """Names from the plainest to the most explicit."""
    if part.purchased:
        yield slug(part.purchased)
        yield slug(f"{part.purchased}_{part.name}")
        return
    kind, own = _shared_words([use.kind for use in uses]), _shared_words([use.part for use in uses])
    yield slug(_joined(kind, own or part.name))
    yield slug(_joined(uses[0].kind, part.name))


def _joined(kind: str, part: str) -> str:
    """Kind and part in one name, words that end the one and begin the other said once: upper_bar, bar -> upper_bar."""
    first, second = kind.split("_") if kind else [], part.split("_")
    overlap = next(n for n in range(min(len(first), len(second)), -1, -1) if first[len(first) - n :] == second[:n])
    return "_".join([*first, *second[overlap:]])


def _distinct(candidates: Sequence[Sequence[str]]) -> list[str]:
    """One name each: the first candidate that nobody else has at the same stage, else the last with a number."""
    depth = [0] * len(candidates)
    for _ in range(max((len(c) for c in candidates), default=0)):
        chosen = [c[d] for c, d in zip(candidates, depth, strict=True)]
        count = Counter(chosen)
        depth = [d + (count[n] > 1 and d + 1 < len(c)) for c, d, n in zip(candidates, depth, chosen, strict=True)]
    chosen = [c[d] for c, d in zip(candidates, depth, strict=True)]
    count = Counter(chosen)
    taken = {name for name in chosen if count[name] == 1}
    names = []
    for name in chosen:
        free, n = name, 1
        while count[name] > 1 and free in taken:
            n += 1
            free = f"{name}_{n}"
        taken.add(free)
        names.append(free)
    return names


def _shared_words(names: Sequence[str]) -> str:
    """The words that all names have at one place, without the numbers: leg_1_up_1_pin, leg_2_up_1_pin -> leg_up_pin."""
    if len(set(names)) == 1:
        return names[0]
    places = zip(*(name.split("_") for name in names), strict=False)
    return "_".join(words[0] for words in places if len(set(words)) == 1 and not words[0].isdigit())


def slug(text: str) -> str:
    """A name that is safe in every file system: letters, digits, dot, dash and underscore."""
    return re.sub(r"[^A-Za-z0-9._-]+", "_", text).strip("._") or "unnamed"
