from __future__ import annotations

import re

import pytest

from linkwright.designs.language.errors import ReleaseError
from linkwright.exports.step_canonical import StepHeader, canonical_step

HEADER = StepHeader(name="thing", description="a thing", system="test")

DATA = [
    "PRODUCT('arm','arm #3','',(#9))",
    "PRODUCT('leg','it''s #1','',(#9))",
    "PRODUCT_CONTEXT('',#10,'mechanical')",
    "NEXT_ASSEMBLY_USAGE_OCCURRENCE('17','arm_10','',#0,#1,$)",
    "NEXT_ASSEMBLY_USAGE_OCCURRENCE('18','arm_2','',#0,#1,$)",
    "COLOUR_RGB('',0.1,0.2,0.3)",
    "STYLED_ITEM('color',(#5),#0)",
    "STYLED_ITEM('color',(#5),#1)",
    "COLOUR_RGB('',0.1,0.2,0.3)",
    "PRODUCT_CONTEXT('',#10,'mechanical')",
    "APPLICATION_CONTEXT('core')",
    "( LENGTH_UNIT() NAMED_UNIT(*) )",
]


def step_text(entities, order, first_id=17):
    """A STEP file whose entity `order[k]` stands k-th under the number k + 10."""
    number = {entity: k + 10 for k, entity in enumerate(order)}
    lines = []
    for entity in order:
        text = re.sub(r"(?<=[(,])#(\d+)", lambda m: f"#{number[int(m.group(1))]}", entities[entity])
        if "OCCURRENCE" in text:
            text = re.sub(r"\('\d+'", f"('{first_id}'", text)
            first_id += 1
        lines.append(f"#{number[entity]} = {text};")
    body = "\n".join(lines)
    return (
        f"ISO-10303-21;\nHEADER;\nFILE_NAME('x','2026-11-24T15:00:00');\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\n"
        f"DATA;\n{body}\nENDSEC;\nEND-ISO-10303-21;\n"
    )


def test_canonical_step_is_the_same_for_every_order_and_every_occurrence_counter(rng):
    wanted = canonical_step(step_text(DATA, range(len(DATA))), HEADER)
    for first_id in range(40):
        assert canonical_step(step_text(DATA, rng.permutation(len(DATA)).tolist(), first_id), HEADER) == wanted


@pytest.mark.parametrize("i", range(len(DATA)))
def test_canonical_step_changes_with_any_single_entity(i):
    changed = list(DATA)
    changed[i] = DATA[i].replace("arm", "arms").replace("leg", "legs").replace("co", "k").replace("(*)", "($)")
    changed[i] = (
        changed[i].replace("mech", "m").replace("0.1", "0.4").replace("''", "'x'", DATA[i].startswith("COLOUR"))
    )
    assert changed != DATA
    wanted = canonical_step(step_text(DATA, range(len(DATA))), HEADER)
    assert canonical_step(step_text(changed, range(len(DATA))), HEADER) != wanted


def test_canonical_step_keeps_references_inside_strings_as_they_are():
    text = canonical_step(step_text(DATA, range(len(DATA))), HEADER)
    assert "'arm #3'" in text
    assert "'it''s #1'" in text


def test_canonical_step_joins_strings_that_the_writer_broke():
    broken = [*DATA[:1], "PRODUCT('leg','one two \nthree\n four',\n  '',(#9)\n )", *DATA[2:]]
    assert "PRODUCT('leg','one two three four','',(" in canonical_step(step_text(broken, range(len(DATA))), HEADER)


def test_canonical_step_writes_children_before_what_refers_to_them():
    text = canonical_step(step_text(DATA, reversed(range(len(DATA)))), HEADER)
    for number, body in re.findall(r"^#(\d+)=(.*);$", text, re.MULTILINE):
        refs = re.findall(r"#(\d+)", re.sub(r"'(?:[^']|'')*'", "", body))
        assert all(int(ref) < int(number) for ref in refs)


def test_canonical_step_numbers_occurrences_in_the_natural_order_of_their_names():
    text = canonical_step(step_text(DATA, range(len(DATA))), HEADER)
    assert re.findall(r"OCCURRENCE\('(\d+)','(\w+)'", text) == [("1", "arm_2"), ("2", "arm_10")]


def test_canonical_step_tells_tied_roots_apart_by_what_they_hang_on(rng):
    # Two rings of items of one text: which colour goes with which product shows in no entity's own text.
    entities = []
    for k in range(6):
        entities += [
            f"POINT('',{k % 2}.)",
            f"A('',#{4 * k})",
            f"B('',#{4 * k})",
            f"C('',#{4 * k + 1},#{4 * ((k + 1) % 6) + 2})",
        ]
    wanted = canonical_step(step_text(entities, range(len(entities))), HEADER)
    for _ in range(60):
        assert canonical_step(step_text(entities, rng.permutation(len(entities)).tolist()), HEADER) == wanted


def test_canonical_step_has_a_header_without_time():
    text = canonical_step(step_text(DATA, range(len(DATA))), StepHeader(name="o'ne", description="größe", system="s"))
    assert "2026" not in text
    assert "FILE_NAME('o''ne'" in text
    assert r"gr\X2\00F6\X0\\X2\00DF\X0\e" in text


def test_canonical_step_refuses_a_circle():
    with pytest.raises(ReleaseError, match="circle"):
        canonical_step(step_text(["A('',#1)", "B('',#0)"], [0, 1]), HEADER)


def test_canonical_step_refuses_a_reference_into_nothing():
    text = step_text(["A('',#1)", "B('')"], [0, 1]).replace("#11 = B('');", "")
    with pytest.raises(ReleaseError, match="#11, which is not in the file"):
        canonical_step(text, HEADER)


def test_canonical_step_refuses_a_text_without_data():
    with pytest.raises(ReleaseError, match="DATA"):
        canonical_step("ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('A'));\nENDSEC;\n", HEADER)
