# One command each. On a fresh machine: Python 3.11+ (as python3), a C++20 compiler and make are enough.
#
#   make test TEST=pattern            only the tests that match (pytest's -k)
#   make test ARGS="-x --durations=5" any other arguments of pytest
#   CMAKE_ARGS="-DRAYBOUND_ARCH=x86-64-v3" make build

.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
SHELL := /bin/bash

PYTHON ?= python3
VENV := .venv
PY := $(VENV)/bin/python
PIP := $(PY) -m pip --disable-pip-version-check
VENV_PYTHON := $(CURDIR)/$(PY)
TEST ?=
ARGS ?=
PYTEST_ARGS = $(if $(TEST),-k "$(TEST)") $(ARGS)

# Scenes to measure and test with, and the yardstick's source: read where they are.
ifndef RAYBOUND_DATA
ifneq ($(wildcard ../shared/data/.),)
export RAYBOUND_DATA := $(abspath ../shared/data)
endif
endif
ifndef RAYBOUND_BENCH
ifneq ($(wildcard ../shared/bench/.),)
export RAYBOUND_BENCH := $(abspath ../shared/bench)
endif
endif

.PHONY: help build fmt lint test notebooks soak bench bench-exact bench-embree bench-error bench-numbers demo wheel levels sanitize sabotage clean

help: ## List the targets
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "make %-13s %s\n", $$1, $$2 }' $(firstword $(MAKEFILE_LIST))

# --- What is installed, and when again -----------------------------------------------------------------------------------

# Folders are listed too: their time changes when a file is added or removed.
CPP_FILES := $(shell find cpp -type d -o -name '*.cpp' -o -name '*.h' 2>/dev/null)
CPP_STAMPS := pyproject.toml CMakeLists.txt $(CPP_FILES)

# $(call listed,KEY) are the requirements under a key of pyproject.toml, one a line.
listed = $(PY) -c 'import functools, sys, tomllib; \
	table = tomllib.load(open("pyproject.toml", "rb")); \
	print(*functools.reduce(lambda t, k: t[k], sys.argv[1].split("."), table), sep="\n")' $(1)

# Reads requirements from a pipe, on purpose: the package itself must not be looked up.
INSTALL_LIST = $(PIP) install -qq -r /dev/stdin

# Build tools live in the environment, so that the headers' path stays the same and a rebuild is incremental.
$(VENV)/stamp-tools: pyproject.toml
	@$(PYTHON) -c 'import sys; v = sys.version.split()[0]; sys.version_info >= (3, 11) or sys.exit("raybound needs Python 3.11 or newer, got " + v)'
	test -x $(PY) || $(PYTHON) -m venv $(VENV)
	@echo "installing the build tools and dependencies into $(VENV)"
	@set -o pipefail; { $(call listed,build-system.requires); echo cmake; echo ninja; $(call listed,project.dependencies); } | $(INSTALL_LIST)
	@touch $@

$(VENV)/stamp-build: $(VENV)/stamp-tools $(CPP_STAMPS)
	@echo "building raybound"
	@$(PIP) install --quiet --no-build-isolation --no-deps --config-settings=cmake.define.RAYBOUND_WERROR=ON --editable .
	@touch $@

$(VENV)/stamp-%: $(VENV)/stamp-tools
	@echo "installing what 'raybound[$*]' needs"
	@set -o pipefail; $(call listed,project.optional-dependencies.$*) | $(INSTALL_LIST)
	@touch $@

build: $(VENV)/stamp-build ## Compile what has changed, installed in .venv as an editable package

# --- Everyday ------------------------------------------------------------------------------------------------------------

fmt: $(VENV)/stamp-lint ## Format and sort imports, in C++ and Python
	$(PY) -m ruff check --fix --exit-zero --quiet .
	$(PY) -m ruff format .
	find cpp -name '*.cpp' -o -name '*.h' | xargs -r $(VENV)/bin/clang-format -i

