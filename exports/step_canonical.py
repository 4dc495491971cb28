"""Why the same design gives the same STEP bytes: entities renumbered by what they say, not by where they lay in memory.

The kernel writes the blocks of colours in the order of memory addresses and takes the ids of assembly occurrences
from a counter of the process. Here every entity gets a hash of its text in which references are replaced by the
hashes of what they refer to (a Merkle hash), refined by who refers to it; entities are then written children first,
from the roots in the order of their hashes, and numbered anew.
"""

from __future__ import annotations

import hashlib
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from linkwright.designs.language.errors import ReleaseError

#: A string (quotes are doubled inside it) or a reference; strings are matched so that a "#1" in a name is none.
_TOKEN = re.compile(r"'(?:[^']|'')*'|#\d+")
_BREAK = re.compile(r"'(?:[^']|'')*'|\s*\n\s*")
_ENTITY = re.compile(r"#(\d+)\s*=\s*((?:'(?:[^']|'')*'|[^';])*);")
_OCCURRENCE_START = "NEXT_ASSEMBLY_USAGE_OCCURRENCE("
_OCCURRENCE = re.compile(r"(NEXT_ASSEMBLY_USAGE_OCCURRENCE\()'(?:[^']|'')*'")
_OCCURRENCE_NAME = re.compile(r"NEXT_ASSEMBLY_USAGE_OCCURRENCE\('','((?:[^']|'')*)'")
_SCHEMA = re.compile(r"FILE_SCHEMA\s*\(.*?\)\s*\)\s*;", re.DOTALL)

#: A release has no time of day; the standard wants one.
_TIMESTAMP = "1970-01-01T00:00:00"


@dataclass(frozen=True, slots=True, kw_only=True)
class StepHeader:
    """What the file's header says: name of the content, one line about it, and the program that wrote it."""

    name: str
    description: str
    system: str

    def text(self, schema: str) -> str:
        """The HEADER section's statements."""
        name, description, system = (_quoted(t) for t in (self.name, self.description, self.system))
        return (
            f"FILE_DESCRIPTION(({description}),'2;1');\n"
            f"FILE_NAME({name},'{_TIMESTAMP}',(''),(''),{system},{system},'');\n"
            f"{schema}\n"
        )


def canonical_step(text: str, header: StepHeader) -> str:
    """The same model as `text` in an order and with a header that depend on nothing but its content.

    Raises:
        ReleaseError: the text has no DATA section or entities that refer to each other in a circle.
    """
    schema = _SCHEMA.search(text)
    start, end = text.find("\nDATA;"), text.rfind("\nENDSEC;")
    if schema is None or start < 0 or end < start:
        raise ReleaseError(f"{header.name}: the STEP writer gave a text without schema or DATA section")
    graph = _Graph.parsed(text[start + len("\nDATA;") : end], header.name)
    order = graph.canonical_order(header.name)
    number = {entity: i + 1 for i, entity in enumerate(order)}
    lines = []
    n_occurrences = 0
    for entity in order:
        body = "".join(_renumbered(graph.pieces[entity], graph.children[entity], number))
        if body.startswith(_OCCURRENCE_START):
            n_occurrences += 1
            body = _OCCURRENCE.sub(rf"\g<1>'{n_occurrences}'", body, count=1)
        lines.append(f"#{number[entity]}={body};\n")
    schema_text = re.sub(r"\s+", " ", schema.group(0))
    head = f"ISO-10303-21;\nHEADER;\n{header.text(schema_text)}ENDSEC;\n"
    return f"{head}DATA;\n{''.join(lines)}ENDSEC;\nEND-ISO-10303-21;\n"


