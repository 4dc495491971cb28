"""The command line on the two-bar arm, as if the catalogue held it."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from linkwright.app.cli import cli
from linkwright.designs import catalogue

_SOURCE = Path(__file__).parents[1] / "designs" / "conftest.py"


def _two_bar_arm():
    name = "two_bar_arm"
    if name not in sys.modules:
        spec = importlib.util.spec_from_file_location(name, _SOURCE)
        sys.modules[name] = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(sys.modules[name])
    return sys.modules[name].arm_entry()


@pytest.fixture
def linkwright(monkeypatch, tmp_path):
    """Run the command line in an empty folder; the catalogue holds the arm too."""
    entry = _two_bar_arm()
    monkeypatch.setitem(catalogue._ENTRIES, entry.name, entry)
    monkeypatch.chdir(tmp_path)
    # Errors are styled for terminals; here their words matter.
    return lambda *words, text=None: CliRunner().invoke(cli, list(words), input=text)