lint: $(VENV)/stamp-build $(VENV)/stamp-lint $(VENV)/stamp-test ## Check format, types, the stub and the order of layers
	$(PY) -m ruff check .
	$(PY) -m ruff format --check .
	find cpp -name '*.cpp' -o -name '*.h' | xargs -r $(VENV)/bin/clang-format --dry-run -Werror
	$(PY) .ci/check_layers.py
	$(PY) -m mypy --strict python/raybound tests/python/typed_script.py
	$(PY) .ci/check_stub.py

test: $(VENV)/stamp-build $(VENV)/stamp-test ## Run the tests and notebooks; TEST=pattern selects, ARGS=... adds arguments
	$(PY) -m pytest --nbmake --nbmake-timeout=600 $(PYTEST_ARGS)

notebooks: $(VENV)/stamp-build $(VENV)/stamp-test ## Run the notebooks
	$(PY) -m pytest --nbmake --nbmake-timeout=600 notebooks $(ARGS)

soak: $(VENV)/stamp-build $(VENV)/stamp-test ## Run the long searches for failures
	$(PY) -m pytest -m soak -o timeout=3000 $(PYTEST_ARGS)

bench: $(VENV)/stamp-build $(VENV)/stamp-mesh ## Measure the base tracer's speed; ARGS=--readme renews the README's tables
	$(PY) -m raybound bench base $(ARGS)

bench-exact: $(VENV)/stamp-build $(VENV)/stamp-mesh $(VENV)/stamp-plot ## Measure frames from kept lists beside the base tracer's
	$(PY) -m raybound bench exact $(ARGS)

bench-embree: $(VENV)/stamp-build $(VENV)/stamp-mesh $(VENV)/stamp-bench ## Measure speed beside Embree's (needs libembree-dev)
	$(PY) -m raybound bench embree $(ARGS)

bench-error: $(VENV)/stamp-build $(VENV)/stamp-plot ## Measure speed against error on hard cases; ARGS="--plot error.png" draws it
	$(PY) -m raybound bench error $(ARGS)

bench-numbers: $(VENV)/stamp-build ## Measure intervals and Taylor models beside plain double; ARGS=--readme renews the table
	$(PY) -m raybound bench numbers $(ARGS)

demo: $(VENV)/stamp-build ## Render the walk-through to ./out
	$(PY) -m raybound demo $(ARGS)

# --- Variants: other builds of the same sources, each installed under build/NAME beside .venv's packages --------------------

# $(call environment,NAME,WHAT,OPTIONS): pip installs WHAT into build/NAME/site with its options, and build/NAME/venv has
# a Python that finds that module first and then the dependencies in .venv (whose editable raybound it does not see: a
# path file is not followed a second time).
define environment
	@rm -rf build/$(1)/site build/$(1)/venv
	@$(PIP) install --quiet --no-deps --target build/$(1)/site $(3) $(2)
	@$(PY) -m venv --without-pip build/$(1)/venv
	@site() { "$$1" -c 'import sysconfig; print(sysconfig.get_path("platlib"))'; }; \
		printf '%s\n' '$(CURDIR)/build/$(1)/site' "$$(site $(PY))" > "$$(site build/$(1)/venv/bin/python)/variant.pth"
endef

# $(call variant,NAME,CMAKE DEFINITIONS): the sources built in build/NAME/cmake and installed as above.
define variant
	@echo "building the variant $(1)"
	@mkdir -p build/$(1)
	$(call environment,$(1),.,--no-build-isolation --config-settings=install.strip=false \
		--config-settings=build-dir=build/$(1)/cmake $(foreach d,$(2),--config-settings=cmake.define.$(d)))
endef

wheel: $(VENV)/stamp-tools ## Build a wheel that holds every instruction level into ./dist
	@echo "building the module for every instruction level"
	@rm -f dist/raybound-*.whl
	@$(PIP) wheel --quiet --no-build-isolation --no-deps --wheel-dir dist --config-settings=build-dir=build/levels/cmake \
		--config-settings=cmake.define.RAYBOUND_LEVELS=all --config-settings=cmake.define.RAYBOUND_WERROR=ON .
	@ls -s -h dist/raybound-*.whl

