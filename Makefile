# make               set up and run the main job: tables, figures and the report
# make DATA=folder   the same with the real recordings of a folder (or set SIGNKIN_DATA)
# make utterance CORPUS=dgs-1984189 GLOSSES="CAT3 BIRD1"   a synthetic utterance ($$ for a dollar)
# make fetch CORPUS=...   get the files of a corpus that have a public address, and verify them
# make test          set up and pass the tests
# make test-slurm    the workflow on a SLURM cluster of two nodes on this machine (Debian, root)
# make fuzz          10,000 damaged files of each format against its reader (`make test`: 500)
# make test-faults   faults in a run, 20 kills among them: a table (`make test`: five kills)
# make lint          its first half: style, types, import contracts
# make coverage      which lines the unit tests run: a table, and build/coverage/index.html
# make docs          the pages of docs/ and the API as a site: build/docs/index.html
# make numbers DATA=folder   write the numbers of docs/interpretations.md and README.md anew (after make DATA=folder)
# make bench         time the binning engine beside its peers (benchmarks/README.md)
# make audit-draws   10,000 data sets that exist for each check on print: how many are accused
# make settings      write config.yaml, its schema and docs/configuration.md from the models
# make lock          pin the dependencies anew (needs uv)
# make clean         take away what a run made; the environment stays

PYTHON ?= $(shell command -v python3.11 || command -v python3)
VENV := .venv
BIN := $(VENV)/bin
PIP := $(PYTHON) -m pip --python $(BIN)/python install --quiet --disable-pip-version-check

ifneq ($(DATA),)
export SIGNKIN_DATA := $(DATA)
endif
.PHONY: all utterance fetch test test-faults test-slurm fuzz lint unit coverage docs numbers settings bench lock bench-lock clean
.DELETE_ON_ERROR:

all: $(VENV)/ready
	@$(BIN)/signkin run $(ARGS)

utterance: $(VENV)/ready
	@$(BIN)/signkin utterance '$(CORPUS)' '$(GLOSSES)' $(ARGS)

fetch: $(VENV)/ready
	@$(BIN)/signkin corpus fetch '$(CORPUS)' $(ARGS)

$(VENV)/ready: requirements.lock pyproject.toml
	@$(PYTHON) -c 'import sys; v = sys.version_info; sys.exit(0 if v >= (3, 11) else \
	  f"signkin needs Python 3.11 or later; {sys.executable} is {v.major}.{v.minor}. Set PYTHON=...")'
	$(PYTHON) -m venv --without-pip $(VENV)
	$(PIP) --require-hashes -r requirements.lock
	$(PIP) --no-deps --no-build-isolation --editable .
	@touch $@

# What the linters read; .pre-commit-config.yaml has the same tools.
CODE := src workflow/scripts tests tools examples docs benchmarks

test: lint unit

lint: $(VENV)/ready
	$(BIN)/ruff check $(CODE)
	$(BIN)/ruff format --check $(CODE)
	$(BIN)/snakefmt --check Snakefile workflow/rules
	$(BIN)/mypy src
	$(BIN)/lint-imports

unit: $(VENV)/ready
	.ci/chromium
	$(BIN)/pytest -n 2 --dist loadfile --no-loadscope-reorder $(ARGS)

test-faults: $(VENV)/ready
	cd tests && PYTHONPATH=$(CURDIR)/src:$(CURDIR)/tests ../$(BIN)/python -m support.faults $(ARGS)

test-slurm: $(VENV)/ready
	.ci/slurm
	SIGNKIN_SLURM=whole $(BIN)/pytest -v tests/workflow/test_slurm.py $(ARGS)

fuzz: $(VENV)/ready
	SIGNKIN_FUZZ=10000 $(BIN)/pytest -n 2 --dist load tests/unit/test_motion_fuzz.py \
	  tests/unit/test_tag_fuzz.py $(ARGS)

# Apart from `make test`, whose time it would double. What runs compiled, and the scripts that
# Snakemake starts, are not seen.
coverage: $(VENV)/ready
	$(BIN)/pytest -n 2 --dist loadfile tests/unit tests/oracle --quiet \
	  --cov --cov-report=term --cov-report=html $(ARGS)

docs: $(VENV)/ready
	$(BIN)/sphinx-build -q -W --keep-going docs build/docs
	@echo "The site: build/docs/index.html"

numbers: $(VENV)/ready
	$(BIN)/python -m tools.numbers results '$(SIGNKIN_DATA)' $(ARGS)
	$(BIN)/python -m tools.readme results

audit-draws: $(VENV)/ready
	$(BIN)/python tests/support/audit_draws.py $(or $(ARGS),10000)

# PyTorch, which one peer wants, is no part of the lock: see benchmarks/README.md.
TORCH ?= torch==2.13.0
BENCH := .venv-bench

bench: $(BENCH)/ready
	$(BENCH)/bin/python -m benchmarks $(ARGS)

$(BENCH)/ready: requirements-bench.lock
	$(PYTHON) -m venv --without-pip $(BENCH)
	$(subst $(BIN),$(BENCH)/bin,$(PIP)) --require-hashes --no-deps -r requirements-bench.lock
	$(subst $(BIN),$(BENCH)/bin,$(PIP)) --no-deps --no-build-isolation --editable .
	-$(subst $(BIN),$(BENCH)/bin,$(PIP)) --no-deps $(TORCH)
	@touch $@

bench-lock:
	uv pip compile --universal --python-version 3.11 --generate-hashes --no-header --quiet \
	  --constraint requirements.lock --override benchmarks/overrides.txt \
	  requirements-bench.in -o requirements-bench.lock

settings: $(VENV)/ready
	$(BIN)/python -m signkin.settings .

# All extras but s3, whose test is run by hand.
LOCKED := workflow cluster c3d h5 pdf test docs

lock:
	uv pip compile --universal --python-version 3.11 --generate-hashes --no-header $(LOCKED:%=--extra %) \
	  --quiet pyproject.toml -o requirements.lock

clean:
	rm -rf .snakemake logs build
	find results -mindepth 1 -maxdepth 1 ! -name README.md -exec rm -rf {} +
