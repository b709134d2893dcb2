"""What is computed now against what is stored: figures, counts of work and peaks of memory; see `reports.golden`."""

import pytest
from golden_runs import record_of, shared_folder

from reports.golden import memory
from reports.golden.groups import GROUPS
from reports.golden.stored import differences, mean_differences, stored
from reports.golden.tolerances import MEMORY

CASES = [(group, case) for group in GROUPS for case in GROUPS[group]()]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return shared_folder(tmp_path_factory)


@pytest.mark.parametrize(("group", "case"), CASES)
def test_figures_are_those_stored(folder, group, case):
    now, _ = record_of(folder, group, case)
    before = stored(group)
    assert case in before, f"nothing stored of {group}/{case}: python -m reports.golden --only {group}"
    apart = differences(group, case, before[case], now)
    assert not apart, "\n".join(str(one) for one in apart)


@pytest.mark.slow
@pytest.mark.parametrize("group", GROUPS)
def test_counts_of_a_group_are_those_stored(folder, group):
    now = {case: record_of(folder, group, case)[0] for case in GROUPS[group]()}
    apart = mean_differences(stored(group), now)
    assert not apart, "\n".join(str(one) for one in apart)


@pytest.mark.parametrize("group", GROUPS)
def test_nothing_is_stored_of_cases_that_are_gone(group):
    assert set(stored(group)) <= set(GROUPS[group]())


@pytest.mark.parametrize("case", memory.CASES)
def test_peak_of_memory_is_that_stored(case):
    assert memory.peak_in_process(case) == pytest.approx(memory.stored()[case], rel=MEMORY)
