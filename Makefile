# Each target sets itself up once, in .venv. Needs Python 3.11+, Rust and make.
# pip compiles nothing (--no-compile): Python compiles what is imported, which is much less.
PYTHON ?= python3
BIN := .venv/bin
RUST_SOURCES := $(shell find rust/core rust/py rust/simd -name '*.rs' -o -name Cargo.toml) Cargo.toml
# A stamp of the last `cobotwire-gen --rust-data`. It writes the editions of the Rust client, which git ignores.
RUST_DATA := .venv/.rust-data
# Exclude the Python module: it has no Rust tests, and shared dependencies would be compiled again with its features.
TESTED := --workspace --exclude cobotwire-native
# The Python tests run in five lanes at once, which should end together. The first only computes. It
# lets the others go first (nice), because they also have tests that wait for a reply until a
# deadline. The last lane has all tests that no other lane names.
COMPUTING := $(addprefix tests/,codec codegen peers protocol spec targets)
SIMULATING := $(addprefix tests/,conformance defects inspect simulator)
CALLING := $(addprefix tests/,cli docs newcomer)
WAITING := $(addprefix tests/,attack client session transport diagnose mutation)
NAMED := $(COMPUTING) $(SIMULATING) $(CALLING) $(WAITING)
LANES := computing-tests simulating-tests calling-tests waiting-tests other-tests
# In CI, print the output of each lane when it ends; elsewhere, print all output as it comes.
IN_TURN := $(and $(CI),$(filter output-sync,$(.FEATURES)),--output-sync=target)
# Tests start many programs. Without compiled files, each of them compiles the package anew.
unexport PYTHONDONTWRITEBYTECODE
FUZZ_SECONDS ?= 60
ATTACK_SECONDS ?= 180
STATES ?= 1000000
REV ?= HEAD
LEROBOT ?= lerobot==0.4.4
WASM := wasm32-unknown-unknown
CHECK_WASM := RUSTFLAGS=-Dwarnings cargo check --release --package cobotwire-core --target $(WASM) --quiet
CARGO_FUZZ := .cargo-tools/bin/cargo-fuzz

.PHONY: set-up spec-mutants help demo test lint lint-and-rust python-test computing-tests simulating-tests calling-tests waiting-tests other-tests rust-test products gen targets docs bench plots smoothness picture answers table fuzz figures clean faults conform defects attack archives lerobot bench-archive bench-compare rust-asan layer front-end front-end-if-reachable four-hours studio-pictures explore nightly rust-package npm-package release-check figures-page every-edition urdf
.DEFAULT_GOAL := help

help: ## list the targets
	@grep -E '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 14

demo: .venv/.native ## drive a simulated arm over a pty and check every reply
	$(BIN)/cobotwire demo --codec native

test: set-up front-end-if-reachable ## run everything: linters, types, generated files, Rust, Python
	$(MAKE) --no-print-directory --jobs 6 $(IN_TURN) $(LANES) lint-and-rust

# Compile while pip fetches the tools. Only one pip at a time may install.
set-up: .venv/.base ## make .venv with the tools and the compiled package, for all other targets
	+$(MAKE) --no-print-directory --jobs 2 .venv/.tools .venv/.compiled
	+$(MAKE) --no-print-directory .venv/.native spec/schema.json $(RUST_DATA)

lint: .venv/.tools .venv/.native ## check formatting, types, stubs against the binary, generated files
	$(BIN)/cobotwire-gen --check
	$(BIN)/python tools/unasync.py --check
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/codespell
	$(BIN)/mypy
	$(BIN)/python -m mypy.stubtest cobotwire._native cobotwire.pymycobot.layer.classes --mypy-config-file pyproject.toml
	cargo fmt --all --check
	cargo fmt --manifest-path rust/fuzz/Cargo.toml --check
# One run for all crates, so that their dependencies are checked once.
	+cargo clippy --release --workspace --lib --bins --tests --quiet -- -D warnings
	+if [ -d "$$(rustc --print target-libdir --target $(WASM))" ]; then $(CHECK_WASM) && $(CHECK_WASM) --no-default-features --features exchange; \
		else echo "skipped: the check of the core for $(WASM), which is not installed" >&2; fi

# The Python tests wait a third of the time; the linters and the Rust tests use that processor
# time. The linters run first, since they find most problems in seconds.
lint-and-rust: lint
	+nice -n 5 $(MAKE) --no-print-directory rust-test

