# Two commands: `make demo` and `make test`. Both set up all that they need, once, in .venv.

SHELL := /bin/bash
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/ready-$(shell cat constraints.txt pyproject.toml setup.py | sha256sum | cut -c1-16)

.PHONY: demo test test-slow check setup bench clean

demo: $(READY)
	$(BIN)/linkwright release hit -o build/hit

test: check
	$(BIN)/pytest -m "not slow"

test-slow: check
	$(BIN)/pytest

check: $(READY)
	$(BIN)/lint-imports
	$(BIN)/ruff check .
	$(BIN)/ruff format --check --quiet .
	$(BIN)/mypy

bench: $(READY)
	$(BIN)/python benchmarks/release.py

setup: $(READY)

$(READY):
	@bash .ci/system-libraries
	@python=$$(bash .ci/find-python) && echo "setting up $(VENV) with $$python (once, a few minutes)" && $$python -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --no-deps -r constraints.txt
	$(BIN)/python -m pip install --quiet --no-deps --editable .
	@touch $@

clean:
	rm -rf build $(VENV)
