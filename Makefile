# make install | demo | live | test | test-cpus | test-pythons | test-gpu | bench-gpu | kernels | wheel | test-wheel | ptx | fuzz | check | messages | format | bench | peers | thresholds | references | populations | ruins | docs | lock | clean

PYTHON ?= $(shell command -v python3.11 || command -v python3 || echo python3)
BIN := .venv/bin
STAMP := .venv/.installed
DOCS_STAMP := .venv/.installed-docs
PEERS_STAMP := .venv-peers/.installed
PTX_STAMP := .venv-ptx/.installed
GPU_STAMP := .venv/.installed-gpu
# What stands beside the core in this repository, all of it installed with it.
BESIDE := $(patsubst %/pyproject.toml,%,$(wildcard packages/*/pyproject.toml)) studies compas
PIP := $(BIN)/python -m pip --disable-pip-version-check -qq
UV_VERSION := 0.13.8
LOCK := .venv-lock/bin/uv pip compile -q --universal --python-version 3.11 --generate-hashes \
        --no-emit-index-url --no-emit-find-links --custom-compile-command "make lock" $(UPGRADE)
OF_GPU := packages/stylobate-gpu/pyproject.toml
OWN := $(patsubst packages/%/pyproject.toml,--no-emit-package %,$(wildcard packages/*/pyproject.toml)) --no-emit-package stylobate
OF_PACKAGES := $(OWN) $(filter-out $(OF_GPU),$(wildcard packages/*/pyproject.toml))

# An environment that was copied or moved here would run the code at its old place: build it anew.
ifneq ($(shell cat $(STAMP) 2>/dev/null),$(CURDIR))
.PHONY: $(STAMP)
endif

# What is imported is compiled when it is first imported, and kept: a tenth of what is installed.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: install demo live test test-cpus test-pythons test-gpu bench-gpu ptx kernels wheel test-wheel fuzz check messages format bench peers thresholds references populations ruins docs lock clean

install: $(STAMP)
	@:

$(STAMP): pyproject.toml $(BESIDE:%=%/pyproject.toml) requirements/base.lock
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null || \
	    { echo "stylobate needs Python 3.11 or newer: name one with  make install PYTHON=/path/to/python3.11" >&2; exit 1; }
	@echo "Installing stylobate and its pinned requirements into .venv (about a minute)"
	@[ ! -e .venv ] || [ "$$(cat $@ 2>/dev/null)" = "$(CURDIR)" ] || rm -rf .venv
	@[ -x $(BIN)/python ] || $(PYTHON) -m venv .venv
	@$(PIP) install --no-compile --require-hashes -r requirements/base.lock
	@$(PIP) install --no-deps --no-build-isolation -e . $(BESIDE:%=-e %)
	@echo "$(CURDIR)" > $@

demo: install
	@$(BIN)/stylobate reproduce --quick --out demo

# A column to touch in a browser: one page that needs no server and no network.
live: install
	@$(BIN)/python -W ignore -m live build/live

test: install
	@$(BIN)/python -m pytest -n 2 --dist loadfile $(ARGS)

# The tests that are marked `processor`, on every processor that this one can play; ARGS="-k housner" for some of them.
test-cpus: install
	@$(BIN)/python .ci/processors.py $(ARGS)

# Demonstration and tests with every supported Python found here, and with the oldest requirements; ARGS="--only 3.13".
test-pythons: install
	@$(BIN)/python .ci/pythons.py $(ARGS)

$(GPU_STAMP): requirements/gpu.lock $(STAMP)
	@echo "Installing what reaches graphics cards into .venv"
	@$(PIP) install --require-hashes -r requirements/gpu.lock
	@touch $@

# The tests that need a graphics card, which the others go without.
test-gpu: $(GPU_STAMP)
	@$(BIN)/python -m pytest -n 0 -m gpu -rs $(ARGS)

# What a graphics card makes of many histories, in a quarter of an hour: figures in figures-gpu/; ARGS="plane space" for some.
bench-gpu: $(GPU_STAMP) ptx
	@$(BIN)/python benchmarks/card.py $(ARGS)

$(PTX_STAMP): requirements/ptx.lock
	@echo "Installing the compiler for graphics cards into .venv-ptx"
	@[ -x .venv-ptx/bin/python ] || $(PYTHON) -m venv .venv-ptx
	@.venv-ptx/bin/python -m pip --disable-pip-version-check -qq install --no-deps --require-hashes -r requirements/ptx.lock
	@touch $@

# The kernels for graphics cards, where they are not there from these sources; no card is needed. KERNELS="plane rim" for some.
ptx: $(PTX_STAMP)
	@PYTHONPATH=src:packages/stylobate-gpu/src .venv-ptx/bin/python -m stylobate_gpu.build $(KERNELS)

# Compiled kernels for processors, for this Python, where they are not there from these sources; LEVELS="x86-64-v3" for some.
kernels: install
	@$(BIN)/python .ci/kernels.py $(LEVELS)

# With the kernels that `make kernels` and `make ptx` have built; says how large it is.
wheel: install
	@rm -rf dist build/wheel
	@$(BIN)/python -m pip --disable-pip-version-check -qq wheel --no-deps --no-build-isolation -w dist . $(BESIDE:%=./%)
	@ls -sh dist/*.whl

# The wheel alone, in a bare environment.
test-wheel: wheel
	@$(BIN)/python .ci/wheel.py

# What strangers may hand in, by the thousand; ARGS="columns --seconds 60" for some of it.
fuzz: install
	@PYTHONPATH=tests:packages/stylobate-page/tests $(BIN)/python -m fuzz $(ARGS)

check: install
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/basedpyright
	$(BIN)/lint-imports --no-logo
	$(BIN)/python .ci/messages.py check

# The catalogues of reports from the messages in the sources: what is new waits for its translation, what is gone goes.
messages: install
	@$(BIN)/python .ci/messages.py

format: install
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

bench: install
	@$(BIN)/stylobate bench $(ARGS)

$(DOCS_STAMP): requirements/docs.lock $(STAMP)
	@echo "Installing what the documentation is built with into .venv"
	@$(PIP) install --require-hashes -r requirements/docs.lock
	@touch $@

$(PEERS_STAMP): requirements/peers.lock
	@echo "Installing other engines into .venv-peers"
	@[ -x .venv-peers/bin/python ] || $(PYTHON) -m venv .venv-peers
	@.venv-peers/bin/python -m pip --disable-pip-version-check -qq install --no-deps --require-hashes -r requirements/peers.lock
	@touch $@

# The same cases with MuJoCo, PyBullet and LMGC90; renews the table that the page on other codes is written from.
peers: install $(PEERS_STAMP)
	@$(BIN)/python peers/gather.py

# The thresholds of the tapered column that the page on other codes shows beside the published ones.
thresholds: install
	@PYTHONPATH=tests $(BIN)/python -m validation.tapered_column

# The reference rows of assemblies in space beside the project; FAMILIES="dominoes portal_pulse" for some of them.
references: install
	@PYTHONPATH=tests $(BIN)/python -m validation.in_space.study $(FAMILIES)

# Many scenes in space at once: turned and renumbered, tumbles, collapses; NAMES="tumbling" for some of them.
populations: install
	@PYTHONPATH=tests $(BIN)/python -m validation.in_space.populations $(NAMES)

ruins: install
	@PYTHONPATH=tests $(BIN)/python -m validation.ruins.figures demo/ruins

docs: live $(DOCS_STAMP)
	@echo "Running the examples and the validation cases, then writing the pages (two minutes)"
	@$(BIN)/python -m sphinx -q -W --keep-going -b html docs docs/_build/html
	@echo "The documentation is in"
	@echo "$(CURDIR)/docs/_build/html/index.html"

# Keeps the pinned versions that still fit; `make lock UPGRADE=--upgrade` takes the newest.
lock:
	@[ -x .venv-lock/bin/uv ] || $(PYTHON) -m venv .venv-lock
	@.venv-lock/bin/python -m pip --disable-pip-version-check -qq install uv==$(UV_VERSION)
	$(LOCK) --extra test --extra dev --extra seismology --extra video --extra parquet --extra cluster --extra exchange --extra spreadsheet --extra notebook \
	    $(OF_PACKAGES) requirements/build.in requirements/compas.in pyproject.toml -o requirements/base.lock > /dev/null
	$(LOCK) --extra docs -c requirements/base.lock pyproject.toml -o requirements/docs.lock > /dev/null
	.venv-lock/bin/uv pip compile -q --python-version 3.11 --resolution lowest-direct --generate-hashes \
	    --no-emit-index-url --no-emit-find-links --custom-compile-command "make lock" \
	    --extra test --extra seismology --extra video --extra parquet --extra cluster --extra exchange --extra spreadsheet --extra notebook \
	    $(OF_PACKAGES) requirements/build.in pyproject.toml -o requirements/oldest.lock > /dev/null
	$(LOCK) --no-deps requirements/peers.in -o requirements/peers.lock > /dev/null
	$(LOCK) -c requirements/base.lock $(OWN) $(OF_GPU) -o requirements/gpu.lock > /dev/null
	$(LOCK) --no-deps -c requirements/base.lock requirements/ptx.in -o requirements/ptx.lock > /dev/null
	@! grep -n -e '://' -e '^ *--\(extra-\)\?index' -e '--find-links' requirements/*.lock || \
	    { echo "a lock file names an index address: see the lines above" >&2; exit 1; }

clean:
	rm -rf .venv .venv-lock .venv-pythons .venv-peers .venv-ptx packages/stylobate-gpu/src/stylobate_gpu/built src/stylobate/kernels/built build dist gallery/*.png docs/_build docs/gallery docs/api/generated .pytest_cache .hypothesis .ruff_cache .import_linter_cache
	find src packages studies compas tests benchmarks gallery docs -name __pycache__ -type d -prune -exec rm -rf {} + 2>/dev/null || true
