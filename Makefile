# make demo: the environment, the build, and the main job on real input
# make test: everything that is checked
# make notebooks: the pages and the scenes of the gallery as Jupyter notebooks
# make note: the note on two stabilities, as a page and a PDF
# make web: the core of the live page, after a change of src/ or web/

SHELL := bash
.SHELLFLAGS := -o pipefail -c

# What a step says, with the seconds since make began.
BEGAN := $(shell date +%s)
SAY = @printf '[%3d s] %s\n' $$(( $$(date +%s) - $(BEGAN) ))
TIMED = 2>&1 | while IFS= read -r line; do printf '[%3d s] %s\n' $$(( $$(date +%s) - $(BEGAN) )) "$$line"; done

# A line every 20 s while the rest of a recipe, which is one shell, says nothing.
ALIVE = while sleep 20 > /dev/null 2>&1; do printf '[%3d s] %s\n' $$(( $$(date +%s) - $(BEGAN) )) "$$alive"; done & \
	alive_pid=$$!; trap 'kill $$alive_pid 2> /dev/null' EXIT

# What says nothing for ten minutes stands still: it fails, with its last words. Tests of Python have tests/still.py.
AWAKE := python3 tests/awake.py 600
SLOW := python3 tests/awake.py 3600

VENV := .venv
BIN := $(VENV)/bin
CORE := Cargo.toml build.rs pyproject.toml $(shell find src -name '*.rs')

PACKAGE := $(shell find python -name '*.py' -o -name '*.pyi' -o -path '*/pages/js/*' -type f -o -path '*/pages/cores/*' -type f -o -path '*/examples/*' -type f)

# What Python has compiled is kept, whatever the shell says: every process that tests would take five seconds for it.
export PYTHONDONTWRITEBYTECODE =

.PHONY: demo test rust python pages docs notebooks note lint web core wheel browser long bench mutants clean

demo: $(VENV)/.built
	$(SAY) 'the main job, on real input'
	@alive='the main job: steady states, motions, a map of 16 million points, figures'; $(ALIVE); \
	$(BIN)/python examples/main_job.py demo

# All at a time, since those that open browsers or start other processes wait for much of theirs, and what needs only a
# compiler stands beside that of the wheel. What each said is shown when it is done.
test:
	@cargo fetch --quiet
	@alive='the checks of rust, pages, python, docs and lint run; each is shown when it is done'; $(ALIVE); \
	$(MAKE) --no-print-directory -j5 --output-sync=target rust pages python docs lint

# What no pointer shares is not told to the optimiser: it would take twice as long and twice the memory. Nothing is kept for
# a second compilation. Sixteen lanes are left to the tests of the wheel; the tests inside the library want little speed.
# The wheel goes before, since the tests of Python and of pages wait for it. A program without optimisation has no lanes.
rust: export CARGO_INCREMENTAL = 0
rust: export SPINCYL_COMPILED_LANES = one
rust: export RUSTFLAGS = -C llvm-args=-enable-noalias-to-md-conversion=false
rust:
	cargo fmt --all --check
	SPINCYL_COMPILED_LANES=none nice -n 10 cargo check --quiet --lib
	SPINCYL_COMPILED_LANES=none nice -n 10 cargo check --quiet --lib --no-default-features
	SPINCYL_COMPILED_LANES=none nice -n 10 cargo check --quiet --lib --no-default-features --features serde
	if rustup target list --installed 2>/dev/null | grep -q wasm32; then \
	  nice -n 10 cargo check --quiet -p spincyl-web --target wasm32-unknown-unknown; fi
	nice -n 10 cargo clippy --workspace --exclude spincyl-benches --all-targets --features python,scene -- -D warnings
	CARGO_PROFILE_TEST_OPT_LEVEL=1 $(SLOW) nice -n 10 cargo test --lib --no-run
	CARGO_PROFILE_TEST_OPT_LEVEL=1 $(AWAKE) nice -n 10 cargo test --lib
	SPINCYL_COMPILED_LANES=none $(SLOW) nice -n 10 cargo test --profile checked --lib --no-run
	SPINCYL_COMPILED_LANES=none $(AWAKE) nice -n 10 cargo test --profile checked --lib
	$(SLOW) nice -n 10 cargo test --features scene --test '*' --no-run
	$(AWAKE) nice -n 10 cargo test --features scene --test '*'
	$(SLOW) nice -n 10 cargo test --features scene --doc
	RUSTDOCFLAGS='-D warnings' nice -n 10 cargo doc --features scene --no-deps --quiet

