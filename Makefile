# Thin on purpose: each line is a command a person could type. Windows: the same lines are in the README.
PYTHON ?= python3
PORT ?= 8765
BIN = .venv/bin
INSTALL = $(BIN)/python -m pip install --quiet --disable-pip-version-check
STYLE = $(BIN)/ruff check && $(BIN)/ruff format --check
EXAMPLE = gh_examples/9.24-membrane

# Python keeps what it compiles: each of the many processes of a test run would compile it again
export PYTHONDONTWRITEBYTECODE :=

.PHONY: run test quick soak mutants floors bench bench-service bench-studio bench-design figures definitions screenshots docs site page studio lint clean
STUDIO = $(wildcard studio/*.* studio/src/*.* studio/src/*/*.*)

run: .venv/run
	@mkdir -p out
	@echo "Relaxing $(EXAMPLE) ..."
	$(BIN)/hookean relax $(EXAMPLE)/model.3dm --recipe $(EXAMPLE)/recipe.toml -o out/membrane.3dm \
		--picture out/membrane.png --csv out/membrane.csv
	@$(BIN)/hookean serve --port $(PORT)

# much of it waits for other processes: four workers keep two processors busy; what all of them use is made before,
# compiled tests and the documentation; types are checked beside it, and what is wrong with them is printed at the end
test: .venv/test
	$(STYLE)
	@nice -n 5 $(BIN)/mypy >.venv/types.log 2>&1 & types=$$!; \
	$(BIN)/python -m pytest --collect-only -q >/dev/null 2>&1 & collected=$$!; \
	$(BIN)/python hatch_build.py check; page=$$?; $(BIN)/python hatch_build.py site >/dev/null 2>&1; wait $$collected; \
	$(BIN)/python -m pytest -n 4 --dist loadfile --no-loadscope-reorder --durations 30; tests=$$?; \
	wait $$types; types=$$?; cat .venv/types.log; exit $$((tests || types || page))

quick: .venv/test # laws, core, files: what an edit of the engine breaks
	$(BIN)/python -m pytest -n 2 --dist loadfile -m "not slow" tests/laws tests/core tests/discretize tests/files

soak: .venv/test # without the extra oracle, as where it has no wheel, its tests are skipped
	-$(INSTALL) -e '.[oracle]'
	HOOKEAN_SOAK=1 $(BIN)/python -m pytest -n 2 --dist loadfile --cov --cov-report term
	$(MAKE) floors
	$(MAKE) mutants

floors: # laws, core and a server with the lowest versions of the dependencies that pyproject.toml states
	$(PYTHON) tests/floors.py .venv/floors

mutants: .venv/mutants # of all modules, or of some: make mutants MODULES="values/units.py forces/springs.py"
	$(BIN)/python tests/mutation/run.py $(MODULES)

bench: .venv/test # beside Kratos Multiphysics too, where it has a wheel
	-$(INSTALL) -e '.[oracle]'
	$(BIN)/python benchmarks/run.py $(if $(wildcard ../shared/bench),--shared ../shared/bench) \
		$(if $(BENCH),$(BENCH),--readme README.md)

bench-service: .venv/test
	$(BIN)/python benchmarks/service.py

bench-studio: .venv/test # the page with a large model, in Chromium
	$(BIN)/python benchmarks/studio.py

bench-design: .venv/test # against jax_fdm, in an environment of its own
	test -x .venv/jax_fdm/bin/python || python3 -m venv .venv/jax_fdm
	.venv/jax_fdm/bin/python -c "import jax_fdm" || .venv/jax_fdm/bin/pip install --quiet jax_fdm
	$(BIN)/python benchmarks/design.py --peer .venv/jax_fdm/bin/python

figures: .venv/run
	$(BIN)/hookean example --figures gh_examples

screenshots: .venv/test # of six figures in the studio, by chromium
	cd tests && ../$(BIN)/python -m studio.screenshots

definitions: .venv/test # of the examples, for people and programs that read XML
	$(BIN)/python gh_examples/build_definitions.py --xml

docs: .venv/run
	$(BIN)/python -c "from hookean.scene.catalogue import page; print(page(), end='')" > docs/forces.md
	$(BIN)/python -c "from hookean.scene.catalogue import write_exports; write_exports()"

site: .venv/site # the documentation, for people to browse: hookean serve shows it at /docs/
	$(BIN)/python docsite/build.py

page: .venv/test
	$(BIN)/python hatch_build.py

studio: # the page while one works on it, at localhost:5173, with the service that runs; needs Node
	cd studio && npm install && npm run dev

lint: .venv/test
	$(STYLE)
	$(BIN)/mypy
	$(BIN)/python hatch_build.py check

.venv/run: pyproject.toml hatch_build.py $(STUDIO) | .venv/environment
	@$(INSTALL) -e .
	@touch $@

.venv/environment:
	@$(PYTHON) -c "import sys; sys.exit(sys.version_info < (3, 11) and 'hookean needs Python 3.11 or newer: make PYTHON=python3.12')"
	@echo "Installing into .venv, a minute or two ..."
	@$(PYTHON) -m venv .venv
	@touch $@

# all at once, for each installation builds the page and compares versions; what of it is used is compiled at its import.
# uv takes a tenth of pip's time; pip does it where uv cannot
.venv/test: pyproject.toml hatch_build.py $(STUDIO) | .venv/environment
	@{ $(INSTALL) uv && UV_SYSTEM_CERTS=1 \
		UV_DEFAULT_INDEX="$${PIP_INDEX_URL:-$$($(BIN)/pip config get global.index-url 2>/dev/null)}" \
		$(BIN)/uv pip install --quiet --python $(BIN)/python -e '.[test]'; } >.venv/uv.log 2>&1 \
		|| $(INSTALL) --no-compile -e '.[test]'
	@touch .venv/run $@

.venv/site: .venv/run
	@echo "Installing what the documentation needs ..."
	@$(INSTALL) -e '.[site]'
	@touch $@

.venv/mutants: .venv/test
	@$(INSTALL) -e '.[mutants]'
	@touch $@

clean:
	rm -rf .venv out build dist studio/node_modules docsite/node_modules \
		server/hookean_server/page server/hookean_server/site
