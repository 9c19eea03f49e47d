# Orbflow: `make` prints what there is. Everything sets itself up from Rust and Python alone.

PYTHON_VERSION ?= $(firstword $(foreach v,3.13 3.11,$(if $(shell scripts/find_python.sh $(v)),$(v))))
VENV = .venv-$(PYTHON_VERSION)
BIN = $(VENV)/bin
# On Linux the wheel is linked against an old C library, so that it runs wherever Blender runs.
WHEEL_FLAGS ?= $(if $(filter Linux,$(shell uname)),--zig --compatibility manylinux_2_28)
# The meshes that benchmarks, training and evaluation read, and the run whose weights ship.
DATA ?= ../shared/data
RUN = native/training/runs/2026-11-26
# What tests and lints build, one set for both: training too, on burn's engine flex.
FEATURES ?= orbflow-cli/train
# The engines besides flex that are tested: not cuda, whose build fetches a compiler.
ENGINES = orbflow-cli/ndarray,orbflow-cli/wgpu
SOURCES := $(shell find Cargo.toml Cargo.lock native/*/Cargo.toml native/*/src native/network/weights.orbflow native/python -type f 2>/dev/null)
GLTF_VALIDATOR := gltf-validator@2.0.0-dev.3.10
ADDON := $(shell find addon -type f ! -name "*.pyc")

.SECONDARY: # keep the stamps
.PHONY: help demo test test-rust test-drawn test-engines test-python test-window test-gltf window-pictures wheel zip fixtures pictures tutorial bench weights evaluation sets lint package format ci ci-more clean

help: ## Prints this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-14s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

demo: dist/zip.stamp $(VENV)/venv.stamp ## Remeshes a fixture in the real Blender and leaves the result in demo/
	$(BIN)/python scripts/demo.py demo

test: test-rust test-python ## Runs every test, with flex and one Blender

test-rust: export PROPTEST_RNG_SEED ?= 1
test-rust: ## Runs the tests of the Rust crates, the drawn ones with the same draws each time
	cargo test --workspace --features $(FEATURES) --locked --quiet

test-drawn: ## Runs the drawn tests of geometry with draws of their own, N times
	for i in $$(seq $(or $(N),1)); do cargo test -p orbflow-geometry --locked --quiet || exit; done

test-engines: ## Runs the tests of training on every engine; a driver in software stands in for a GPU
	scripts/install_libraries.sh vulkan
	cargo test -p orbflow-training -p orbflow-cli --features $(ENGINES) --locked --quiet

test-python: dist/zip.stamp $(VENV)/wheel.stamp ## Runs the tests over Blender, the wheel and the zip
	$(BIN)/python -m pytest

test-window: dist/zip.stamp ## Tries the extension in Blender's window, as before a release; pictures are in dist/window
	tests/window/run.sh dist/window $(CHECKS)

test-gltf: $(VENV)/venv.stamp ## Holds files that the program writes against Khronos's glTF validator (node and npm are needed)
	cargo build --release --locked -p orbflow-cli
	mkdir -p dist/gltf && cp tests/gltf/validate.mjs tests/gltf/check.py dist/gltf
	npm install --no-save --no-audit --no-fund --prefix dist/gltf $(GLTF_VALIDATOR)
	$(BIN)/python dist/gltf/check.py target/release/orbflow dist/gltf

window-pictures: dist/zip.stamp ## Makes the pictures of Blender's window in docs/pictures/ anew
	tests/window/run.sh dist/window install pictures
	cp dist/window/window_*.jpg docs/pictures

wheel: dist/wheel.stamp ## Builds the Python wheel in dist/
zip: dist/zip.stamp ## Builds this platform's Blender extension, dist/orbflow-*.zip

fixtures: .venv-3.11/venv.stamp ## Builds every .blend of blend_fixtures/ anew, so that Blender 4.5 reads them
	.venv-3.11/bin/python blend_fixtures/make.py

pictures: $(VENV)/bench.stamp $(VENV)/wheel.stamp ## Makes every picture of docs/pictures/ anew
	cargo build --release --locked -p orbflow-cli
	$(BIN)/python tests/pictures/make.py

tutorial: dist/zip.stamp $(VENV)/venv.stamp ## Does the steps of docs/tutorial.md and makes its picture
	$(BIN)/python tests/pictures/tutorial.py $(DATA) docs/pictures

bench: $(VENV)/bench.stamp ## Measures the figures of docs/benchmarks.md anew
	cargo build --release --locked -p orbflow-cli
	$(BIN)/python tests/benchmarks/measure.py --write

weights: sets ## Repeats the run whose weights are committed, in dist/run
	target/release/orbflow train dist/train.set --config $(RUN)/config.toml -o dist/run

