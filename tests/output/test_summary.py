import io
from collections.abc import Callable
from dataclasses import replace

from rich.console import Console

from coord.model.result import Clearance, Plan, Result
from coord.output.summary import paragraphs, record, table

KEYS = [
    "certified",
    "robots",
    "arrived",
    "sum_of_arrivals",
    "makespan",
    "sum_of_solo_arrivals",
    "lower_bound",
    "optimality_gap",
    "min_clearance",
    "seconds",
    "order",
    "diagnoses",
]


def shown(result: Result, plan: Plan) -> str:
    stream = io.StringIO()
    Console(file=stream, width=120).print(table(result, plan))
    return stream.getvalue()


def test_the_object_has_exactly_the_keys_of_the_contract_and_their_values(
    sample: Plan, result_of: Callable[..., Result]
):
    """Other programs rely on them."""
    found = record(result_of(sample), 1.5)
    assert list(found) == KEYS
    assert found["certified"] is True
    assert (found["robots"], found["arrived"], found["seconds"]) == (3, 3, 1.5)
    assert found["sum_of_arrivals"] == sum(robot.arrival for robot in sample.robots)
    assert found["makespan"] == 20.0
    assert found["sum_of_solo_arrivals"] == sum(robot.solo_arrival for robot in sample.robots)
    assert found["optimality_gap"] == (sample.sum_of_arrivals - sample.lower_bound) / sample.sum_of_arrivals
    assert found["min_clearance"] == {"value": 0.05 + 1e-7, "robots": ["red", "blue"], "time": 6.25}
    assert found["order"] == list(sample.order)
    assert found["diagnoses"] == []


def test_without_a_certified_plan_every_figure_is_null_and_none_is_left_out(
    sample: Plan, failure: Result, result_of: Callable[..., Result]
):
    """Neither without a plan nor with one that the checker refused is there a figure to hand out."""
    for result in (failure, result_of(sample, certified=False)):
        found = record(result, 1.5)
        assert list(found) == KEYS
        assert (found["certified"], found["robots"], found["arrived"], found["seconds"]) == (False, 3, 0, 1.5)
        figures = set(KEYS) - {"certified", "robots", "arrived", "seconds", "diagnoses"}
        assert {found[key] for key in figures} == {None}
    assert record(failure, 1.5)["diagnoses"] == [
        {
            "code": "no_way",
            "robots": ["red"],
            "place": [2.5, 1.75],
            "time": None,
            "text": failure.diagnoses[0].text,
            "remedy": "make the lane 0.1 m wider",
        }
    ]


def test_one_robot_has_no_least_clearance(parked: Plan, result_of: Callable[..., Result]):
    """There is no pair whose distance could be told."""
    assert record(result_of(parked), 0.0)["min_clearance"] is None
    assert "no two robots" in shown(result_of(parked), parked)


def test_the_table_says_every_figure_with_its_unit(sample: Plan, result_of: Callable[..., Result]):
    """45.69 s in all, 4.50 s of delay for three robots, all of it blue's, and the rest."""
    text = shown(replace(result_of(sample), seconds=1.234), sample)
    expected = ["3 of 3", f"{sample.sum_of_arrivals:.2f} s", "20.00 s", "1.50 s", "0.0500 m", "red and blue at 6.25 s"]
    expected += [f"{sample.lower_bound:.2f} s", f"{100 * sample.optimality_gap:.2f} %", "1.23 s", "single robots"]
    assert [part for part in expected if part not in text] == []
    (largest,) = (line for line in text.splitlines() if "largest delay" in line)
    assert largest.split()[2:] == ["4.50", "s", "blue"]


def test_a_bound_from_single_robots_says_what_it_leaves_out(sample: Plan, result_of: Callable[..., Result]):
    """So that a gap of 20 % does not read as a bad plan."""
    alone = replace(sample, lower_bound_by="solo_bound")
    text = shown(result_of(alone), alone)
    assert "ignores the others" in text
    assert "unavoidable" in text
    assert "solo_bound" not in text


def test_where_nobody_is_delayed_nobody_is_named(parked: Plan, result_of: Callable[..., Result]):
    """The largest of no delays belongs to nobody."""
    assert "nobody is delayed" in shown(result_of(parked), parked)


def test_a_clearance_is_never_shown_larger_than_it_is(sample: Plan, result_of: Callable[..., Result]):
    """0.04999 m is less than the 0.05 m required, and the table says so."""
    result = result_of(sample)
    close = Result(result.problem, sample, True, min_clearance=Clearance(0.04999, ("red", "blue"), 6.25))
    assert "0.0499 m" in shown(close, sample)


def test_names_in_brackets_are_no_markup(sample: Plan, result_of: Callable[..., Result]):
    """A robot may be called [bold]."""
    result = result_of(sample)
    odd = Result(result.problem, sample, True, min_clearance=Clearance(0.1, ("red", sample.order[2]), 6.25))
    assert 'grün, "3" [bold]' in shown(odd, sample)


def test_a_diagnosis_is_a_paragraph_with_who_where_why_and_what_helps(failure: Result):
    """Everything that is known stands in it."""
    text = paragraphs(failure.diagnoses)
    assert text.startswith("no_way (red at (2.50, 1.75) m): no way leads")
    assert text.endswith("Remedy: make the lane 0.1 m wider")
    assert paragraphs(failure.diagnoses * 2) == f"{text}\n\n{text}"
