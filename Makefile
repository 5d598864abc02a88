# Two commands for a newcomer: make demo, make test.
PYTHON ?= python3
BIN := .venv/bin
EXTRAS := --extra speech --extra echo --extra endpoint --extra serve --extra postgres --extra study --extra dask --extra ray
RECORDING := --audio examples/marker.wav --skeleton examples/marker.jsonl

.PHONY: demo test compiled lint coverage page check-all proofs shows docs numbers check-robot audit screenshots film bench picture requirements clean

demo: .venv/installed
	@$(BIN)/fetch-pomdp fetch ambiguous $(RECORDING)
	@if [ -t 0 ]; then printf '\nNow you: the robot is listening.\n'; $(BIN)/fetch-pomdp fetch ambiguous; \
	else echo 'On a terminal your turn comes now: .venv/bin/fetch-pomdp fetch ambiguous'; fi
	@echo 'In a browser: .venv/bin/fetch-pomdp serve'

# The linters take one core while the other compiles what both processes of the tests would compile.
test: .venv/tested
	$(MAKE) --no-print-directory -j 2 lint compiled
	$(BIN)/pytest -n 2 --dist worksteal

compiled: .venv/tested
	$(BIN)/python -m tests.compile

lint: .venv/tested
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy

# Compiled code leaves no trace in a coverage report, so the core is measured in a second run without compilation.
coverage: .venv/tested
	NUMBA_DISABLE_JIT=1 $(BIN)/pytest -n 2 --dist worksteal tests/core -m 'not slow' --cov=src/fetch_pomdp/core --cov-report=term --cov-fail-under=95

# The page's JavaScript: types, lint, and its own tests (node 20 and npm); nothing of this is needed to use or change the rest.
page: node_modules/.installed
	npm run --silent types
	npm run --silent lint
	npm run --silent test

node_modules/.installed: package.json
	npm install --no-package-lock --no-audit --no-fund --loglevel=error
	@touch $@

# What takes long or needs more of the machine: the core once more in plain Python, proofs by many samples, and the page in
# Debian's Chromium, a PostgreSQL, fifty people at once (apt install chromium postgresql espeak-ng flite sox).
check-all: test coverage proofs shows

proofs: .venv/tested
	$(BIN)/pytest -n 2 --dist worksteal -m long tests

shows: .venv/tested
	tests/with_postgres.sh $(BIN)/pytest -m 'browser or postgres or load' tests

# The documentation as a site in build/site, without a warning; then the tutorial's notebook, cell by cell.
docs: .venv-docs/installed
	NO_MKDOCS_2_WARNING=1 .venv-docs/bin/mkdocs build --quiet --strict
	.venv-docs/bin/python docs/check_links.py build/site
	.venv-docs/bin/python docs/make_notebook.py --run

.venv-docs/installed: pyproject.toml requirements/docs.txt
	@$(PYTHON) -m venv .venv-docs
	@.venv-docs/bin/pip install -q --disable-pip-version-check -r requirements/docs.txt
	@.venv-docs/bin/pip install -q --disable-pip-version-check --no-deps -e .
	@touch $@

# Every table of numbers in README.md and docs/ that a command of the package makes, half an hour on two cores;
# tests/test_numbers.py checks the cheap ones.
numbers: .venv/tested
	$(BIN)/python docs/make_numbers.py
	$(BIN)/python docs/make_reproduction.py

# The robot in MuJoCo (docs/robot.md), in an environment of its own. Of robosuite (157 MB) only Baxter's model is wanted, so what it
# would bring along is left out.
ROBOT := .venv-robot/bin
check-robot: .venv-robot/installed
	$(ROBOT)/pytest -n 2 --dist worksteal tests/adapters/robot
	$(ROBOT)/python benchmarks/robot.py --robot baxter --tables 4 --stops 4
	$(ROBOT)/python benchmarks/robot.py --robot ur5e --tables 4 --stops 4

.venv-robot/installed: pyproject.toml requirements/robot.txt
	@$(PYTHON) -m venv .venv-robot
	@$(ROBOT)/pip install -q --disable-pip-version-check -r requirements/robot.txt
	@$(ROBOT)/pip install -q --disable-pip-version-check --no-deps robosuite==1.5.2 -e .
	@touch $@

# Known holes in what is installed, asked of PyPI; not a part of the tests, for those need no network.
audit:
	@test -x .venv-audit/bin/pip-audit || ($(PYTHON) -m venv .venv-audit && .venv-audit/bin/pip install -q --disable-pip-version-check pip-audit)
	.venv-audit/bin/pip-audit --strict --progress-spinner off --disable-pip --no-deps -r requirements/bench.txt

screenshots: .venv/tested
	$(BIN)/python docs/make_screenshots.py
	$(BIN)/python -m tests.e2e.film.measure docs/serve-arm.png

film: .venv/tested
	$(BIN)/python docs/make_film.py

bench: .venv/tested
	$(BIN)/pip install -q -r requirements/bench.txt
	$(BIN)/python benchmarks/planners.py
	$(BIN)/python benchmarks/scenes.py --named
	$(BIN)/python benchmarks/speech.py

picture: .venv/installed
	$(BIN)/python docs/make_picture.py

.venv/installed: pyproject.toml requirements/run.txt
	@$(PYTHON) -c 'import sys; sys.exit("Python 3.11 or newer is needed") if sys.version_info < (3, 11) else None'
	@echo 'Installing into .venv, a minute or two ...'
	@$(PYTHON) -m venv .venv
	@$(BIN)/pip install -q --disable-pip-version-check -r requirements/run.txt
	@$(BIN)/pip install -q --disable-pip-version-check --no-deps -e .
	@touch $@

.venv/tested: .venv/installed requirements/test.txt
	@$(BIN)/pip install -q --disable-pip-version-check -r requirements/test.txt
	@touch $@

# Pins without registry addresses, the same in all files; needs uv.
PIN = uv pip compile pyproject.toml --universal --generate-hashes --no-strip-extras --no-header --no-annotate -q
requirements:
	$(PIN) $(EXTRAS) --group dev --group browser --group bench -o requirements/bench.txt
	$(PIN) $(EXTRAS) --group dev --group browser -c requirements/bench.txt -o requirements/test.txt
	$(PIN) --extra speech --extra serve -c requirements/bench.txt -o requirements/run.txt
	$(PIN) -c requirements/bench.txt -o requirements/core.txt
	$(PIN) --extra serve --extra study --group docs -c requirements/bench.txt -o requirements/docs.txt
	$(PIN) --extra robot --group robot -c requirements/bench.txt -o requirements/robot.txt

clean:
	rm -rf .venv .venv-audit .venv-docs .venv-robot build node_modules .numba-cache .coverage .pytest_cache .mypy_cache .ruff_cache .hypothesis
