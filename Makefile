# Two commands that set up what they need: `make example` runs the main job on the worked example, `make test` passes
# the tests. Both make a virtual environment in .venv.

PYTHON ?= python3
BIN := .venv/bin

.PHONY: example test lint benchmark blank docs texts samples clean

example: .venv/.installed
	$(BIN)/assess run inventories/market-street.xlsx --out out/market-street

test: .venv/.developing
	$(BIN)/python -m pytest -n auto

lint: .venv/.developing
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

benchmark: .venv/.developing
	$(BIN)/python tests/benchmarks/run.py

blank: .venv/.installed
	$(BIN)/assess new inventories/blank.xlsx --force
	$(BIN)/assess new inventories/blank-it.xlsx --language it --force
	$(BIN)/python inventories/market_street.py

docs: .venv/.installed
	$(BIN)/python docs/motions.py
	$(BIN)/python docs/rocking.py
	$(BIN)/python docs/validation.py

samples: .venv/.developing
	$(BIN)/python docs/samples.py

texts: .venv/.installed
	$(BIN)/python docs/texts.py

.venv/.installed: pyproject.toml setup.sh
	PYTHON="$(PYTHON)" sh setup.sh .
	touch $@

.venv/.developing: .venv/.installed
	PYTHON="$(PYTHON)" sh setup.sh '.[dev]'
	touch $@

clean:
	rm -rf .venv out build dist