# In one process: a second one would take a fifth more of the processor, and the tests of pages and docs run beside it.
# Rust and docs give way to both. The docs test the numbers of their note.
python: $(VENV)/.tested
	$(BIN)/pytest -m 'not page and not long' --ignore tests/test_note.py

lint: $(VENV)/.tested
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/python -m mypy.stubtest --mypy-config-file tests/stubs.ini spincyl._core

# What is seen and done in a browser.
pages: $(VENV)/.tested browser
	$(BIN)/pytest -m 'page and not long'

# The docs, with every figure made and every warning an error; then each is opened in a browser, offline.
docs: note
	$(SLOW) nice -n 10 $(BIN)/python -m sphinx -W --keep-going -q -b html docs docs/_build
	nice -n 10 $(BIN)/pytest -q tests/test_note.py
	$(SLOW) $(BIN)/python tests/built_pages.py docs/_build

# Of every page that has code and every scene: docs/_made/notebooks.
notebooks: $(VENV)/.built
	$(BIN)/python docs/notebooks.py

# The note on two stabilities, with every number and figure computed: docs/note/_made/two-stabilities.html and .pdf.
note: $(VENV)/.tested browser
	nice -n 10 $(BIN)/python docs/note/note.py

# The cores as WebAssembly, and what they were built from. Where rustup lacks the target it says so, and they stay.
web:
	@python3 web/build.py

# The same built anew beside the committed one, for tests/test_web.py, where the target can be had.
core:
	@rustup target add wasm32-unknown-unknown >/dev/null 2>&1 || true
	@python3 web/build.py target/cores

# For the tests of pages. Without one the others run all the same, but where CI is set.
browser: $(VENV)/.tested
	@$(BIN)/python tests/browser.py

# To give away: one file for every Python from 3.11 on and every Linux from glibc 2.17 on, which needs no Rust where it
# is installed; and one for the other processor if rustup has its target. Beside them the sources, to be built with Rust.
wheel: dist/.built

# What tests lanes, of which a program with checks of overflows has none: they would take the compiler six times as long.
BUT_LANES := $(addprefix --skip ,ensemble:: many_ends:: many_near_turns:: poses::a_quick_pose evaluations::an_output_more)

