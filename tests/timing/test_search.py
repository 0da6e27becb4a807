"""Before or after whom: against brute force over all combinations."""

from __future__ import annotations

import pytest

from coord.model.options import Options
from coord.plan import plan as plan_with


def plan(problem):
    """These theorems are about the earliest arrival."""
    return plan_with(problem, Options(profile="fastest"))


@pytest.mark.parametrize("seed", range(12))
def test_no_combination_of_before_and_after_is_better_by_one_percent(lanes, could_arrive, seed):
    """Across three to five lanes at the worst moments: no tube lets "ego" be 1 % earlier; 2 % later some tube does."""
    found = plan(lanes(seed)).plan
    ego = found.robots[-1]
    assert not could_arrive(found, "ego", 0.99 * ego.arrival)
    assert could_arrive(found, "ego", 1.02 * ego.arrival)


@pytest.mark.parametrize("seed", range(8))
def test_at_a_crossroads_nobody_could_be_one_percent_earlier(crossroads, could_arrive, seed):
    """Every delayed robot, against those planned before it."""
    found = plan(crossroads(seed, 5)).plan
    if found is None:
        return
    for one in found.robots:
        if one.how != "alone":
            assert not could_arrive(found, one.robot.name, 0.99 * one.arrival)


@pytest.mark.parametrize("seed", [60, 162, 218])
def test_little_to_spare_before_somebody_needs_a_finer_grid_and_gets_it(lanes, could_arrive, seed):
    """Scenes on which one coarse grid found no motion through the gap, and 3 to 5 % were lost."""
    found = plan(lanes(seed)).plan
    assert not could_arrive(found, "ego", 0.985 * found.robots[-1].arrival)


@pytest.mark.parametrize("seed", [60, 218, 297])
def test_a_narrow_gap_before_somebody_is_used(lanes, could_arrive, seed):
    """Where passing before the first and after the next is possible with little to spare, it is found within 2 %."""
    found = plan(lanes(seed)).plan
    assert not could_arrive(found, "ego", 0.98 * found.robots[-1].arrival)
