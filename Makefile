# Every target does all the set-up that it needs; a second call finds it done.
#
#   make verify                     the main job: one report
#   make test                       the suite and the branch coverage of the trusted rooms
#   make long                       the tests marked `long`, which make test leaves out
#   make nightly                    every test, those marked `nightly` too, with new examples each time
#   make plain                      the main house's tests where no extra is installed
#   make coq                        the proofs in Coq: compiled, checked again, mutants refused
#   make mutants                    checkers and algorithms with one thing changed: each must be seen
#   make torture                    hostile input, programs and signals: minutes, seeded
#   make docs                       the site: pages, reference, gallery, links, examples
#   make lint types                 ruff; mypy and pyright, both strict
#   make bench                      the speeds of benchmarks/README.md
#
#   make test PYTHON=python3.12     another Python (give it another VENV, too, to keep both)
#   make test INSTALLER=uv          uv in the place of venv and pip

PYTHON ?= python3
VENV ?= .venv
INSTALLER ?= pip
JUNIT ?=
SEED ?= 0

BIN := $(VENV)/bin
PYTEST := $(BIN)/python -m pytest
report = $(if $(JUNIT),--junitxml="$(JUNIT)/$(1).xml")
# Few tests are long and many are short: a worker that is done takes over half of another's.
PARALLEL := --numprocesses=auto --dist=worksteal
TRACED := $(foreach room,world robot checkers algorithms,tests/$(room) topo_verify/$(room))
EVERY := -m 'nightly or not nightly'
# Python keeps what it compiles, whatever the environment says: the tests start hundreds of processes.
export PYTHONDONTWRITEBYTECODE :=

# The build backend is looked up on PATH, hence the environment's own programs come first there.
ifeq ($(INSTALLER),uv)
CREATE := uv venv --quiet --allow-existing --python "$(PYTHON)" $(VENV)
INSTALL := PATH="$(abspath $(BIN)):$$PATH" uv pip install --quiet --compile-bytecode --python $(BIN)/python
else
CREATE := "$(PYTHON)" -m venv $(VENV)
INSTALL := PATH="$(abspath $(BIN)):$$PATH" $(BIN)/python -m pip install --quiet --disable-pip-version-check
endif

.PHONY: help verify test long plain nightly coq docs lint types mypy pyright bench mutants torture constraints oldest clean

help:
	@sed -n 's/^# \{0,1\}//p' Makefile | head -n 16

verify: $(VENV)/.core
	$(BIN)/topo-verify verify

test: $(VENV)/.dev
	$(PYTEST) $(PARALLEL) -m 'traced and not (nightly or long)' --cov --cov-report= $(TRACED) $(call report,traced)
	$(PYTEST) $(PARALLEL) -m 'not (traced or coq or nightly or long)' $(call report,test)
	@echo "Branch coverage of the trusted rooms and the algorithms (must be 100 %):"
	$(BIN)/coverage report --fail-under=100

# Tests that need Coq run in make coq.
long: $(VENV)/.dev
	$(PYTEST) $(PARALLEL) -m 'long and not (nightly or coq)' tests $(call report,long)

# An environment of its own, beside the other. The tests of an extra skip themselves there.
plain:
	$(MAKE) VENV=$(VENV)-plain $(VENV)-plain/.test
	$(VENV)-plain/bin/python -m pytest $(PARALLEL) -m 'not (coq or nightly or long)' tests --ignore=tests/extra --ignore=tests/research $(call report,plain)

nightly: $(VENV)/.dev
	HYPOTHESIS_PROFILE=nightly $(PYTEST) $(PARALLEL) $(EVERY)

# Coq itself comes from the distribution: apt install coq
coq: $(VENV)/.dev
	$(PYTEST) $(PARALLEL) -m 'not rare' tests/proofs/mechanised tests/extra/certificates $(call report,coq)

