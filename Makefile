# Python >= 3.11, git and make are required. These targets install everything else into .venv.
PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
# These versions are tested. `make CONSTRAINTS= demo` takes the newest releases instead.
CONSTRAINTS ?= --constraint constraints.txt --build-constraint constraints.txt
# Tests keep the code that they compile, of XLA and of Python, which saves time when they are run again.
TESTS := PYTHONDONTWRITEBYTECODE= JAX_COMPILATION_CACHE_DIR=$(CURDIR)/$(VENV)/compiled $(BIN)/python -m pytest --numprocesses 2

.PHONY: demo test quick slow newest oldest compiled check docs format figures bench gpu mutants constraints clean

demo: $(VENV)/installed  ## evolve pole balancers, draw and report them, and film the first life beside a long one
	rm -rf runs/demo
	$(BIN)/primordia run CartPole-survival --out runs/demo
	$(BIN)/primordia plot runs/demo
	$(BIN)/primordia report runs/demo
	$(BIN)/primordia replay runs/demo --beside 0 --out runs/demo/videos/first-and-champion.mp4
	@echo
	@echo "Watch      runs/demo/videos/first-and-champion.mp4: the first death, and beside it the champion"
	@echo "Explore    runs/demo/report.html in a browser: every organism, its line of descent, the film of its world"
	@echo 'Read on    docs/tutorial.md, ten minutes; `source .venv/bin/activate` puts `primordia` on the path'

test: $(VENV)/installed-dev compiled  ## run the tests: four minutes on two cores, two the second time
	$(TESTS) --dist loadfile --no-loadscope-reorder

quick: $(VENV)/installed-dev compiled  ## test each promise once, with the tests in tests/quick.txt: a minute on two cores
	$(TESTS) --dist loadfile --no-loadscope-reorder @tests/quick.txt

slow: $(VENV)/installed-dev compiled  ## run the tests marked slow: more than an hour of kills, forged runs, generated inputs, all goldens and the oldest releases
	$(TESTS) -m slow
	$(MAKE) oldest

newest:  ## run `make quick` on the newest Python at hand, with the newest releases of all libraries
	@for each in python3.14 python3.13 python3.12 python3; do \
	  if $$each -c '' 2> /dev/null; then $(MAKE) VENV=.venv-newest CONSTRAINTS= PYTHON=$$each quick; exit; fi; done

oldest: .venv-oldest/lowest  ## run `make quick` with the lowest releases that pyproject.toml allows
	touch .venv-oldest/installed .venv-oldest/installed-dev
	$(MAKE) VENV=.venv-oldest CONSTRAINTS= quick

.venv-oldest/lowest: pyproject.toml
	rm -rf .venv-oldest
	$(PYTHON) -m venv .venv-oldest
	.venv-oldest/bin/python -m pip install --quiet uv
	.venv-oldest/bin/uv pip install --quiet --python .venv-oldest/bin/python --resolution lowest-direct --editable . --group dev
	.venv-oldest/bin/uv pip install --quiet --python .venv-oldest/bin/python --resolution lowest-direct --no-deps --group no-deps
	touch $@

compiled:
	@[ "$$(du -sm $(VENV)/compiled 2> /dev/null | cut -f 1)" -lt 1000 ] 2> /dev/null || rm -rf $(VENV)/compiled

check: $(VENV)/installed-dev  ## check format, lint and types, run all tests, and build the site
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(MAKE) test docs

docs: $(VENV)/installed-docs  ## build the site into build/site; broken links and anchors fail
	$(BIN)/python docs/site.py

format: $(VENV)/installed-dev
	$(BIN)/ruff format .
	$(BIN)/ruff check --fix .

figures: $(VENV)/installed-dev  ## fill the figures of committed tables into the pages; a test compares them
	$(BIN)/python docs/templates/fill.py

bench: $(VENV)/installed-dev  ## measure every figure; `make bench JSON=file.json` writes them to a file
	$(BIN)/python benchmarks/bench.py $(if $(JSON),--json $(JSON))

gpu: $(VENV)/installed-gpu  ## on an NVIDIA GPU: try the promises and measure worlds in nine minutes; elsewhere one line says that there is none
	@$(BIN)/python benchmarks/gpu.py $(if $(JSON),--json $(JSON))

mutants: $(VENV)/installed-mutants  ## plant faults and count those noticed, hours; `make mutants FILES="law/tick.py" SAMPLE=10 SEED=1`
	$(BIN)/python benchmarks/mutants.py $(FILES) $(if $(SAMPLE),--sample $(SAMPLE)) $(if $(SEED),--seed $(SEED)) $(if $(JSON),--json $(JSON))

constraints:  ## write the newest releases into constraints.txt; run `make check` before you commit it
	rm -rf $(VENV)
	$(MAKE) CONSTRAINTS= $(VENV)/installed-mutants $(VENV)/installed-docs
	sed -n '/^#/p' constraints.txt > $(VENV)/constraints
	$(BIN)/python -m pip freeze --exclude-editable | sed '/^pymdown-extensions/d; s/$$/; python_version < "3.14"/' >> $(VENV)/constraints
	mv $(VENV)/constraints constraints.txt

clean:
	rm -rf .venv .venv-newest .venv-oldest

$(VENV)/bin/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' \
	  || { echo "Primordia needs Python 3.11 or newer; try: make PYTHON=python3.12 demo" >&2; exit 2; }
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade pip

$(VENV)/installed: $(VENV)/bin/python pyproject.toml constraints.txt
	$(BIN)/python -m pip install --quiet $(CONSTRAINTS) --editable .
	@touch $@

$(VENV)/installed-dev: $(VENV)/installed
	$(BIN)/python -m pip install --quiet $(CONSTRAINTS) --group dev
	$(BIN)/python -m pip install --quiet $(CONSTRAINTS) --no-deps --group no-deps
	@touch $@

$(VENV)/installed-mutants: $(VENV)/installed-dev
	$(BIN)/python -m pip install --quiet $(CONSTRAINTS) --group mutants
	@touch $@

$(VENV)/installed-gpu: $(VENV)/installed-dev
	@if nvidia-smi > /dev/null 2>&1; then \
	  $(BIN)/python -m pip install --quiet $(CONSTRAINTS) --editable '.[gpu]' && touch $@; fi

$(VENV)/installed-docs: $(VENV)/installed-dev
	$(BIN)/python -m pip install --quiet $(CONSTRAINTS) --group docs
	@touch $@