@dataclass(frozen=True, slots=True)
class _Graph:
    """Entities by index: `pieces[i]` is the text around the references `children[i]` (one piece more than children)."""

    pieces: list[list[str]]
    children: list[list[int]]

    @classmethod
    def parsed(cls, data: str, name: str) -> _Graph:
        found = [(int(m.group(1)), _one_line(m.group(2))) for m in _ENTITY.finditer(data)]
        index = {number: i for i, (number, _) in enumerate(found)}
        pieces, children = [], []
        for number, body in found:
            if body.startswith(_OCCURRENCE_START):
                body = _OCCURRENCE.sub(r"\g<1>''", body)
            own: list[str] = []
            refs: list[int] = []
            last = 0
            for token in _TOKEN.finditer(body):
                if token.group(0)[0] == "'":
                    continue
                target = int(token.group(0)[1:])
                if target not in index:
                    raise ReleaseError(f"{name}: STEP entity #{number} refers to #{target}, which is not in the file")
                own.append(body[last : token.start()])
                refs.append(index[target])
                last = token.end()
            own.append(body[last:])
            pieces.append(own)
            children.append(refs)
        return cls(pieces, children)

    def canonical_order(self, name: str) -> list[int]:
        """All entities, children first, roots in the order of names and hashes."""
        upward = self._children_first(name)
        roots = self._roots()
        labels = [hashlib.blake2b("\0".join(own).encode(), digest_size=16).digest() for own in self.pieces]
        labels = self._refined(labels, upward)
        while (tied := _first_tie([labels[root] for root in roots])) is not None:
            # Roots that look the same from everywhere: any of them may come first, but then the others look different.
            labels[roots[tied]] = hashlib.blake2b(labels[roots[tied]] + b"first", digest_size=16).digest()
            labels = self._refined(labels, upward)
        order: list[int] = []
        state = bytearray(len(labels))
        for root in sorted(roots, key=lambda i: (self._occurrence_name(i), labels[i])):
            self._visit(root, state, order, name)
        return order

    def _roots(self) -> list[int]:
        referred = {child for refs in self.children for child in refs}
        return [i for i in range(len(self.children)) if i not in referred]

    def _refined(self, labels: list[bytes], upward: Sequence[int]) -> list[bytes]:
        """Labels refined until no two entities that differ in what is around them share one."""
        n_classes = 0
        while True:
            labels = self._refined_by_referrers(self._refined_by_children(labels, upward), upward)
            if len(set(labels)) == n_classes:
                return labels
            n_classes = len(set(labels))

    def _refined_by_children(self, labels: Sequence[bytes], upward: Sequence[int]) -> list[bytes]:
        out = [b""] * len(labels)
        for i in upward:
            out[i] = hashlib.blake2b(labels[i] + b"".join(out[c] for c in self.children[i]), digest_size=16).digest()
        return out

    def _refined_by_referrers(self, labels: Sequence[bytes], upward: Sequence[int]) -> list[bytes]:
        heard: list[list[bytes]] = [[] for _ in labels]
        out = [b""] * len(labels)
        for i in reversed(upward):
            out[i] = hashlib.blake2b(labels[i] + b"".join(sorted(heard[i])), digest_size=16).digest()
            for position, child in enumerate(self.children[i]):
                heard[child].append(out[i] + position.to_bytes(4, "big"))
        return out

    def _children_first(self, name: str) -> list[int]:
        """A topological order, by depth-first search without recursion (chains of faces are long)."""
        state = bytearray(len(self.children))
        order: list[int] = []
        for root in range(len(self.children)):
            self._visit(root, state, order, name)
        return order

    def _visit(self, root: int, state: bytearray, order: list[int], name: str) -> None:
        if state[root]:
            return
        stack: list[tuple[int, Iterator[int]]] = [(root, iter(self.children[root]))]
        state[root] = 1
        while stack:
            entity, pending = stack[-1]
            child = next((c for c in pending if state[c] != 2), None)
            if child is None:
                state[entity] = 2
                order.append(entity)
                stack.pop()
            elif state[child] == 1:
                raise ReleaseError(f"{name}: STEP entities refer to each other in a circle: {self.pieces[child][0]}...")
            else:
                state[child] = 1
                stack.append((child, iter(self.children[child])))

    def _occurrence_name(self, root: int) -> list[tuple[int, str]]:
        """Name of the assembly occurrence that a root places, so that trees show leg_1, leg_2, leg_10; else empty."""
        near = [root]
        for _ in range(2):
            near += [child for entity in near for child in self.children[entity]]
        for entity in near:
            match = _OCCURRENCE_NAME.match(self.pieces[entity][0])
            if match:
                return [(int(w) if w.isdigit() else -1, w) for w in re.split(r"(\d+)", match.group(1))]
        return []


def _first_tie(labels: Sequence[bytes]) -> int | None:
    """Index of a root with the smallest label that is not its own; None if all differ."""
    count = Counter(labels)
    tied = min((label for label in labels if count[label] > 1), default=None)
    return None if tied is None else labels.index(tied)


def _renumbered(pieces: Sequence[str], children: Sequence[int], number: dict[int, int]) -> Iterator[str]:
    for piece, child in zip(pieces, children, strict=False):
        yield piece
        yield f"#{number[child]}"
    yield pieces[-1]


def _one_line(body: str) -> str:
    """Line breaks taken out: outside strings with the blanks around them, inside strings the break alone."""
    if "\n" not in body:
        return body
    return _BREAK.sub(lambda m: m.group(0).replace("\n", "") if m.group(0)[0] == "'" else "", body)


def _quoted(text: str) -> str:
    r"""A STEP string: quotes and backslashes doubled, all but printable ASCII as \X2\ escapes."""
    doubled = text.replace("'", "''").replace("\\", "\\\\")
    return "'" + "".join(c if 32 <= ord(c) < 127 else f"\\X2\\{ord(c):04X}\\X0\\" for c in doubled) + "'"
