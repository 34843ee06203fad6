# VoxSoft. `make demo` and `make test` set everything up by themselves.
#
# The environment lives in .venv; it is rebuilt only when Rust sources or dependencies change.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
# How many tests run side by side; each of them may use a second core for a moment.
JOBS ?= 2

# What `make bench` runs, some ten minutes; JSON goes to target/bench, beside the text.
BENCHMARKS := pipeline step_rate time_to_rest calibration study growth peers

# The oldest Rust that builds the core.
RUST := $(shell sed -n 's/^rust-version = "\([0-9.]*\)".*/\1/p' Cargo.toml)
RUST_SOURCES := $(shell find crates -name '*.rs' -o -name 'Cargo.toml')

# Tests start hundreds of Python processes, and each would compile the package anew where this is set, as in many
# images of containers.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: help install page demo test test-rust test-python test-studio test-long test-all lint format bench docs studio wasm clean

help:
	@echo "make demo         set up, run the paper's 105-design study, show table and figure"
	@echo "make test         set up, run all quick tests"
	@echo "make test-long    what make test leaves out: longer tests, and every way through the studio in Chromium"
	@echo "make test-all     also the slow tests (full calibrations, 10,000 random shapes, 512^3 grids)"
	@echo "make lint         formatters, linters, types, the stub of the core, layers"
	@echo "make bench        benchmarks"
	@echo "make docs         the documentation as web pages in target/docs"
	@echo "make studio       check, test and build the studio's page (needs Node 20.19 or newer; users need none)"
	@echo "make wasm         build the core for the browser, and the page with it (needs rustup target add wasm32-unknown-unknown)"
	@echo "make install      only the environment: .venv/bin/voxsoft"

install: $(STAMP) page

$(VENV)/bin/python:
	@command -v $(PYTHON) >/dev/null || { echo "VoxSoft needs Python 3.11 or newer, and there is no '$(PYTHON)'. Install it from https://www.python.org, or name it: make install PYTHON=python3.12" >&2; exit 1; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "VoxSoft needs Python 3.11 or newer, and '$(PYTHON)' is $$($(PYTHON) -V). Name a newer one: make install PYTHON=python3.12" >&2; exit 1; }
	@$(PYTHON) -c 'import venv, ensurepip' 2>/dev/null || { echo "'$(PYTHON)' cannot make virtual environments: its venv module is missing (Debian and Ubuntu: apt install python3-venv)." >&2; exit 1; }
	$(PYTHON) -m venv $(VENV)

$(STAMP): $(VENV)/bin/python pyproject.toml Cargo.toml Cargo.lock $(RUST_SOURCES)
	@command -v cargo >/dev/null || { echo "VoxSoft's core is written in Rust, and there is no 'cargo'. Install the Rust toolchain from https://rustup.rs" >&2; exit 1; }
	@have=$$(rustc --version | cut -d' ' -f2); [ "$$(printf '%s\n' $(RUST) $$have | sort -V | head -1)" = $(RUST) ] || { echo "VoxSoft needs Rust $(RUST) or newer, and 'rustc' is $$have. Update it with: rustup update stable (distributions' packages may be older; https://rustup.rs has the newest)" >&2; exit 1; }
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --upgrade "pip>=25.1" "maturin>=1.9,<2"
	VIRTUAL_ENV=$(abspath $(VENV)) $(BIN)/maturin develop --release
	@touch $@

# The studio's page is one archive in the repository; it is built anew only where its sources changed and Node is there.
page: | $(VENV)/bin/python
	@$(BIN)/python studio/archive.py check

demo: install
	$(BIN)/voxsoft sweep examples/cylinder.toml --out runs/demo --confirm 3

test: install test-rust test-python test-studio

test-rust:
	cargo test --workspace --exclude voxsoft-python --quiet

test-python: install
	$(BIN)/python -m pytest -n $(JOBS) --dist worksteal -m "not slow and not long and not browser"

# `make test` drives Chromium through the viewer and the exported page; these are all other ways,
# and the tests that take a second or more.
test-long: install
	$(BIN)/python -m pytest -n $(JOBS) --dist worksteal -m "(long or browser) and not slow"

# The page's own units; users need no Node, and neither does anyone who leaves the page alone.
test-studio: page
	@if ! command -v npm >/dev/null; then echo "The tests of the studio's page in TypeScript are skipped: there is no Node here."; \
	elif ! (cd studio && { [ node_modules/.package-lock.json -nt package-lock.json ] || npm ci --silent; }); then echo "The tests of the studio's page in TypeScript are skipped: npm could not fetch what they need."; \
	else cd studio && NO_COLOR=1 npm test --silent; fi

test-all: install
	cargo test --workspace --exclude voxsoft-python --quiet -- --include-ignored
	$(BIN)/python -m pytest -n $(JOBS) --dist worksteal

lint: install
	cargo fmt --check
	cargo clippy --workspace --all-targets --quiet -- -D warnings
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	MYPYPATH=python $(BIN)/python -P -m mypy.stubtest voxsoft._core --concise --ignore-disjoint-bases --allowlist crates/python/stubtest.allow
	$(BIN)/lint-imports

format:
	cargo fmt
	$(BIN)/ruff check --fix
	$(BIN)/ruff format

bench: install
	@for name in $(BENCHMARKS); do \
		$(BIN)/python benchmarks/$$name.py --save target/bench/$$name.json || exit 1; \
	done

docs: install
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --group docs
	$(BIN)/mkdocs build --strict

studio:
	$(PYTHON) studio/archive.py build
	cd studio && npm run check && npm test

wasm:
	cargo build --quiet --profile wasm --target wasm32-unknown-unknown -p voxsoft-wasm
	@mkdir -p studio/public
	cp target/wasm32-unknown-unknown/wasm/voxsoft_wasm.wasm studio/public/voxsoft.wasm
	@chmod 644 studio/public/voxsoft.wasm
	@echo "studio/public/voxsoft.wasm: $$(wc -c < studio/public/voxsoft.wasm) bytes, $$(gzip -9c studio/public/voxsoft.wasm | wc -c) compressed"
	$(PYTHON) studio/archive.py build

clean:
	rm -rf $(VENV) target runs dist