# Longer than a test should be; docs/hard-cases.md says what they gave.
long: $(VENV)/.tested wheel core
	$(BIN)/pytest tests/test_web.py
	SPINCYL_WHEELS=dist $(BIN)/pytest -m 'not long' tests/test_install.py
	$(BIN)/python -m pip install --quiet --group jupyter
	$(BIN)/pytest -m long
	$(BIN)/python benches/accuracy.py --points 1e7
	$(BIN)/python benches/accuracy.py --points 1e7 --whole
	$(BIN)/python benches/inverse.py --points 1e6 --exact 1e5
	$(BIN)/python benches/rounded.py --bodies 1e6
	$(BIN)/python benches/motion.py
	$(BIN)/python benches/behaviour.py --kills 100
	$(BIN)/python -m pip install --quiet --group peers
	$(BIN)/python benches/claims.py --of starts --count 100000
	$(BIN)/python benches/claims.py --of motions --count 10000
	$(BIN)/python benches/claims.py --of many --count 100000
	$(BIN)/python benches/claims.py --of singles --count 5000
	$(BIN)/python benches/claims.py --of ends --count 1000000
	$(BIN)/python benches/claims.py --of phases --count 10000 --painleve 1000
	$(BIN)/python benches/claims.py --of losses
	$(BIN)/python benches/losses_fit.py
	$(BIN)/python benches/claims.py --of saddles --count 200
	$(BIN)/python benches/claims.py --of stones --count 10000
	$(BIN)/python benches/slowest.py --count 20000
	$(BIN)/python benches/profiles.py --count 10000
	$(BIN)/python benches/aloft.py --count 20000
	$(BIN)/python benches/stone_hops.py --count 3334
	$(BIN)/python benches/stone_hops.py --count 3334 --patch
	$(BIN)/python benches/stone_hops.py --count 4000 --errors
	$(BIN)/python benches/faces.py --count 20000
	$(BIN)/python benches/claims.py --of hops --count 5000
	$(BIN)/python benches/random_scenes.py --count 500
	$(BIN)/python benches/random_scenes.py --reference 24
	$(BIN)/python benches/claims.py --of launches
	HYPOTHESIS_PROFILE=fresh $(BIN)/pytest -m 'not page and not long' $$(grep -l hypothesis tests/test_*.py)
	python3 tests/fresh.py --runs 10
	nice -n 10 python3 tests/thresholds.py
	cargo clippy -p spincyl-benches --all-targets -- -D warnings
	SPINCYL_COMPILED_LANES=none cargo test --profile checked --features serde --test laws -- $(BUT_LANES)
	SPINCYL_LONG=1 cargo test --release --tests
	SPINCYL_LONG=1 cargo test --release --tests -- --ignored --nocapture --test-threads 1
	$(BIN)/python -m pip install --quiet --group release
	$(BIN)/python -m twine check --strict dist/*.whl dist/*.tar.gz
	cargo publish --dry-run --allow-dirty

bench: $(VENV)/.tested
	$(BIN)/python -m pip install --quiet --group peers
	$(BIN)/python benches/map.py
	$(BIN)/python benches/rims.py
	$(BIN)/python benches/benchmarks.py
	$(BIN)/python benches/peers/main.py --docs
	$(BIN)/python benches/peers/stone.py
	$(BIN)/python benches/cluster.py --docs
	$(BIN)/python benches/losses_motions.py
	$(BIN)/python benches/losses_slow.py
	$(BIN)/python benches/whirr.py
	$(BIN)/python benches/drifts.py
	$(BIN)/python benches/launch_map.py
	$(BIN)/python benches/behaviour.py
	cargo bench --workspace

# Errors planted at random, all compiled at once and switched on one by one: 200 take a quarter of an hour.
mutants: $(VENV)/.tested
	$(BIN)/python -m pip install --quiet --group mutants
	$(BIN)/python benches/mutants.py

$(VENV)/.made: pyproject.toml
	$(SAY) 'an environment for Python in $(VENV)'
	python3 -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade 'pip>=25.1' 'maturin>=1.16,<2'
	touch $@

# NumPy, matplotlib and what else the extras want: they come while the compiler is at work.
NEEDS := python3 -c 'import tomllib; a = tomllib.load(open("pyproject.toml", "rb"))["project"]; \
	b = a["optional-dependencies"]; print(*a["dependencies"], *b["plot"], *b["sweep"], sep="\n")'

# Installed as a user installs it, so that the tests see what a user gets. A module is compiled when it is first used.
$(VENV)/.built: $(VENV)/.made $(CORE) $(PACKAGE)
	rm -rf $(VENV)/wheels
	$(SAY) 'the wheel: some sixty small crates, then this one, which takes a minute or two'
	@alive='the compiler is at work'; $(ALIVE); \
	$(NEEDS) | $(BIN)/python -m pip install --quiet --no-compile -r /dev/stdin & needs=$$!; \
	$(BIN)/python -m maturin build --release --compression-level 9 --out $(VENV)/wheels $(TIMED); built=$$?; wait $$needs; exit $$built
	$(SAY) 'the wheel is installed'
	$(BIN)/python -m pip install --quiet --force-reinstall --no-deps $(VENV)/wheels/*.whl
	$(BIN)/python -m pip install --quiet --no-compile "$$(echo $(VENV)/wheels/*.whl)[plot,sweep]"
	touch $@

# The linker is zig, which has every glibc: a hundred megabytes that nothing else here needs.
dist/.built: $(VENV)/.made $(CORE) $(PACKAGE)
	rm -rf dist
	$(BIN)/python -m pip install --quiet 'maturin[zig]'
	for target in x86_64-unknown-linux-gnu aarch64-unknown-linux-gnu; do \
		test ! -d "$$(rustc --print target-libdir --target $$target)" || PATH="$(CURDIR)/$(BIN):$$PATH" maturin build \
		--quiet --release --compression-level 9 --zig --compatibility manylinux2014 --target $$target --out dist || exit 1; done
	$(BIN)/python -m maturin sdist --out dist
	@ls dist/*.whl || (echo "No wheel: rustup target add x86_64-unknown-linux-gnu"; false)
	touch $@

$(VENV)/.tested: $(VENV)/.built
	$(BIN)/python -m pip install --quiet --no-compile --group dev --group docs "$$(echo $(VENV)/wheels/*.whl)[all,engine]"
	touch $@

clean:
	rm -rf $(VENV) target demo dist docs/_build docs/_made docs/note/_made MUJOCO_LOG.TXT Cargo.lock
	rm -rf .hypothesis .mypy_cache .pytest_cache .ruff_cache examples/.ruff_cache python/spincyl/_core*.so tests/*proptest-regressions
	find . -name __pycache__ -prune -exec rm -rf {} +