evaluation: sets $(VENV)/venv.stamp ## Measures the figures of docs/evaluation.md anew
	rm -rf dist/meshes
	target/release/orbflow evaluate dist/train.set --other dist/dev.set \
		--baseline thesis --most 40 --finish --meshes dist/meshes --report dist/evaluation.json
	$(BIN)/python scripts/evaluation.py dist/evaluation.json docs/evaluation.md
	$(BIN)/python scripts/evaluation_grid.py dist/evaluation.json dist/meshes target/release/orbflow docs/pictures/evaluation.jpg
	target/release/orbflow curve $(RUN)

# A set that is whole stays as it is, one that was cut is gone on with: `make clean` before shapes change.
sets: $(VENV)/venv.stamp
	cargo build --release --locked -p orbflow-cli --features train
	mkdir -p dist
	$(BIN)/python scripts/bodies.py $(DATA)/makehuman dist/bodies --most 168
	target/release/orbflow prepare $(DATA)/quaternius dist/bodies -o dist/train.set --procedural 600
	target/release/orbflow prepare $(DATA)/dev -o dist/dev.set

lint: $(VENV)/lint.stamp ## Runs every check that is not a test
	cargo fmt --all --check
	cargo clippy --workspace --all-targets --features $(FEATURES) --locked --quiet -- -D warnings
	RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --features $(FEATURES) --locked --quiet
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/typos
	$(BIN)/pyright --pythonpath $(BIN)/python
	cd tests && ../$(BIN)/python -m mypy.stubtest orbflow_native
	$(BIN)/check-jsonschema --builtin-schema vendor.github-workflows .github/workflows/*.yml
	$(BIN)/zizmor --offline --quiet .github/workflows

package: ## Packs the crates as for crates.io, builds them from there and sends nothing
	cargo publish --dry-run --locked --workspace --exclude orbflow-python

format: $(VENV)/lint.stamp ## Formats all code
	cargo fmt --all
	$(BIN)/ruff check --fix --exit-zero .
	$(BIN)/ruff format .

# One build of each crate is all that runs here: nothing is kept for the next one, on disk or in pip's cache.
ci: export CARGO_INCREMENTAL = 0
ci: export PIP_NO_CACHE_DIR = 1
ci: ## Runs what must pass before anything lands: tests and lints
	$(MAKE) test PYTHON_VERSION=3.13
	$(MAKE) lint PYTHON_VERSION=3.13

ci-more: export CARGO_INCREMENTAL = 0
ci-more: export PIP_NO_CACHE_DIR = 1
ci-more: ## Runs what the workflow runs besides, as before a release: every engine, the oldest Blender, glTF files, the crates
	$(MAKE) test-drawn
	$(MAKE) test-engines
	$(MAKE) lint PYTHON_VERSION=3.13 FEATURES=$(ENGINES)
	$(MAKE) test-python PYTHON_VERSION=3.11
	$(MAKE) test-gltf PYTHON_VERSION=3.13
	$(MAKE) package

clean: ## Removes what was built, but not the virtual environments
	rm -rf dist demo target

.venv-%/venv.stamp: pyproject.toml
	@python="$$(scripts/find_python.sh $*)"; test -n "$$python" || \
		{ echo "Python 3.11 or 3.13 with venv and pip is needed"; exit 1; }; \
		scripts/install_libraries.sh && "$$python" -m venv .venv-$*
	.venv-$*/bin/python -m pip install --quiet pip==26.3
	.venv-$*/bin/python -m pip install --quiet --group test
	@touch $@

.venv-%/wheel.stamp: .venv-%/venv.stamp dist/wheel.stamp
	.venv-$*/bin/python -m pip install --quiet --force-reinstall --no-deps dist/wheels/*.whl
	@touch $@

.venv-%/lint.stamp: .venv-%/wheel.stamp
	.venv-$*/bin/python -m pip install --quiet --group lint
	@touch $@

.venv-%/bench.stamp: .venv-%/venv.stamp
	.venv-$*/bin/python -m pip install --quiet --group bench
	@touch $@

dist/wheel.stamp: $(SOURCES) | $(VENV)/venv.stamp
	rm -rf dist/wheels
	PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/maturin build --release --locked \
		--manifest-path native/python/Cargo.toml --out dist/wheels $(WHEEL_FLAGS)
	@touch $@

dist/zip.stamp: dist/wheel.stamp $(ADDON) LICENSE-GPL docs/blender.md scripts/build_zip.py scripts/manual.py | $(VENV)/venv.stamp
	$(BIN)/python scripts/build_zip.py dist/wheels dist
	@touch $@
