"""Options are kept or refused, never ignored."""

from __future__ import annotations

from coord.errors import CoordError
from coord.model.footprint import Footprint
from coord.model.obstacle import Circle
from coord.model.options import Options
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.plan import plan

LIMITS = Limits(1.0, 0.5, 0.5, 1.0, 0.5)
CROSSING = Problem(
    "crossing",
    Workspace((-20.0, -20.0, 20.0, 20.0), 0.05),
    (
        Robot("a", Footprint(0.3), LIMITS, (-9.0, 0.0), (9.0, 0.0)),
        Robot("b", Footprint(0.3), LIMITS, (0.0, -9.0), (0.0, 9.0)),
    ),
)


def test_a_time_limit_that_is_up_before_there_is_a_plan_ends_the_run():
    """A nanosecond is too little: no plan and a diagnosis, or a refusal, but no plan as if nothing had been said."""
    try:
        result = plan(CROSSING, Options(time_limit=1e-9))
    except CoordError:
        return
    assert result.plan is None
    assert [diagnosis.code for diagnosis in result.diagnoses] == ["time-limit"]


def test_progress_is_told_stage_by_stage():
    """Each stage counts up to its total, stages follow each other, and what is told does not change the plan."""
    seen = []
    told = plan(CROSSING, progress=lambda stage, done, total: seen.append((stage, done, total)))
    assert told.document == plan(CROSSING).document
    stages = list(dict.fromkeys(stage for stage, _, _ in seen))
    assert [stage for stage, _, _ in seen] == sorted((stage for stage, _, _ in seen), key=stages.index)
    for stage in stages:
        counts = [(done, total) for name, done, total in seen if name == stage]
        assert [done for done, _ in counts] == sorted({done for done, _ in counts})
        assert counts[-1][0] == counts[-1][1]


def test_both_shapes_are_certified_and_the_fitted_one_is_no_slower():
    """Round an obstacle, sums of arrivals alone: fitted at most taut."""
    problem = Problem("column", CROSSING.workspace, CROSSING.robots, (Circle("c", (4.0, 0.3), 1.0),))
    taut, fitted = plan(problem, Options(shape="taut")), plan(problem, Options(shape="fitted"))
    assert taut.certified
    assert fitted.certified
    assert fitted.plan.sum_of_solo_arrivals <= taut.plan.sum_of_solo_arrivals + 1e-6
