# Needs Python 3.11+ with venv, a Rust toolchain and make. Everything else goes into .venv.

PYTHON ?= python3
BIN := .venv/bin
CHROMIUM ?= $(shell command -v chromium || command -v chromium-browser || command -v google-chrome)
PYTHON_CODE := python scripts packaging examples benchmarks/peers
WASM := wasm32-unknown-unknown
RUST := $(shell find crates/*/src crates/*/Cargo.toml crates/py/build) Cargo.toml Cargo.lock
# maturin and the programs that it starts are in the environment.
export PATH := $(CURDIR)/$(BIN):$(PATH)

.PHONY: help study ui test bench bench-brains bench-peers bench-store verify-selection verify-requirement fuzz golden schemas \
	picture page-pictures bench-page examples replication validation brain-comparison economy clearance verify-leases verify-goals goals web lint quick \
	rust-lint python-lint wasm rust-build rust-test python-test page-packages page-check page-browser page-test drive-browser clean

help: ## List the targets
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "%-17s %s\n", $$1, $$2 }' Makefile

study: .venv/installed ## Run the study of the 2003 experiment: how many robots?
	$(BIN)/agent-economy study scenarios/classic.toml

# The page is first: without Node, nothing else is installed.
ui: web .venv/installed ## Build what the browser interface needs, and open it (needs Node 20 or newer)
	$(BIN)/agent-economy ui

test: ## Run every check, as CI does, and print the time of each
	$(PYTHON) scripts/checks.py

# CRATE=brain checks that crate; without it, the files that differ from the branch main decide.
quick: .venv/checked ## Run the checks that a change needs: make quick CRATE=brain
	$(PYTHON) scripts/checks.py --quick $(addprefix --crate ,$(CRATE))

lint: rust-lint python-lint ## Check format, lints, types, stubs, import layers and circles, parameters, generated types, paths and prose

rust-lint:
	cargo fmt --all --check
	cargo clippy --workspace --all-targets --locked --quiet -- -D warnings

python-lint: .venv/checked target/page.schema.json
	$(BIN)/ruff format --check $(PYTHON_CODE)
	$(BIN)/ruff check $(PYTHON_CODE)
	$(BIN)/mypy
	$(BIN)/stubtest agent_economy._core
	$(BIN)/lint-imports --no-cache
	$(BIN)/python scripts/check_tree.py
	$(BIN)/python scripts/check_cycles.py
	$(BIN)/python scripts/check_parameters.py
	$(BIN)/python scripts/check_prose.py
	$(BIN)/python scripts/generate_types.py --check

# Only the generator of types reads this schema.
target/page.schema.json: $(RUST) crates/protocol/examples/page_schema.rs
	mkdir -p $(@D)
	new=$@.$$$$; cargo run --locked --quiet -p agent-economy-protocol --example page_schema > $$new && mv $$new $@ \
		|| { rm -f $$new; false; }

# A toolchain without rustup may lack the target: the check is then skipped with a message.
wasm: ## Check that the metric simulator and the brain compile for browsers
	@if [ -d "$$(rustc --print target-libdir --target $(WASM))" ] || rustup target add $(WASM); then \
		cargo check --locked --target $(WASM) \
			-p agent-economy-base -p agent-economy-brain -p agent-economy-economy -p agent-economy-sim; \
	else \
		echo "SKIPPED: the target $(WASM) is missing (rustup target add $(WASM))"; \
	fi

rust-build:
	cargo test --locked --no-run --quiet

rust-test: ## Run the tests of the crates
	cargo test --locked --quiet

# Tests of one file stay together: some share what they have computed.
python-test: .venv/checked ## Run the tests of the Python package
	$(BIN)/pytest --numprocesses 2 --dist loadfile

page-test: page-check page-browser ## Check the page: types, units, and in Chromium with the real server

# Skipping is an error where CI is set.
define missing
	@echo "SKIPPED: the page is not tested$(1): $(2) is missing"; test -z "$$CI"
endef

ifeq ($(shell command -v npm),)
page-packages:

page-check page-browser:
	$(call missing,,Node 20 or newer)
else
page-packages:
	$(PYTHON) packaging/backend.py

page-check: page-packages
	cd web && npm run --silent check && npm test --silent

page-browser: .venv/checked page-packages
ifeq ($(CHROMIUM),)
	$(call missing, in a browser,Chromium (apt-get install chromium, or make CHROMIUM=PATH))
else
	cd web && CHROMIUM="$(CHROMIUM)" npm run --silent end
endif
endif

drive-browser: .venv/checked page-packages ## Test the view Robots with the real warden and an emulated robot
	cd web && CHROMIUM="$(CHROMIUM)" DRIVE=1 npx playwright test --workers 1 drive.spec.ts

bench: ## Measure both simulators and the brain
	cargo bench --locked -p agent-economy-benchmarks --bench classic --bench brain
	cargo run --release --locked -p agent-economy-benchmarks

bench-peers: ## Measure other simulators too (installs them in benchmarks/.venv)
	$(PYTHON) benchmarks/peers/run.py

bench-brains: .venv/installed ## Measure brains written in Python: robot updates per second
	$(BIN)/python scripts/brain_speed.py

bench-store: .venv/installed ## Measure a study's store: rows per second, bytes per row
	$(BIN)/python scripts/store_speed.py

verify-selection: ## Verify the guarantee of the race: 20,000 macro-replications per problem
	cargo run --release --locked -p agent-economy-select --example verify

verify-requirement: ## Verify the promise of requirements: 20,000 macro-replications per problem
	cargo run --release --locked -p agent-economy-select --example verify -- requirement

