# make demo: the environment, the build, and the main job on real input
# make test: everything that is checked

VENV := .venv
BIN := $(VENV)/bin
CORE := Cargo.toml pyproject.toml $(shell find src -name '*.rs')

PACKAGE := $(shell find python -name '*.py' -o -name '*.pyi' -o -name 'page.*')

.PHONY: demo test rust python docs wheel browser long bench mutants clean

demo: $(VENV)/.built
	$(BIN)/python examples/main_job.py demo

test: rust python docs

rust:
	cargo fmt --check
	cargo clippy --all-targets -- -D warnings
	cargo clippy --all-targets --features python -- -D warnings
	cargo test
	RUSTDOCFLAGS='-D warnings' cargo doc --no-deps --quiet

python: $(VENV)/.tested browser
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/python -m mypy.stubtest spincyl._core
	$(BIN)/pytest

# The pages, with every figure made and every warning an error; then each is opened in a browser, offline.
docs: $(VENV)/.tested
	$(BIN)/python -m pip install --quiet --group docs
	$(BIN)/python -m sphinx -W --keep-going -q -b html docs docs/_build
	$(BIN)/python tests/built_pages.py docs/_build

# For the tests of pages. Without one the others run all the same, but where CI is set.
browser: $(VENV)/.tested
	@$(BIN)/python tests/browser.py

# To give away: one file for every Python from 3.11 on and every Linux from glibc 2.17 on, which needs no Rust where it
# is installed; and one for the other processor if rustup has its target.
wheel: dist/.built

# Longer than a test should be; docs/hard-cases.md says what they gave.
long: $(VENV)/.tested wheel
	SPINCYL_WHEELS=dist $(BIN)/pytest tests/test_install.py -k wheel
	$(BIN)/python benches/accuracy.py --points 1e7
	$(BIN)/python benches/accuracy.py --points 1e7 --whole
	$(BIN)/python benches/inverse.py --points 1e6 --exact 1e5
	$(BIN)/python benches/rounded.py --bodies 1e6
	$(BIN)/python benches/motion.py
	$(BIN)/python benches/behaviour.py --kills 100
	$(BIN)/python -m pip install --quiet --group peers
	$(BIN)/python benches/starts.py --count 100000
	$(BIN)/python benches/claims.py --count 10000
	$(BIN)/python benches/slip_starts.py --count 10000 --painleve 1000
	$(BIN)/python benches/saddles.py --count 200
	cargo test --release --tests -- --ignored --nocapture --test-threads 1
	cargo publish --dry-run --allow-dirty

bench: $(VENV)/.tested
	$(BIN)/python -m pip install --quiet --group peers
	$(BIN)/python benches/map.py
	$(BIN)/python benches/rims.py
	$(BIN)/python benches/benchmarks.py
	$(BIN)/python benches/peers/main.py --docs
	$(BIN)/python benches/peers/slip.py
	$(BIN)/python benches/behaviour.py
	cargo bench

# Unoptimised and for one SIMD level only: a mutant then takes five seconds instead of forty.
mutants: export CARGO_PROFILE_DEV_OPT_LEVEL = 0
mutants: export RUSTFLAGS = --cfg disable_dispatch_avx512 --cfg disable_dispatch_sse4_2
mutants:
	cargo mutants -j 2

$(VENV)/.made: pyproject.toml
	python3 -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade 'pip>=25.1' 'maturin>=1.16,<2'
	touch $@

# Installed as a user installs it, so that the tests see what a user gets.
$(VENV)/.built: $(VENV)/.made $(CORE) $(PACKAGE)
	rm -rf $(VENV)/wheels
	$(BIN)/python -m maturin build --quiet --release --out $(VENV)/wheels
	$(BIN)/python -m pip install --quiet --force-reinstall --no-deps $(VENV)/wheels/*.whl
	$(BIN)/python -m pip install --quiet "$$(echo $(VENV)/wheels/*.whl)[plot,sweep]"
	touch $@

# The linker is zig, which has every glibc: a hundred megabytes that nothing else here needs.
dist/.built: $(VENV)/.made $(CORE) $(PACKAGE)
	rm -rf dist
	$(BIN)/python -m pip install --quiet 'maturin[zig]'
	for target in x86_64-unknown-linux-gnu aarch64-unknown-linux-gnu; do \
		test ! -d "$$(rustc --print target-libdir --target $$target)" || PATH="$(CURDIR)/$(BIN):$$PATH" maturin build \
		--quiet --release --zig --compatibility manylinux2014 --target $$target --out dist || exit 1; done
	@ls dist/*.whl || (echo "No wheel: rustup target add x86_64-unknown-linux-gnu"; false)
	touch $@

$(VENV)/.tested: $(VENV)/.built
	$(BIN)/python -m pip install --quiet --group dev "$$(echo $(VENV)/wheels/*.whl)[all,engine]"
	touch $@

clean:
	rm -rf $(VENV) target demo dist docs/_build docs/_made
