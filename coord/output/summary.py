"""What a run tells: one object for programs, a short table and paragraphs for people."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Final

from coord.model.result import Clearance, Diagnosis, Plan, Result

if TYPE_CHECKING:
    from rich.console import RenderableType

    from coord.coordination.kept import Kept

#: [s] A smaller delay rounds to 0.00 s.
_LATE: Final = 0.005

#: More robots than this are not named one by one when a plan is extended.
_MOST_TOLD: Final = 20


def record(result: Result, seconds: float, extended: Kept | None = None) -> dict[str, object]:
    """The object that ``coord plan --json`` prints; ``seconds`` is the wall time of the whole command.

    The keys are always the same, and one more, "extended", where a plan was. Without a certified plan nobody has
    arrived, and every figure that a plan would have is None.
    """
    plan = certified_plan(result)
    more = {} if extended is None else {"extended": _kept_record(extended)}
    return {
        "certified": plan is not None,
        "robots": len(result.problem.robots),
        "arrived": len(plan.robots) if plan else 0,
        "sum_of_arrivals": plan.sum_of_arrivals if plan else None,
        "makespan": plan.makespan if plan else None,
        "sum_of_solo_arrivals": plan.sum_of_solo_arrivals if plan else None,
        "lower_bound": plan.lower_bound if plan else None,
        "optimality_gap": plan.optimality_gap if plan else None,
        "min_clearance": clearance_record(result.min_clearance) if plan else None,
        "seconds": seconds,
        "order": list(plan.order) if plan else None,
        "diagnoses": [_diagnosis_record(diagnosis) for diagnosis in result.diagnoses],
        **more,
    }


def diagnosis_record(result: Result) -> dict[str, object]:
    """The content of ``diagnosis.json``: for which problem there is no plan, and why."""
    return {
        "format": "coord-diagnosis/1",
        "problem": {"name": result.problem.name, "digest": result.problem.digest},
        "stopped": result.stopped,
        "diagnoses": [_diagnosis_record(diagnosis) for diagnosis in result.diagnoses],
    }


def clearance_record(clearance: Clearance | None) -> dict[str, object] | None:
    """The closest two robots come as an object: {"value": m, "robots": [a, b], "time": s}."""
    if clearance is None:
        return None
    return {"value": clearance.value, "robots": list(clearance.robots), "time": clearance.time}


def certified_plan(result: Result) -> Plan | None:
    """The plan of a result, if it may be handed out: a plan that is not certified is none."""
    return result.plan if result.certified else None


def table(result: Result, plan: Plan) -> RenderableType:
    """The figures of a certified plan for people, as a table of ``rich``."""
    from rich import box
    from rich.table import Table
    from rich.text import Text

    problem, count = result.problem, len(plan.robots)
    delay = (plan.sum_of_arrivals - plan.sum_of_solo_arrivals) / count
    latest = max(plan.robots, key=lambda robot: robot.arrival - robot.solo_arrival)
    largest = latest.arrival - latest.solo_arrival
    rows = [
        ("arrived", f"{count} of {len(problem.robots)}", "robots, at rest at their goals"),
        ("sum of arrivals", f"{plan.sum_of_arrivals:.2f} s", ""),
        ("makespan", f"{plan.makespan:.2f} s", "the last arrival"),
        ("sum alone", f"{plan.sum_of_solo_arrivals:.2f} s", "if every robot had the floor to itself"),
        ("mean delay", f"{delay:.2f} s", "a robot, for the others' sake"),
        ("largest delay", f"{largest:.2f} s", latest.robot.name if largest >= _LATE else "nobody is delayed"),
        ("lower bound", f"{plan.lower_bound:.2f} s", _bound_text(plan.lower_bound_by)),
        ("gap", f"{100 * plan.optimality_gap:.2f} %", _gap_text(plan.lower_bound_by)),
        ("least clearance", *_clearance_cells(result.min_clearance, problem.workspace.clearance)),
        ("planning time", f"{result.seconds:.2f} s", "planned and certified in this time"),
    ]
    title = Text(f"{problem.name or 'plan'}: certified", style="bold")
    result_table = Table(box=box.SIMPLE_HEAD, show_header=False, title=title, title_justify="left")
    result_table.add_column(no_wrap=True)
    result_table.add_column(justify="right", no_wrap=True)
    result_table.add_column(style="dim")
    for row in rows:
        result_table.add_row(*(Text(cell) for cell in row))  # Text: names in brackets are no markup
    return result_table


def kept_text(extended: Kept) -> str:
    """Who keeps its motion when a plan is extended, who is planned and why, and who is gone; for people."""
    names, count = [robot.name for robot in extended.problem.robots], len(extended.parts)
    told = [f'planned: "{names[i]}": {why}' for i, why in extended.anew.items()]
    told += [f'dropped: "{name}": the problem has it no more' for name in extended.dropped]
    told += [f'the priority of "{names[i]}" has changed: a matter for a full run' for i in extended.unheeded]
    more = [f"and {len(told) - _MOST_TOLD} more"] if len(told) > _MOST_TOLD else []
    return "\n".join([f"kept: {count} robot{'' if count == 1 else 's'}", *told[:_MOST_TOLD], *more])


def paragraphs(diagnoses: Iterable[Diagnosis]) -> str:
    """Diagnoses for people: one paragraph each, the remedy on a line of its own."""
    return "\n\n".join(_paragraph(diagnosis) for diagnosis in diagnoses)


def _paragraph(diagnosis: Diagnosis) -> str:
    place = ""
    if diagnosis.place is not None:
        place += f" at ({diagnosis.place[0]:.2f}, {diagnosis.place[1]:.2f}) m"
    if diagnosis.time is not None:
        place += f" at {diagnosis.time:.2f} s"
    robots = ", ".join(diagnosis.robots)
    head = f"{diagnosis.code}" + (f" ({robots}{place})" if robots else place)
    remedy = f"\n  Remedy: {diagnosis.remedy}" if diagnosis.remedy else ""
    return f"{head}: {diagnosis.text}{remedy}"


def _bound_text(by: str) -> str:
    if by == "solo_bound":
        return "on the sum: what all need if alone on their paths; ignores the others"
    return f"on the sum, on these paths ({by})"


def _gap_text(by: str) -> str:
    text = "of the sum: no other plan on these paths saves more"
    return f"{text}; some or all of it may be unavoidable" if by == "solo_bound" else text


def _clearance_cells(clearance: Clearance | None, required: float) -> tuple[str, str]:
    if clearance is None:
        return "-", "no two robots on the floor"
    first, second = clearance.robots
    # cut, not rounded: 0.0499 m must not read as the 0.050 m that are required
    value = int(clearance.value * 1e4 + 1e-4) / 1e4
    return f"{value:.4f} m", f"{first} and {second} at {clearance.time:.2f} s; required {required:g} m"


def _kept_record(extended: Kept) -> dict[str, object]:
    names = [robot.name for robot in extended.problem.robots]
    return {
        "kept": [names[i] for i in sorted(extended.parts)],
        "planned": [{"robot": names[i], "reason": why} for i, why in extended.anew.items()],
        "dropped": list(extended.dropped),
        "priority_unheeded": [names[i] for i in extended.unheeded],
    }


def _diagnosis_record(diagnosis: Diagnosis) -> dict[str, object]:
    return {
        "code": diagnosis.code,
        "robots": list(diagnosis.robots),
        "place": None if diagnosis.place is None else list(diagnosis.place),
        "time": diagnosis.time,
        "text": diagnosis.text,
        "remedy": diagnosis.remedy,
    }
