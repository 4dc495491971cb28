"""On which line of a TOML text each key stands."""

from __future__ import annotations

import tomllib
from functools import cache
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tree_sitter import Node, Parser


def lines_of(text: str) -> dict[str, int]:
    """Line (from 1) of every table and key by its dotted name; the i-th of an array of tables is `name.<i>`.

    The text may be broken elsewhere: what the grammar still recognises is located.
    """
    lines: dict[str, int] = {}
    counts: dict[str, int] = {}
    for node in _parser().parse(text.encode()).root_node.named_children:
        if node.type == "pair":
            _locate_pair(node, "", lines)
        elif node.type in ("table", "table_array_element"):
            _locate_table(node, counts, lines)
    return lines


def words_of(key: str) -> list[str]:
    """The words of a dotted key as TOML reads them (quoted words may hold dots).

    Raises:
        tomllib.TOMLDecodeError: the text is not a key.
    """
    table = tomllib.loads(f"{key} = 0")
    words = []
    while isinstance(table, dict):
        [(word, table)] = table.items()
        words.append(word)
    return words


@cache
def _parser() -> Parser:
    import tree_sitter
    import tree_sitter_toml

    return tree_sitter.Parser(tree_sitter.Language(tree_sitter_toml.language()))


def _locate_table(node: Node, counts: dict[str, int], lines: dict[str, int]) -> None:
    words = _key_words(node)
    if not words:
        return
    is_array = node.type == "table_array_element"
    if is_array:
        name = ".".join(words)
        counts[name] = counts.get(name, -1) + 1
    dotted = _join(words, counts)
    lines.setdefault(dotted, node.start_point.row + 1)
    for pair in node.named_children:
        if pair.type == "pair":
            _locate_pair(pair, dotted, lines)


def _locate_pair(node: Node, prefix: str, lines: dict[str, int]) -> None:
    words = _key_words(node)
    if not words:
        return
    line = node.start_point.row + 1
    for word in words:
        prefix = f"{prefix}.{word}" if prefix else word
        lines.setdefault(prefix, line)
    for value in node.named_children:
        _locate_value(value, prefix, lines)


def _locate_value(node: Node, prefix: str, lines: dict[str, int]) -> None:
    if node.type == "inline_table":
        for pair in node.named_children:
            if pair.type == "pair":
                _locate_pair(pair, prefix, lines)
    elif node.type == "array":
        items = [item for item in node.named_children if item.type != "comment"]
        for i, item in enumerate(items):
            lines.setdefault(f"{prefix}.{i}", item.start_point.row + 1)
            _locate_value(item, f"{prefix}.{i}", lines)


def _join(words: list[str], counts: dict[str, int]) -> str:
    """Dotted name in which each array of tables is followed by the index of its latest element."""
    plain, dotted = "", ""
    for word in words:
        plain = f"{plain}.{word}" if plain else word
        dotted = f"{dotted}.{word}" if dotted else word
        if plain in counts:
            dotted += f".{counts[plain]}"
    return dotted


def _key_words(node: Node) -> list[str]:
    key = next((c for c in node.named_children if c.type in ("bare_key", "quoted_key", "dotted_key")), None)
    if key is None or key.text is None or key.has_error:
        return []
    return words_of(key.text.decode())
