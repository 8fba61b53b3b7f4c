# make               set up and run the main job: tables, figures and the report
# make DATA=folder   the same with the real recordings of a folder (or set SIGNKIN_DATA)
# make utterance CORPUS=dgs-1984189 GLOSSES="CAT3 BIRD1"   a synthetic utterance ($$ for a dollar)
# make test          set up and pass the tests
# make lock          pin the dependencies anew (needs uv)
# make clean         take away what a run made; the environment stays

PYTHON ?= $(shell command -v python3.11 || command -v python3)
VENV := .venv
BIN := $(VENV)/bin
PIP := $(PYTHON) -m pip --python $(BIN)/python install --quiet --disable-pip-version-check

ifneq ($(DATA),)
export SIGNKIN_DATA := $(DATA)
endif
.PHONY: all utterance test lint unit lock clean
.DELETE_ON_ERROR:

all: $(VENV)/ready
	@$(BIN)/signkin run $(ARGS)

utterance: $(VENV)/ready
	@$(BIN)/signkin utterance '$(CORPUS)' '$(GLOSSES)' $(ARGS)

$(VENV)/ready: requirements.lock pyproject.toml
	@$(PYTHON) -c 'import sys; v = sys.version_info; sys.exit(0 if v >= (3, 11) else \
	  f"signkin needs Python 3.11 or later; {sys.executable} is {v.major}.{v.minor}. Set PYTHON=...")'
	$(PYTHON) -m venv --without-pip $(VENV)
	$(PIP) --require-hashes -r requirements.lock
	$(PIP) --no-deps --no-build-isolation --editable .
	@touch $@

test: lint unit

lint: $(VENV)/ready
	$(BIN)/ruff check src workflow/scripts tests docs
	$(BIN)/ruff format --check src workflow/scripts tests docs
	$(BIN)/snakefmt --check Snakefile workflow/rules
	$(BIN)/mypy src
	$(BIN)/lint-imports

unit: $(VENV)/ready
	.ci/chromium
	$(BIN)/pytest -n 2 --dist worksteal $(ARGS)

lock:
	uv pip compile --universal --python-version 3.11 --generate-hashes --no-header --all-extras \
	  --quiet pyproject.toml -o requirements.lock

clean:
	rm -rf .snakemake logs
	find results -mindepth 1 -maxdepth 1 ! -name README.md -exec rm -rf {} +
