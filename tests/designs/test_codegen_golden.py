"""The printed text of every mechanism is the one on record: a change of it is seen in review, and said on purpose."""

from __future__ import annotations

import hashlib
import json
import os
import re
from pathlib import Path

import pytest

from linkwright.designs import catalogue
from linkwright.designs.codegen.emit_c99 import emit_c99
from linkwright.designs.codegen.emit_js import emit_js
from linkwright.designs.codegen.trace import trace_mechanism

RECORD = Path(__file__).parents[1] / "golden" / "codegen.json"
RENEW = "LINKWRIGHT_RENEW_GOLDEN"
HOW = f"if the change is meant, run {RENEW}=1 pytest {Path(__file__).name} and commit {RECORD.name} with its reason"

#: Last digits of constants are the mathematical library's, so numbers count to nine digits.
NUMBER = re.compile(r"(?<![\w.])\d+\.\d+(?:e[+-]?\d+)?")


def fingerprint(text: str) -> str:
    rounded = NUMBER.sub(lambda found: f"{float(found[0]):.9g}", text)
    return f"{rounded.count(chr(10))} lines {hashlib.sha256(rounded.encode()).hexdigest()[:16]}"


def printed(name: str) -> dict[str, str]:
    program = trace_mechanism(catalogue.entry(name).default_design().mechanism)
    return {"c99": fingerprint(emit_c99(program)), "js": fingerprint(emit_js(program))}


def test_the_printed_text_of_every_mechanism_is_the_one_on_record():
    now = {name: printed(name) for name in catalogue.names()}
    if os.environ.get(RENEW):
        RECORD.write_text(json.dumps(now, indent=2) + "\n")
        pytest.skip(f"{RECORD.name} renewed")
    kept = json.loads(RECORD.read_text())
    changed = [name for name in sorted({*now, *kept}) if now.get(name) != kept.get(name)]
    assert not changed, f"printed C or JavaScript of {', '.join(changed)} is not the one on record; {HOW}"


def test_a_changed_number_or_operation_changes_the_fingerprint_and_a_last_digit_does_not():
    text = "const double v1 = x0 + 0.1234567890123456;"
    assert fingerprint(text) == fingerprint(text.replace("456;", "459;"))
    assert fingerprint(text) != fingerprint(text.replace("0.1234", "0.1235"))
    assert fingerprint(text) != fingerprint(text.replace("+", "-"))
