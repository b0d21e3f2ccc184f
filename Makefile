# Two commands for people: `make demo` and `make test`. Each does its own set-up on a machine that
# has python3.11 to 3.13 and make. The others are parts of them, or for developers.
#
#   make demo [HEADLESS=1]   simulate a walk, map it, serve it in the browser
#   make test                everything that has to hold; `make unit`, `make lint`, … are its parts
#   make quick               what a change needs before it is committed: two minutes
#   make site                build the documentation site, which the server serves under /docs
#   make studies             the tests that are too long for every run: a few minutes
#   make looks               the tests in the browser, each on a desktop and on a phone
#   make bench               benchmarks, by hand: they need a quiet machine
#   make docs                write what is generated: settings, findings, HTTP types, NOTICE
#   make signatures          write recon4/kernels/signatures.txt: which kernels an installation compiles
#   make examples            run the programs in examples/ and write their pages
#   make constraints         pin the versions that are installed now
#   make lock                write requirements/*.lock: every file of every version, with its hash
#   make audit               known vulnerabilities of what is locked (needs the network)
#   make wheel               out/: a wheel with the kernels compiled for this Python
#   make sbom                out/sbom.json: what is installed, as CycloneDX

SHELL := /bin/sh
VENV := .venv
BIN := $(VENV)/bin
TOOLS := .venv-tools
# Only files whose hash is in the lock, which is complete: nothing is left to resolve. The build of
# recon4 itself fetches nothing.
LOCKED := -m pip install -q --no-deps --require-hashes -r
OURSELVES := -m pip install -q --no-deps --no-build-isolation -e .
FOR_USERS := demo site sbom audit lock clean web
COMPILE := $(TOOLS)/bin/uv pip compile -q --universal --python-version 3.11 --generate-hashes \
	--no-emit-index-url --no-annotate --no-header -c constraints.txt
PYTHON ?= $(shell for python in python3 python3.13 python3.12 python3.11; do \
	$$python -c 'import sys; sys.exit(not (3, 11) <= sys.version_info[:2] <= (3, 13))' 2>/dev/null \
	&& echo $$python && break; done)
export PYTHON
# Make 3 cannot keep the outputs of two targets apart.
SYNC := $(if $(filter output-sync,$(.FEATURES)),--output-sync=target)
# Else each of the hundreds of interpreters that tests start compiles recon4 again.
unexport PYTHONDONTWRITEBYTECODE
# Threads of BLAS that wait for each other cost three busy processes on two cores a seventh.
export OPENBLAS_NUM_THREADS := 1

.PHONY: demo test quick touched format lint types web kernels bytecode unit e2e looks studies bench site docs signatures examples constraints lock audit sbom wheel clean
.DELETE_ON_ERROR:
# Their parts run side by side all the same. Other goals wait: no two makes install at a time.
ifneq ($(filter test quick,$(MAKECMDGOALS)),)
.NOTPARALLEL:
endif

demo: $(VENV)/installed-run site
	$(BIN)/recon4 demo --out demo $(if $(HEADLESS),--headless)

# Browser tests wait most of the time: they run beside the others, which leave them the processor
# and themselves wait for other programs a good part of it: four fill what is left of two.
# The kernels come first, beside what is still installed: all tests need them.
# What both runs of tests need, as a finished project, is made once.
test:
	@made=$$(mktemp -d) && trap 'rm -rf "$$made"' EXIT && trap 'exit 130' INT TERM && export RECON4_MADE_ONCE="$$made" && \
	$(MAKE) --no-print-directory -j3 $(SYNC) kernels web bytecode site types format lint unit e2e

# Format, lint, types, the rules of the house, and the unit tests of the rooms that were touched.
quick:
	@$(MAKE) --no-print-directory -j2 $(SYNC) format lint types touched

touched: $(VENV)/installed-dev
	$(BIN)/python -m pytest -n 2 --dist loadfile -m "not e2e and not slow and not study" $$($(BIN)/python -m tools.touched)

format: $(VENV)/installed-dev
	$(BIN)/ruff format --check .

lint: $(VENV)/installed-dev
	$(BIN)/ruff check .

types: $(VENV)/installed-dev
	$(BIN)/pyrefly check

unit: $(VENV)/installed-dev site kernels bytecode
	nice -n 9 $(BIN)/python -m pytest -n 4 --dist loadfile --no-loadscope-reorder -m 'not e2e and not study' --durations=10

looks: $(VENV)/installed-dev site kernels bytecode
	RECON4_LOOKS=both $(BIN)/python -m pytest -m 'e2e and not study'