rust-package: .venv/.tools .venv/.native ## package the Rust crates; use them in a clean folder; run the tests of the client
	$(BIN)/cobotwire-gen --rust-data
	PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/python tools/rust_package.py

npm-package: .venv/.tools .venv/.native ## build the npm package; use it in a clean folder; compare a call with a bare round trip
	PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/python tools/npm_package.py
	node clients/typescript/examples/round_trip.mjs

rust-test: $(RUST_DATA) ## run the Rust tests
	+cargo test $(TESTED) --quiet

ASAN := target/asan
ASAN_TESTS := $(addprefix tests/codec/test_,native_frames.py agreement.py reused_columns.py segments.py shared_reader.py buffer_protocol.py workers.py) tests/transport/test_every_transport.py

rust-asan: .venv/.tools ## run the tests of the unsafe code with AddressSanitizer; needs a nightly toolchain and clang
	RUSTFLAGS=-Zsanitizer=address cargo +nightly test --package cobotwire-simd --quiet \
		--target $$(rustc -vV | sed -n 's/host: //p') --target-dir $(ASAN)
	RUSTFLAGS=-Zsanitizer=address PYO3_PYTHON=$(CURDIR)/$(BIN)/python cargo +nightly build --package cobotwire-native \
		--quiet --target $$(rustc -vV | sed -n 's/host: //p') --target-dir $(ASAN)
	rm -rf $(ASAN)/package && mkdir $(ASAN)/package && cp -rL python/cobotwire $(ASAN)/package
	cp $(ASAN)/*/debug/lib_native.so $(ASAN)/package/cobotwire/_native.abi3.so
	PYTHONPATH=$(ASAN)/package:tests:tests/peers PYTHONMALLOC=malloc ASAN_OPTIONS=detect_leaks=0 \
		LD_PRELOAD=$$(clang -print-file-name=libclang_rt.asan-$$(uname -m).so) \
		$(BIN)/python -m pytest -q --capture=no $(ASAN_TESTS)

python-test: set-up front-end-if-reachable ## run the Python tests on both codecs, in five lanes
	$(MAKE) --no-print-directory --jobs 5 $(IN_TURN) $(LANES)

computing-tests:
	nice -n 5 $(BIN)/python -m pytest $(COMPUTING)

simulating-tests:
	$(BIN)/python -m pytest $(SIMULATING)

calling-tests:
	$(BIN)/python -m pytest $(CALLING)

waiting-tests:
	$(BIN)/python -m pytest $(WAITING)

other-tests:
	$(BIN)/python -m pytest $(addprefix --ignore=,$(NAMED))

front-end: ## fetch the JavaScript that the page of `cobotwire studio` and its test need
	$(PYTHON) tools/front_end.py

# Where only PyPI and crates.io can be reached, the tests that need the JavaScript are skipped.
front-end-if-reachable:
	$(PYTHON) tools/front_end.py || echo "the tests of the studio will be skipped" >&2

four-hours: .venv/.tools .venv/.native front-end ## show four hours of a 50 Hz line in the studio; memory must stay the same
	PYTHONPATH=python:tests $(BIN)/python -m studio.four_hours $(HOURS)

studio-pictures: .venv/.tools .venv/.native front-end ## take the pictures of docs/studio.md
	PYTHONPATH=python:tests $(BIN)/python -m studio.pictures docs/plots

gen: .venv/.tools ## write the committed generated files from spec/, and the schema for editors
	$(BIN)/cobotwire-gen

products: .venv/.tools ## also write the build products: pages of the site, output targets, data of the Rust tests
	$(BIN)/cobotwire-gen --products

targets: products .venv/.native ## build each output target and run it in its real tool
	PYTHONPATH=tests $(BIN)/python tests/targets/report.py

spec-mutants: .venv/.tools .venv/.native ## change each fact of the spec, one at a time; report the changes that no check notices
	SPEC_MUTANTS=1 $(BIN)/python -m pytest -q -rP tests/spec/test_mutants.py -k every_wrong_fact

docs: .venv/.tools .venv/.native front-end-if-reachable ## build the docs site into docs/_build; a warning is an error
	PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/python tools/npm_package.py --build || echo "decoder.html will not decode, live/ will be missing" >&2
	$(BIN)/sphinx-build -q -W --keep-going -b html docs docs/_build
	@echo open docs/_build/index.html

bench: .venv/.tools .venv/.native ## compare speeds with their limits; count losses on bad lines
	$(BIN)/python bench/generator.py
	$(BIN)/python bench/client.py
	$(BIN)/python bench/asyncio_calls.py
	$(BIN)/python bench/simulated_time.py
	$(BIN)/python bench/resync.py
	$(BIN)/python bench/captures_decode.py
	$(BIN)/python bench/speed.py
	$(BIN)/python bench/captures.py
	$(BIN)/python bench/imports.py
	$(BIN)/python bench/jitter.py
	$(BIN)/python bench/fleet.py
	$(BIN)/python bench/pipelining.py
	$(BIN)/python bench/waiting.py
	$(BIN)/python bench/tap.py

bench-archive: .venv/.tools .venv/.native ## compare one and two workers on a raw file of 2 GB; takes minutes
	$(BIN)/python bench/archive_workers.py

bench-compare: .venv/.tools .venv/.native ## compare the speed of the working tree with REV (HEAD): make bench-compare REV=main
	$(BIN)/python bench/compare.py $(REV) $(COMPARE)

plots: .venv/.tools .venv/.native ## measure and draw the curves of docs/; takes minutes
	$(BIN)/python -m pip install --quiet --group bench
	mkdir -p target
	$(BIN)/python bench/resync.py --frames 100000 --json target/resync.json
	$(BIN)/python bench/plot_resync.py target/resync.json docs/plots

smoothness: .venv/.tools .venv/.native ## compare the speeds of joints along a path; draw the plot of docs/motion.md
	$(BIN)/python bench/smoothness.py --plot docs/plots/smoothness.svg

picture: .venv/.tools .venv/.native ## record the picture of the README: a simulated arm, a program, monitor
	PYTHONPATH=tests $(BIN)/python tools/record_picture.py docs/pictures

answers: .venv/.tools .venv/.native ## record the example capture of docs/answers.md, export it, draw its pictures
	rm -rf target/answers && mkdir -p target/answers
	$(BIN)/python docs/answers/record_three_days.py target/answers/arm7.pcapng
	$(BIN)/cobotwire export target/answers/arm7.pcapng -o target/answers/archive --wide || test $$? = 1
	$(BIN)/python docs/answers/draw.py target/answers/archive docs/plots

fuzz: products .venv/.native $(CARGO_FUZZ) ## fuzz each target for FUZZ_SECONDS (60); see docs/contribute/searches.md
	cargo clippy --manifest-path rust/fuzz/Cargo.toml --all-targets --quiet -- -D warnings
	@status=0; \
	$(BIN)/python rust/fuzz/run.py $(FUZZ_SECONDS) || status=1; \
	$(BIN)/python tests/deep.py $(FUZZ_SECONDS) || status=1; \
	exit $$status

table: .venv/.tools .venv/.native ## compare our clients with pymycobot on bad lines; write docs/bad-lines.md
	PYTHONPATH=tests $(BIN)/python bench/bad_lines.py

conform: .venv/.tools .venv/.native ## break subjects of EDITIONS (all) on purpose; count what the conformance tests find; FULL=1: all mutants
	MUTANTS=$(if $(FULL),all,3) EDITIONS='$(EDITIONS)' $(BIN)/python -m pytest -q -rP tests/mutation -k 'of_a_suite or correct_subject'
	POSES=500 $(BIN)/python -m pytest -q tests/conformance/device/test_start_poses.py -k any_pose

defects: .venv/.tools .venv/.native ## test independent subjects with planted defects
	EVERY_DEFECT=1 $(BIN)/python -m pytest -q -rP tests/defects $(DEFECTS)

attack: .venv/.tools .venv/.native ## attack the clients for ATTACK_SECONDS (180) with a hostile peer; CLIENT=rust or CLIENT=node: those in Rust or Node
	PYTHONPATH=tests $(BIN)/python -m attack --seconds $(ATTACK_SECONDS) $(if $(CLIENT),--client $(CLIENT)) $(ATTACK)

explore: .venv/.tools .venv/.native ## explore every order of events of an exchange until STATES (1000000) were seen; RUST=1: in Rust too
	PYTHONPATH=python:tests $(BIN)/python -m session.exploring $(STATES) $(if $(RUST),rust)

nightly: .venv/.tools .venv/.native ## run the long searches one after another, and print one table: make nightly SEARCHES="fuzz attack"
	$(BIN)/python tools/nightly.py $(SEARCHES)

every-edition: set-up ## test all editions where `make test` tests a sample
	EVERY_EDITION=1 $(BIN)/python -m pytest tests/docs/test_site.py tests/docs/test_robot_pages.py \
		$(shell grep -rlE 'sampled(_pairs)?\(|EVERY_EDITION' tests --include='test_*.py')

urdf: .venv/.tools .venv/.native ## compare the poses of our URDF files with yourdfpy
	$(BIN)/python -m pip install --quiet --no-compile --group urdf
	$(BIN)/python -m pytest tests/kinematics/test_urdf.py

archives: .venv/.tools .venv/.native ## export and query archives on a Dask cluster and an S3 server
	$(BIN)/python -m pytest tests/capture/archive -o python_files='test_*.py on_*.py'

# LeRobot gets an environment of its own, because it requires torch: about 8 GB.
lerobot: .venv/.tools .venv/.native ## record and replay an episode with the real LeRobot: make lerobot LEROBOT='lerobot[core-scripts]==0.6.1' PYTHON=python3.12
	$(PYTHON) -m venv target/lerobot
	target/lerobot/bin/python -m pip install --quiet --no-compile '$(LEROBOT)' . ./adapters/lerobot
	LEROBOT=target/lerobot $(BIN)/python -m pytest -o python_files='on_*.py' tests/adapters

.PHONY: wheels-check
wheels-check: .venv/.base ## build the distributions; run README, website and three other protocols from the wheels in fresh environments: PYTHONS="python3.11 ..."
	$(BIN)/python -m pip install --quiet --group release
	PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/python tools/wheels_check.py $(PYTHONS)

release-check: .venv/.tools .venv/.native ## compare API, editions, spec language and recordings with the last release, or with the revision SINCE
	$(BIN)/python tools/promises.py $(SINCE)

layer: .venv/.tools .venv/.native ## call each method of the maker's classes and of ours; compare them
	PYTHONPATH=python:codegen/src:tests:tests/peers $(BIN)/python -W ignore -m layer_main

faults: .venv/.tools .venv/.native ## run our client and pymycobot on each fault; write docs/fault-scenarios.md
	PYTHONPATH=tests $(BIN)/python bench/fault_scenarios.py

figures-page: .venv/.tools .venv/.native ## write docs/figures.md: all blocks (minutes), or make figures-page FIGURES="compared calls"
	$(BIN)/python bench/figures.py $(FIGURES)

figures: .venv/.tools .venv/.native ## count files and lines of each folder, and the files that a call uses
	$(BIN)/python tests/house_figures.py

clean: ## remove the environment and all build products
	git clean -dfqX docs spec
	rm -rf .venv target targets rust/client/src/editions .cargo-tools rust/fuzz/target
	cd clients/typescript && rm -rf dist editions node_modules

.venv/.base: pyproject.toml
	$(PYTHON) -c 'import sys; sys.exit("cobotwire needs Python 3.11 or newer" if sys.version_info < (3, 11) else 0)'
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --no-compile --upgrade pip 'maturin>=1.9,<2'
	touch $@

# Build the Rust codec in release mode; install it in place, with the extras of the command line.
.venv/.native: .venv/.base $(RUST_SOURCES)
	. $(BIN)/activate && maturin develop --release --quiet --extras sim
	touch $@

# Compile early, so that the recipe of .venv/.native only installs.
.venv/.compiled: .venv/.base $(RUST_SOURCES)
	. $(BIN)/activate && maturin build --release --quiet --out target/wheels
	touch $@

.venv/.tools: .venv/.base codegen/pyproject.toml Cargo.toml
	$(BIN)/python -m pip install --quiet --no-compile -e codegen --group test
	touch $@

$(RUST_DATA): .venv/.tools $(shell find spec codegen/src -type f -not -name '*.pyc')
	$(BIN)/cobotwire-gen --rust-data
	touch $@

# Editors use the schema; `make gen` keeps it up to date.
spec/schema.json: .venv/.tools .venv/.native
	$(BIN)/cobotwire-gen schema
	touch $@

# Install cargo-fuzz in the project, so that other projects keep their version.
$(CARGO_FUZZ):
	cargo install --quiet --locked --root .cargo-tools --version 0.13.1 cargo-fuzz
