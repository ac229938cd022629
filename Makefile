# Needs Python 3.11+ with venv, a Rust toolchain and make. Everything else goes into .venv.

PYTHON ?= python3
BIN := .venv/bin
CHROMIUM ?= $(shell command -v chromium || command -v chromium-browser || command -v google-chrome)
WASM := wasm32-unknown-unknown
RUST := $(shell find crates/*/src crates/*/Cargo.toml) Cargo.toml Cargo.lock
# maturin, and what it starts, are found in the environment.
export PATH := $(CURDIR)/$(BIN):$(PATH)

.PHONY: help study test bench bench-brains bench-peers bench-store verify-selection fuzz golden schemas \
	picture page-pictures bench-page examples replication validation minds web lint wasm rust-test python-test page-test clean

help: ## Say what can be made
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "%-17s %s\n", $$1, $$2 }' Makefile

study: .venv/installed ## Answer the 2003 experiment's question: how many robots?
	$(BIN)/agent-economy study scenarios/classic.toml

test: lint wasm rust-test python-test page-test ## Run every check, as CI does

lint: .venv/installed ## Formatters, linters, types, stubs, layers
	cargo fmt --all --check
	cargo clippy --workspace --all-targets --locked -- -D warnings
	$(BIN)/ruff format --check python scripts packaging examples benchmarks/peers
	$(BIN)/ruff check python scripts packaging examples benchmarks/peers
	$(BIN)/mypy
	$(BIN)/stubtest agent_economy._core
	$(BIN)/lint-imports --no-cache
	$(BIN)/python scripts/check_tree.py

# A toolchain without rustup may lack it: then nothing here can be proven, and that is said.
wasm: ## The metric simulator and the brain compile for browsers
	@if [ -d "$$(rustc --print target-libdir --target $(WASM))" ] || rustup target add $(WASM); then \
		cargo check --locked --target $(WASM) \
			-p agent-economy-base -p agent-economy-brain -p agent-economy-sim; \
	else \
		echo "SKIPPED: not checked that the simulator compiles for $(WASM);" \
			"to have it: rustup target add $(WASM)"; \
	fi

rust-test:
	cargo test --locked

# Tests of one file stay together: some share what they have computed.
python-test: .venv/installed
	$(BIN)/pytest --numprocesses 2 --dist loadfile

# What is missing is said, and its tests are skipped; where CI is set that is a fault.
define missing
	@echo "SKIPPED: the page was not tested $(1): it needs $(2)"; test -z "$$CI"
endef

page-test: .venv/installed ## The page: types, units, and in Chromium beside the real server
ifeq ($(shell command -v npm),)
	$(call missing,at all,Node 20 or newer)
else
	$(PYTHON) packaging/backend.py
	cd web && npm run --silent check && npm test --silent
ifeq ($(CHROMIUM),)
	$(call missing,in a browser,Chromium: apt-get install chromium, or make CHROMIUM=/path/to/it)
else
	cd web && CHROMIUM="$(CHROMIUM)" npm run --silent end
endif
endif

bench: ## Speed of both simulators and the brain
	cargo bench --locked -p agent-economy-benchmarks --bench classic --bench brain
	cargo run --release --locked -p agent-economy-benchmarks

bench-peers: ## Speed of other simulators beside ours (installs them in benchmarks/.venv)
	$(PYTHON) benchmarks/peers/run.py

bench-brains: .venv/installed ## Robot-updates a second with brains in Python
	$(BIN)/python scripts/brain_speed.py

bench-store: .venv/installed ## Rows a second into a study's store, and bytes a row
	$(BIN)/python scripts/store_speed.py

verify-selection: ## Does the race keep its guarantee? 20,000 macro-replications a problem
	cargo run --release --locked -p agent-economy-select --example verify

validation: .venv/installed ## Measure and draw docs/validation.md anew
	RENEW_VALIDATION=1 cargo test --locked -p agent-economy-sim --test validation
	$(BIN)/python scripts/validation.py

minds: .venv/installed ## Measure and draw docs/minds.md anew (some minutes)
	$(BIN)/python scripts/minds.py

golden: ## Runs of the metric engine are the same bytes from a debug and from a release build
	cargo test --locked --profile unoptimised -p agent-economy-sim --test engine golden
	cargo test --locked --release -p agent-economy-sim --test engine golden

replication: .venv/installed ## Recompute every figure of docs/replication.md
	$(BIN)/python scripts/replication.py

schemas: ## Write the JSON Schema and the reference of scenarios anew from their types
	RENEW_SCHEMAS=1 cargo test --locked -p agent-economy-sim --test schemas -- --test-threads=1
	RENEW_SCHEMAS=1 cargo test --locked -p agent-economy-classic --test schema

web: ## Build the page that `agent-economy ui` shows (needs Node 20 or newer)
	$(PYTHON) packaging/backend.py

examples: .venv/installed ## Write anew what examples print
	RENEW_EXAMPLES=1 $(BIN)/pytest -q python/tests/test_examples.py

picture: study ## Take docs/report.png anew (needs Chromium)
	$(BIN)/python scripts/report_picture.py

page-pictures: .venv/installed web ## Take the pictures of docs/ui anew (needs Node and Chromium)
	cd web && CHROMIUM="$(CHROMIUM)" node dev/pictures.mjs

bench-page: .venv/installed web ## What the page costs: first load, changes until seen, crowds (needs Chromium)
	cd web && CHROMIUM="$(CHROMIUM)" npm run --silent bench

# Needs a nightly Rust and cargo-fuzz (`cargo install cargo-fuzz`).
fuzz: ## Broken input to every reader, a minute each
	set -e; for target in $$(cargo +nightly fuzz list); do \
		mkdir -p fuzz/corpus/$$target; \
		cargo +nightly fuzz run $$target fuzz/corpus/$$target fuzz/seeds/$$target -- \
			-max_total_time=60 -max_len=4096 -timeout=5 -rss_limit_mb=1024; \
	done

clean: ## Remove what was made
	rm -rf .venv benchmarks/.venv web/node_modules web/dist python/agent_economy/web target studies fuzz/target fuzz/corpus fuzz/artifacts

.venv/packages: requirements.lock
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "needs Python 3.11 or newer: make PYTHON=...")'
	$(PYTHON) -m venv .venv
	$(BIN)/pip install --quiet --disable-pip-version-check -r requirements.lock
	touch $@

.venv/installed: .venv/packages pyproject.toml $(RUST)
	$(BIN)/pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation -e .
	touch $@
