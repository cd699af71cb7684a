# Each target does its own set-up, once, in .venv. Needs Python 3.11+, Rust and make.
PYTHON ?= python3
BIN := .venv/bin
RUST_SOURCES := $(shell find rust/core rust/py -name '*.rs' -o -name Cargo.toml) Cargo.toml
COMPUTING := $(addprefix tests/,codec codegen diagnose spec typing)
SIMULATING := $(addprefix tests/,conformance docs faults peers plot sim testing)
# In a log, one after the other; a person sees both go on.
IN_TURN := $(and $(CI),$(filter output-sync,$(.FEATURES)),--output-sync=target)
FUZZ_SECONDS ?= 60
CARGO_FUZZ := .cargo-tools/bin/cargo-fuzz

.PHONY: help demo test lint python-test computing-tests simulating-tests waiting-tests rust-test gen targets docs bench plots table fuzz clean faults conform
.DEFAULT_GOAL := help

help: ## what the targets do
	@grep -E '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 14

demo: .venv/.native ## drive a simulated arm over a pty and check every answer
	$(BIN)/cobotwire demo --codec native

test: lint rust-test python-test ## everything that must hold: linters, generated files, Rust, Python

lint: .venv/.tools .venv/.native ## formatting, linters, types, stubs against the binary, generated files
	$(BIN)/cobotwire-gen --check
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/python -m mypy.stubtest cobotwire._native --mypy-config-file pyproject.toml
	cargo fmt --all --check
	cargo fmt --manifest-path rust/fuzz/Cargo.toml --check
	cargo clippy --workspace --all-targets --quiet -- -D warnings

rust-test: ## the Rust core's own tests
	cargo test --workspace --quiet

python-test: .venv/.tools .venv/.native ## the Python tests, on both codecs; those that wait for lines beside those that compute
	$(MAKE) --no-print-directory --jobs 3 $(IN_TURN) computing-tests simulating-tests waiting-tests

computing-tests:
	$(BIN)/python -m pytest $(COMPUTING)

simulating-tests:
	$(BIN)/python -m pytest $(SIMULATING)

waiting-tests:
	$(BIN)/python -m pytest $(addprefix --ignore=,$(COMPUTING) $(SIMULATING))

gen: .venv/.tools ## write the generated files from spec/
	$(BIN)/cobotwire-gen

targets: .venv/.tools .venv/.native ## what other people's tools make of every vector, target by target
	PYTHONPATH=tests $(BIN)/python tests/targets/report.py

docs: .venv/.tools .venv/.native ## the docs site, into docs/_build; a warning is an error
	$(BIN)/sphinx-build -q -W --keep-going -b html docs docs/_build
	@echo open docs/_build/index.html

bench: .venv/.tools .venv/.native ## how fast, beside the limits; what is lost on bad lines
	$(BIN)/python bench/generator.py
	$(BIN)/python bench/driver.py
	$(BIN)/python bench/simulated_time.py
	$(BIN)/python bench/kinematics.py
	$(BIN)/python bench/resync.py
	$(BIN)/python bench/lock.py
	$(BIN)/python bench/speed.py
	$(BIN)/python bench/imports.py
	$(BIN)/python bench/streaming.py
	$(BIN)/python bench/pipelining.py
	$(BIN)/python bench/pymycobot_session.py
	$(BIN)/python bench/stepped_client.py

plots: .venv/.tools .venv/.native ## measure and draw the curves of docs/ again; takes minutes
	$(BIN)/python -m pip install --quiet --group bench
	mkdir -p target
	$(BIN)/python bench/resync.py --frames 100000 --json target/resync.json
	$(BIN)/python bench/plot_resync.py target/resync.json docs/plots

fuzz: .venv/.tools .venv/.native $(CARGO_FUZZ) ## search for faults, FUZZ_SECONDS (60) a target; CONTRIBUTING.md says what then
	cargo clippy --manifest-path rust/fuzz/Cargo.toml --all-targets --quiet -- -D warnings
	@status=0; \
	$(BIN)/python rust/fuzz/run.py $(FUZZ_SECONDS) || status=1; \
	$(BIN)/python tests/deep.py $(FUZZ_SECONDS) || status=1; \
	exit $$status

table: .venv/.tools .venv/.native ## what we and pymycobot make of bad lines, into docs/bad-lines.md
	PYTHONPATH=tests $(BIN)/python bench/bad_lines.py

conform: .venv/.tools .venv/.native ## break subjects on purpose and count what the testers find, into docs/conformance-mutants.md
	$(BIN)/python bench/conform.py --page docs/conformance-mutants.md

faults: .venv/.tools .venv/.native ## what we and pymycobot make of the fault scenarios, into docs/fault-scenarios.md
	PYTHONPATH=tests $(BIN)/python bench/fault_scenarios.py

clean: ## forget the environment and what was built
	rm -rf .venv target .cargo-tools rust/fuzz/target docs/_build

.venv/.base: pyproject.toml
	$(PYTHON) -c 'import sys; sys.exit("cobotwire needs Python 3.11 or newer" if sys.version_info < (3, 11) else 0)'
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --upgrade pip 'maturin>=1.9,<2'
	touch $@

# A release build of the Rust codec, installed in place together with what the command line needs.
.venv/.native: .venv/.base $(RUST_SOURCES)
	. $(BIN)/activate && maturin develop --release --quiet --extras cli,sim
	touch $@

.venv/.tools: .venv/.base codegen/pyproject.toml
	$(BIN)/python -m pip install --quiet -e codegen --group test
	touch $@

# In the project, so that no other project's version is touched.
$(CARGO_FUZZ):
	cargo install --quiet --locked --root .cargo-tools --version 0.13.1 cargo-fuzz
