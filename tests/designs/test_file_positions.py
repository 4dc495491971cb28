"""Keys of all forms of TOML are found on their lines."""

from __future__ import annotations

import pytest

from linkwright.designs.file.positions import lines_of, words_of

TEXT = """# comment
a = 1
"b c" = 2
d.e = 3

[t]   # comment
x = [
  1,   # one
  2,
]
[t.u.'v.w']
y = { p = 1, q = { r = 2 } }
[[rows]]
k = 1
[[rows]]
k = 2
[rows.deep]
m = 1
"""


def test_lines_of_every_form_of_key():
    lines = lines_of(TEXT)
    assert {k: lines[k] for k in ("a", "b c", "d", "d.e", "t", "t.x", "t.x.1")} == {
        "a": 2,
        "b c": 3,
        "d": 4,
        "d.e": 4,
        "t": 6,
        "t.x": 7,
        "t.x.1": 9,
    }
    assert (lines["t.u.v.w"], lines["t.u.v.w.y"], lines["t.u.v.w.y.q.r"]) == (11, 12, 12)
    assert [lines[k] for k in ("rows.0", "rows.0.k", "rows.1", "rows.1.k", "rows.1.deep", "rows.1.deep.m")] == [
        13,
        14,
        15,
        16,
        17,
        18,
    ]


def test_a_broken_line_does_not_hide_the_others():
    assert lines_of("a = 1\nthis is no toml\nb = 2\n")["a"] == 1


@pytest.mark.parametrize(("key", "words"), [("a.b", ["a", "b"]), ("'a.b'.c", ["a.b", "c"]), (" a . b ", ["a", "b"])])
def test_words_of_a_dotted_key(key, words):
    assert words_of(key) == words
