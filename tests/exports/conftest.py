"""A small design of two masts, its solids and its home pose; built once for all tests of this folder."""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from linkwright.generator.assembly import build_assembly

HERE = Path(__file__).parent


def load_masts():
    """The module beside this file: dataclasses want it among the loaded modules."""
    name = "linkwright_test_masts"
    if name not in sys.modules:
        spec = importlib.util.spec_from_file_location(name, HERE / "masts.py")
        sys.modules[name] = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(sys.modules[name])
    return sys.modules[name]


@pytest.fixture(scope="session")
def masts():
    return load_masts()


@pytest.fixture(scope="session")
def design(masts):
    return masts.masts_design()


@pytest.fixture(scope="session")
def assembly(design):
    return build_assembly(design)


@pytest.fixture(scope="session")
def home(design):
    return design.mechanism.place_bodies(np.asarray(design.mechanism.home)[None])[0]


@pytest.fixture
def in_fresh_process():
    """Runs a script with the masts at hand; another hash seed and environment size each time; returns its output."""

    def run(script: str, seed: int) -> str:
        # Another size of the environment shifts the stack: addresses differ even where they are not randomised.
        environment = os.environ | {"PYTHONHASHSEED": str(seed), "PADDING": "x" * (97 * seed)}
        start = f"import sys; sys.path.insert(0, {str(HERE)!r}); import masts\n"
        done = subprocess.run(
            [sys.executable, "-c", start + script], env=environment, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run