levels: wheel $(VENV)/stamp-test ## Build that wheel and compare the levels' pictures and hits, byte for byte
	$(call environment,levels,dist/raybound-*.whl)
	build/levels/venv/bin/python -m pytest -p no:cacheprovider tests/python/test_levels.py $(PYTEST_ARGS)

# Sanitizers come with g++; their libraries must be loaded before Python's, and libstdc++ with them for exceptions.
SANITIZE_CXX ?= g++
SANITIZE_PYTEST = -m pytest -p no:cacheprovider -o timeout=3000
sanitizer_libraries = $(foreach l,$(1) libstdc++.so,$(shell $(SANITIZE_CXX) -print-file-name=$(l)))
# Reports go to files, as pytest captures what is printed.
# Linux may lay out memory in a way that older thread sanitizers do not know; `setarch -R` turns that off where it is allowed.
NO_ASLR := $(shell setarch -R true 2>/dev/null && echo setarch -R)

sanitize: export CXX := $(SANITIZE_CXX)
sanitize: $(VENV)/stamp-tools $(VENV)/stamp-test ## Run the tests under the address, undefined-behaviour and thread sanitizers
	$(call variant,sanitize-address,RAYBOUND_SANITIZE=address$(comma)undefined)
	@rm -f build/sanitize-address/report.*
	LD_PRELOAD="$(call sanitizer_libraries,libasan.so)" PYTHONMALLOC=malloc \
		ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1:log_path=$(CURDIR)/build/sanitize-address/report \
		UBSAN_OPTIONS=print_stacktrace=1:log_path=$(CURDIR)/build/sanitize-address/report \
		build/sanitize-address/venv/bin/python $(SANITIZE_PYTEST) $(PYTEST_ARGS) \
		|| { cat build/sanitize-address/report.* 2>/dev/null; exit 1; }
	$(call variant,sanitize-thread,RAYBOUND_SANITIZE=thread)
	@rm -f build/sanitize-thread/report.*
	LD_PRELOAD="$(call sanitizer_libraries,libtsan.so)" OPENBLAS_NUM_THREADS=1 \
		TSAN_OPTIONS=halt_on_error=1:ignore_noninstrumented_modules=1:log_path=$(CURDIR)/build/sanitize-thread/report \
		$(NO_ASLR) build/sanitize-thread/venv/bin/python $(SANITIZE_PYTEST) -k thread $(ARGS) \
		|| { cat build/sanitize-thread/report.* 2>/dev/null; exit 1; }

comma := ,

# Red is wanted: pytest's exit code 1, "tests were run and some failed". A suite that is green, or cannot run, is an error.
SABOTAGES ?= rounding predicate certificate invalidation

sabotage: $(VENV)/stamp-tools $(VENV)/stamp-test $(SABOTAGES:%=sabotage-%) ## Break one thing at a time and expect the tests to fail

sabotage-%: $(VENV)/stamp-tools $(VENV)/stamp-test
	$(call variant,$@,RAYBOUND_SABOTAGE=$*)
	@build/$@/venv/bin/python -m pytest -p no:cacheprovider -x --tb=line $(PYTEST_ARGS); code=$$?; \
	case $$code in \
		0) echo "sabotage '$*': the tests did not notice it"; exit 1;; \
		1) echo "sabotage '$*': noticed";; \
		*) echo "sabotage '$*': the tests could not run (pytest's exit code $$code)"; exit 1;; \
	esac

clean: ## Remove .venv, build folders, caches and ./out
	rm -rf $(VENV) build dist out .pytest_cache .mypy_cache .ruff_cache .hypothesis
	find . -name __pycache__ -type d -not -path './.git/*' -prune -exec rm -rf {} +