# Into build/docs; a warning is an error. The examples in docstrings run; no network is used.
SPHINX := $(BIN)/python -m sphinx --quiet --nitpicky --fail-on-warning --keep-going -d build/doctrees docs
docs: $(VENV)/.dev
	$(SPHINX) build/docs -b html || { rm -rf build/doctrees; exit 1; }  # or the next build would hide the warning
	$(SPHINX) build/doctest -b doctest
	@echo "The site is in build/docs: open build/docs/index.html"

lint: $(VENV)/.dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: mypy pyright

mypy: $(VENV)/.dev
	$(BIN)/mypy

pyright: $(VENV)/.dev
	$(BIN)/pyright --pythonpath $(BIN)/python

bench: $(VENV)/.bench
	$(BIN)/python benchmarks/run.py

# Every change that the operators know, in every file of checkers/; some minutes.
mutants: $(VENV)/.dev
	$(BIN)/python benchmarks/mutants.py
	$(BIN)/python benchmarks/bridge.py

# Another seed, other trials: make torture SEED=7
torture: $(VENV)/.dev
	$(BIN)/python benchmarks/torture --seed $(SEED)

# --- set-up: an environment, then what is pinned, then this tree in editable form --------------

$(VENV)/.created:
	@command -v "$(PYTHON)" >/dev/null || { echo "No $(PYTHON) here: name a Python 3.11 or later, as in make test PYTHON=python3.12"; exit 1; }
	@"$(PYTHON)" -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "$(PYTHON) is older than Python 3.11: name a later one, as in make test PYTHON=python3.12"; exit 1; }
	@test "$(INSTALLER)" = uv || "$(PYTHON)" -c 'import ensurepip, venv' 2>/dev/null || { echo "$(PYTHON) lacks venv or ensurepip: sudo apt install python3-venv (Debian, Ubuntu), or have uv and call make with INSTALLER=uv"; exit 1; }
	$(CREATE)
	@touch $@

$(VENV)/.core: pyproject.toml constraints.txt $(VENV)/.created
	$(INSTALL) -c constraints.txt uv_build
	$(INSTALL) -c constraints.txt --no-build-isolation -e .
	@touch $@

$(VENV)/.test: $(VENV)/.core
	$(INSTALL) -c constraints.txt --no-build-isolation -e '.[docs,test]'
	@touch $@

# setuptools: drup has no wheel, and later Pythons bring no setuptools of their own.
$(VENV)/.dev: $(VENV)/.core
	$(INSTALL) -c constraints.txt setuptools
	$(INSTALL) -c constraints.txt --no-build-isolation -e '.[dev]'
	@touch $@

$(VENV)/.bench: $(VENV)/.core
	$(INSTALL) -c constraints.txt --no-build-isolation -e '.[bench]'
	@touch $@

# --- for maintainers ---------------------------------------------------------------------------

# One resolution for all supported Pythons, markers included. No header and no index: the file
# names neither the machine nor the registry that it was made with.
constraints: $(VENV)/.created
	$(INSTALL) uv
	$(BIN)/uv pip compile --quiet --universal --upgrade --python-version 3.11 --extra dev --extra bench \
	    --no-header --no-annotate --no-emit-index-url --no-emit-find-links pyproject.toml -o constraints.new
	{ echo "# The versions that the suite is run with, on every supported Python: make constraints"; cat constraints.new; } > constraints.txt
	rm constraints.new

# The lower bounds of pyproject.toml, tried out: the suite on the oldest direct dependencies.
oldest: $(VENV)/.created
	$(INSTALL) uv
	$(BIN)/uv venv --quiet --allow-existing --python $(BIN)/python .venv-oldest
	$(BIN)/uv pip install --quiet --compile-bytecode --python .venv-oldest/bin/python --upgrade --resolution lowest-direct -e '.[dev]'
	.venv-oldest/bin/python -m pytest -W default $(PARALLEL)

clean:
	rm -rf $(VENV) $(VENV)-plain .venv-oldest .pytest_cache .mypy_cache .ruff_cache .hypothesis .coverage torture-failures build dist
	find topo_verify tests benchmarks research -name __pycache__ -prune -exec rm -rf {} +
