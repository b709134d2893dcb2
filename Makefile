# Everything a newcomer needs: `make run`, `make test`. Each target sets up what it uses, once.

PYTHON ?= python3
BIN := .venv/bin
# Rewritten assertions are kept: without them every worker compiles all tests anew, a tenth of the fast tests' time.
PYTEST := env -u PYTHONDONTWRITEBYTECODE $(BIN)/python -m pytest -n 2 --dist worksteal
STAMP := .venv/.installed

.PHONY: setup setup-fem setup-browser setup-docs run test test-fast gates lint bench peers report docs notebooks validation gallery wheel clean golden mutants reproduce examples

setup: $(STAMP)

$(STAMP): pyproject.toml .ci/constraints.txt .ci/setup
	PYTHON=$(PYTHON) .ci/setup
	@touch $(STAMP)

# Debian's dolfinx lives with Debian's python; only the finite-element tests and reports need it.
setup-fem:
	bash fem_reference/setup.sh

# A headless browser, for the tests that look at the reports.
setup-browser:
	.ci/apt chromium

# Sphinx and its extensions, for `make docs`.
setup-docs: setup .venv/.docs

.venv/.docs: pyproject.toml .ci/constraints.txt
	$(BIN)/uv pip install -q --python $(BIN)/python --constraint .ci/constraints.txt --requirement pyproject.toml --extra docs
	@touch $@

run: setup
	$(BIN)/bem run rough-contact

# All tests but the gates of `bem verify`, which are as long as half of the others: `make gates` runs those.
# Of some long tests every commit draws a part of the cases; TEST_CASES=all runs all of them.
test: setup setup-fem setup-browser setup-docs
	$(PYTEST) -m "not gate"

gates: setup
	$(PYTEST) -m gate tests/verification

test-fast: setup
	$(PYTEST) -m "not slow and not fem and not browser"

# What the tests catch: chosen one-line slips in the physics (tests/mutants/seeds), each in a scratch copy of the tree
# against the tests that guard its room. Outcomes go to reports/results/mutants.json, from which the verification report
# shows them; an interrupted run goes on where it was. A mutant whose text is gone fails the run: carry it along, or
# drop it from the list. After a change of the tests: make mutants MUTANTS="--renew". Others, see --help:
#   MUTANTS="--only contact --suite full"    a room (or a file, or words of the slip); survivors on the slow tests, too
#   MUTANTS="--sample 40 --seed 2"           forty of them, drawn
#   MUTANTS="--loops without"                only files without compiled loops: seconds each, those with take minutes
#   MUTANTS="--check"                        only look whether every mutant still has its text
mutants: setup
	$(BIN)/python -m tests.mutants $(MUTANTS)

lint: setup
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/numpydoc lint $$(git ls-files 'bem/*.py')

# Renews the stored figures of tests/golden and prints what moved beyond its tolerance. The commit must say why it moved.
# One group only: make golden GROUP=films, one case of it: CASE=name. How far figures follow rounding: $(BIN)/python -m reports.golden --spread.
golden: setup
	$(BIN)/python -m reports.golden $(if $(GROUP),--only $(GROUP)) $(if $(CASE),--case $(CASE))

bench: setup
	$(BIN)/bem bench

# The cases of `bem bench` beside other codes (tamaas, ContactMechanics, ASPHER, slippy; installed into .venv-peers), appended to
# the history that the performance report shows. Hours; PEERS=--quick for a short look. Two runs of the history side by side:
# $(BIN)/python -m reports.benchmarks --compare -2 -1
peers: setup
	$(BIN)/python -m reports.benchmarks --peers $(PEERS)

report: setup
	$(BIN)/python -m reports --pdf

# The documentation as a site: reports/site/index.html. It is built without a network; warnings are errors.
docs: setup setup-docs
	rm -rf reports/site reports/jupyter_execute
	$(BIN)/python -m sphinx -q -W --keep-going -b html -d reports/site/.doctrees reports/docs reports/site
	$(BIN)/python -m reports validation performance --out reports/site/reports >/dev/null
	@echo reports/site/index.html

# Run what the documentation shows again and store its numbers and pictures. One worked example only: make examples TASK=stribeck-curve
examples: setup
	$(BIN)/python -m reports.docs.tasks $(TASK)
	$(if $(TASK),,$(BIN)/python -m reports.docs.kind_pictures)

# Run the notebooks in place and store what their cells show.
notebooks: setup
	VIRTUAL_ENV=.venv $(BIN)/uv run --no-project --active --with nbconvert --with ipykernel jupyter nbconvert \
		--to notebook --execute --inplace --ExecutePreprocessor.record_timing=False reports/docs/notebooks/*.ipynb

# Runs what the validation report lacks: not stored, of another scene text, or failed to reproduce. About an hour; goes on where
# it was interrupted.
validation: setup
	$(BIN)/python -m reports validation --renew needed

# Computes a row of every stored result again and compares it within its bar: ten minutes of processor time.
reproduce: setup
	$(BIN)/python -m reports.reproduce

gallery: setup
	$(BIN)/python -m reports gallery

wheel: setup
	$(BIN)/python -m build --installer uv --outdir dist .

clean:
	rm -rf .venv .venv-fem build dist .pytest_cache .mypy_cache .ruff_cache .import_linter_cache