validation: .venv/installed ## Regenerate docs/validation.md and its charts (takes minutes)
	RENEW_VALIDATION=1 cargo test --locked -p agent-economy-sim --test validation -- --include-ignored
	$(BIN)/python scripts/validation.py

brain-comparison: .venv/installed ## Regenerate docs/brain-comparison.md and its charts (takes minutes)
	$(BIN)/python scripts/brain_comparison.py

economy: .venv/installed ## Regenerate docs/economy.md and its charts (takes minutes)
	$(BIN)/python scripts/economy.py

# A claim that fails is an error, after all measurements.
clearance: .venv/installed ## Compare what controllers state of mined lanes with the truth (takes an hour)
	$(BIN)/python scripts/clearance.py

# Longer than the schedules of `make test`.
verify-leases: ## Verify the leases of goals: 10,000 schedules of lost, late and repeated messages, 2,000 of failures
	SCHEDULES=10000 cargo test --release --locked -p agent-economy-economy --test room safety
	RUNS=2000 cargo test --release --locked -p agent-economy-economy --test room survival -- --nocapture

# Longer than the runs of `make test`.
verify-goals: ## Verify that no goal is lost: 10,000 runs with changes, failures, cuts and refusals
	GOAL_RUNS=10000 cargo test --release --locked -p agent-economy-sim --test simulator no_goal_is_lost

golden: ## Check that an unoptimised and a release build give the same runs, byte for byte
	cargo test --locked --profile unoptimised -p agent-economy-sim --test simulator golden
	cargo test --locked --release -p agent-economy-sim --test simulator golden

replication: .venv/installed ## Recompute every figure of docs/replication.md
	RENEW_REPLICATION=1 cargo test --locked -p agent-economy-classic --test starts
	$(BIN)/python scripts/replication.py

schemas: ## Generate the JSON Schemas, the reference of scenarios, and the types of Python and TypeScript
	RENEW_SCHEMAS=1 cargo test --locked -p agent-economy-sim --test simulator schemas -- --test-threads=1
	RENEW_SCHEMAS=1 cargo test --locked -p agent-economy-classic --test schema
	RENEW_SCHEMAS=1 cargo test --locked -p agent-economy-protocol --test schemas
	$(MAKE) target/page.schema.json
	$(BIN)/python scripts/generate_types.py
	$(BIN)/python scripts/fleet_schema.py

web: ## Build the page of `agent-economy ui` (needs Node 20 or newer)
	$(PYTHON) packaging/backend.py

examples: .venv/checked ## Regenerate the expected output of the examples
	RENEW_EXAMPLES=1 $(BIN)/pytest -q python/tests/test_examples.py

picture: study ## Regenerate docs/report.png (needs Chromium)
	$(BIN)/python scripts/report_picture.py

page-pictures: .venv/installed web ## Regenerate the screenshots in docs/ui (needs Node and Chromium)
	cd web && CHROMIUM="$(CHROMIUM)" node dev/pictures.mjs

# MINUTES=60 measures the memory of server and tab while playing for that time, and nothing else.
bench-page: .venv/installed web ## Measure the page: first load, latency of changes, crowds, memory (needs Chromium)
	cd web && CHROMIUM="$(CHROMIUM)" npm run --silent bench -- $(addprefix --minutes ,$(MINUTES))

# Needs a nightly Rust and cargo-fuzz (`cargo install cargo-fuzz`).
safety: .venv/installed ## Break every port and process in every state, and measure the stops (a quarter of an hour); SAFETY=--quick
	$(BIN)/python python/tests/measure_safety.py $(SAFETY)

goals: .venv/installed ## Measure how soon robots give up goals that they cannot reach and have them later, in 600 random worlds
	$(BIN)/python python/tests/measure_goals.py

drive: .venv/installed ## Drive an emulated robot around a wall to two waypoints, and replay the recording
	@$(BIN)/agent-economy bender-emulator & emulator=$$!; trap "kill $$emulator" EXIT; \
		record=$$(mktemp -d)/bender.mcap; \
		$(BIN)/agent-economy drive fleets/bender.toml --headless --arm --record $$record && \
		$(BIN)/agent-economy replay $$record

fuzz: ## Fuzz every reader of input, one minute each
	set -e; for target in $$(cargo +nightly fuzz list); do \
		mkdir -p fuzz/corpus/$$target; \
		cargo +nightly fuzz run $$target fuzz/corpus/$$target fuzz/seeds/$$target -- \
			-max_total_time=60 -max_len=4096 -timeout=5 -rss_limit_mb=1024; \
	done

clean: ## Remove all build products
	rm -rf .venv benchmarks/.venv web/node_modules web/dist python/agent_economy/web target studies fuzz/target fuzz/corpus fuzz/artifacts

.venv/packages: requirements.lock
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "needs Python 3.11 or newer: make PYTHON=...")'
	$(PYTHON) -m venv .venv
	$(BIN)/pip install --quiet --no-compile --disable-pip-version-check -r requirements.lock
	touch $@

# The program for users and measurements.
.venv/installed: .venv/packages pyproject.toml $(RUST)
	@echo "compiling the simulators: a few minutes the first time"
	$(BIN)/pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation -e .
	rm -f .venv/checked
	touch $@

# The program for checks, compiled as the tests are: `make study` puts back the other one.
.venv/checked: .venv/packages pyproject.toml $(RUST)
	$(BIN)/pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation \
		--config-settings build-args=--profile=dev -e .
	rm -f .venv/installed
	touch $@