e2e: $(VENV)/installed-dev site kernels bytecode
	$(BIN)/python -m pytest -m 'e2e and not study' --durations=10

# It installs what tests of the browser judge pages by.
ifneq ($(filter web,$(MAKECMDGOALS)),)
e2e: web
endif

web:
	.ci/web

# Else processes that tests run side by side each compile them.
kernels: $(VENV)/installed-run
	@$(BIN)/recon4 compile

# What pip would do while nothing else can run yet; a confined process cannot keep what it compiles.
# Else the processes of a test run, which begin at once, each compile our own code and the tests.
bytecode: $(VENV)/installed-dev
	@$(BIN)/python -m compileall -qq -x '/tests?/' $(VENV)/lib || true
	@$(BIN)/python -m compileall -qq recon4 app tests tools
	@$(BIN)/python -m tools.rewritten_tests

studies: $(VENV)/installed-dev
	$(BIN)/python -m pytest -m 'study and not e2e' --durations=0
	$(BIN)/python -m pytest -m 'study and e2e' --durations=0

bench: $(VENV)/installed-dev
	@for name in decode false_loops real_sequences; do \
		echo "== $$name"; $(BIN)/python -m tests.benchmarks.$$name || exit 1; \
	done
	@echo 'Those that need a recording or a project: docs/studies'

site: site/index.html

site/index.html: zensical.toml tools/site.py $(shell find docs -type f) | $(VENV)/installed-run
	$(BIN)/python -m tools.site

docs: $(VENV)/installed-dev
	$(BIN)/recon4 settings --markdown > docs/reference/settings.md
	$(BIN)/python -m recon4.findings.explain > docs/reference/findings.md
	$(BIN)/python -m tools.setting_texts
	$(BIN)/python -m tools.command_texts
	$(BIN)/python -m tools.http_types
	$(BIN)/python -m tools.reference_pages
	$(BIN)/python -m tools.notice

signatures: $(VENV)/installed-dev
	$(BIN)/python -m tools.kernel_signatures

examples: $(VENV)/installed-dev
	$(BIN)/python -m tools.example_programs

constraints: $(VENV)/installed-dev
	$(BIN)/pip freeze --all --exclude-editable | grep '==' > constraints.txt

lock: $(TOOLS)/installed
	$(COMPILE) --extra build -o requirements/run.lock pyproject.toml
	$(COMPILE) --extra build --extra dev --extra pdf --extra dask --extra mcp -o requirements/dev.lock pyproject.toml
	$(COMPILE) -o requirements/tools.lock requirements/tools.in

audit: $(TOOLS)/installed
	$(TOOLS)/bin/pip-audit --strict --require-hashes --disable-pip -r requirements/run.lock

sbom: $(TOOLS)/installed $(VENV)/installed-run
	@mkdir -p out
	$(TOOLS)/bin/cyclonedx-py environment --pyproject pyproject.toml \
		--output-reproducible -o out/sbom.json $(BIN)/python

wheel: $(VENV)/installed-dev
	rm -rf out/kernels
	NUMBA_CACHE_DIR=$(CURDIR)/out/kernels $(BIN)/recon4 compile
	RECON4_COMPILED_KERNELS=$$(echo out/kernels/kernels_*) \
		$(BIN)/python -m pip wheel -q --no-deps --no-build-isolation --wheel-dir out .

clean:
	rm -rf $(VENV) $(TOOLS) demo site out .cache .ruff_cache .pytest_cache

$(VENV)/bin/python:
	@test -n '$(PYTHON)' || { echo 'recon4: needs Python 3.11, 3.12 or 3.13 (found: '"$$(python3 --version 2>&1)"'); name one with make PYTHON=…' >&2; exit 1; }
	.ci/apt run
	$(PYTHON) -m venv $(VENV)

# Goals for developers leave it to `bytecode` to compile what is installed.
$(VENV)/installed-run: $(VENV)/bin/python pyproject.toml requirements/run.lock
	$(BIN)/python $(LOCKED) requirements/run.lock $(if $(filter-out $(FOR_USERS),$(MAKECMDGOALS)),--no-compile)
	$(BIN)/python $(OURSELVES)
	@touch $@

# The same versions and others beside them: kernels and site are made meanwhile.
$(VENV)/installed-dev: $(VENV)/installed-run requirements/dev.lock
	.ci/apt run test
	$(BIN)/python $(LOCKED) requirements/dev.lock --no-compile
	@touch $@

$(TOOLS)/installed: requirements/tools.lock
	test -x $(TOOLS)/bin/python || $(PYTHON) -m venv $(TOOLS)
	$(TOOLS)/bin/python $(LOCKED) requirements/tools.lock
	@touch $@
