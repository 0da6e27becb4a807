"""Halving proves what holds, shows what does not, and says so when it cannot tell."""

from __future__ import annotations

import math

import pytest

from coord.verify import bisection, verify
from coord.verify.bisection import Least, descend, joined


def parabola(least):
    """f(t) = least + (t - 1)^2 with the bounds that halving needs."""

    def f(t):
        return least + (t - 1) ** 2

    def bound(a, b):
        return min(f(a), f(b)) - (b - a) ** 2 / 8 * 2, f((a + b) / 2), (a + b) / 2

    return bound


@pytest.mark.parametrize("least", [0.0, 1e-7, 3.0])
def test_a_function_that_holds_is_proved(least):
    """Also where it just touches, thanks to the margin in what is asked for."""
    assert descend(parabola(least), -1.0, 4.0, -1e-9, -1e-9) == Least(-1e-9, None, None)


@pytest.mark.parametrize("least", [-1e-7, -1e-6, -0.5])
def test_a_function_that_fails_is_shown_failing(least):
    """With a place, and the worst value to within the resolution."""
    found = descend(parabola(least), -1.0, 4.0, -1e-9, -1e-9)
    assert found.value == pytest.approx(least, abs=5e-7)
    assert least <= found.value < -1e-9
    assert found.value == least + (found.at - 1) ** 2


def test_a_miss_far_below_the_resolution_is_a_miss_all_the_same():
    """The resolution is for the least value; what is needed is needed to the last digit."""

    def exact(a, b):
        f = [-1e-7 + 1e6 * (t - 1) ** 2 for t in (a, b, (a + b) / 2)]
        return -1e-7 if a <= 1 <= b else min(f[:2]), f[2], (a + b) / 2

    assert descend(exact, -1.0, 4.0, -1e-9, -1e-9).at == pytest.approx(1, abs=1e-6)


def test_the_least_value_is_found_when_it_is_asked_for():
    """Below a best value known before, to within the resolution; not looked for above it."""
    assert descend(parabola(0.3), -1.0, 4.0, 0.0, 1.0).value == pytest.approx(0.3, abs=5e-7)
    assert descend(parabola(0.3), -1.0, 4.0, 0.0, 0.2) == Least(0.2, None, None)


def test_what_was_missed_before_is_only_looked_at_for_worse():
    """A best value below what is needed comes from the same thing: it has failed, and only how badly is open."""
    assert descend(parabola(-0.5), -1.0, 4.0, 0.0, -2.0) == Least(-2.0, None, None)
    assert descend(parabola(-0.5), -1.0, 4.0, 0.0, -0.1).value == pytest.approx(-0.5, abs=5e-7)


def test_bounds_that_never_come_together_stay_open():
    """Neither proved nor refuted; and a bound that is no number proves nothing."""
    assert descend(lambda a, b: (-1.0, 1.0, a), 0.0, 1.0, 0.0, 0.0).open is not None
    assert descend(lambda a, b: (math.nan, math.nan, a), 0.0, 1.0, 0.0, 0.0).open is not None


def test_joined_searches_keep_the_better_place_and_the_first_open_one():
    """The second one began with the value of the first."""
    assert joined(Least(1.0, 4.0), Least(1.0, None, 6.0)) == Least(1.0, 4.0, 6.0)
    assert joined(Least(1.0, 4.0, 5.0), Least(0.5, 7.0, 6.0)) == Least(0.5, 7.0, 5.0)


@pytest.mark.parametrize("parked", [False, True])
def test_what_is_left_open_is_not_certified(build, monkeypatch, parked):
    """With three halvings allowed, two robots close to each other in bends are neither certified nor refused."""

    def circling(name, radius):
        limits = {key: value * radius / 2 for key, value in build.limits.items()} | {"lateral_acceleration": 100.0}
        return build.robot(name, (0, -radius), pieces=[[radius, 1 / radius, 1 / radius]], limits=limits)

    pair = [circling("a", 2.0), circling("b", 2.6501)]
    if parked:  # beside a clothoid, nearest in the middle of it
        x, y = build.end_of([0.0, 0.0, 0.0], [[1.3, 0.0, 0.65]])
        angle = 0.65 * 1.3 / 2
        beside = (x + 0.65001 * math.sin(angle), y - 0.65001 * math.cos(angle))
        pair = [build.robot("a", (0, 0), pieces=[[2.0, 0.0, 1.0]], limits={"lateral_acceleration": 100.0})]
        pair.append(build.robot("b", beside, beside))
    data = build.data(build.plan(pair))
    assert verify(data).verdict == "certified"
    monkeypatch.setattr(bisection, "HALVINGS", 3)
    report = verify(data)
    assert report.verdict == "undecided"
    assert not report.certified
    (fault,) = report.faults
    assert (fault.code, fault.robots) == ("undecided", ("a", "b"))
