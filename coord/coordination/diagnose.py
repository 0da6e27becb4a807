"""Sentences for people: why there is no plan."""

from __future__ import annotations

from collections.abc import Sequence

from coord.model.arrays import Point
from coord.model.result import BlockingArc, Diagnosis


def cycle(arcs: Sequence[BlockingArc]) -> Diagnosis:
    """Robots that all wait for each other."""
    names = tuple(dict.fromkeys(arc.first for arc in arcs))
    quoted = [f'"{name}"' for name in names]
    who = f"{', '.join(quoted[:-1])} and {quoted[-1]}"
    way = "stand in each other's way" if len(names) == 2 else "stand in each other's way, in a ring"
    text = (
        f"{who} {way}: {', and '.join(_reason(arc) for arc in arcs)}. "
        "Each would have to go before the other: on these paths no order brings all of them home one after the other."
    )
    remedy = "Move one of these starts or goals out of the other's way, or make room for a way round it."
    return Diagnosis("blocking-cycle", names, text, arcs[0].place, None, remedy)


def stuck(name: str, others: Sequence[str], place: Point) -> Diagnosis:
    """A robot for which no waiting helps: a defect of the order, said rather than hidden."""
    who = ", ".join(f'"{other}"' for other in others)
    text = f'"{name}" cannot pass {who}, however long it waits at its start {_at(place)}.'
    return Diagnosis("never-free", (name, *others), text, place, None, "Give it a higher priority.")


def time_is_up(planned: int, total: int) -> Diagnosis:
    """The time limit came before the first whole plan."""
    text = (
        f"The time limit ended the run when {planned} of {total} robots had a velocity profile: there is no plan yet."
    )
    return Diagnosis("time-limit", (), text, None, None, "Allow more time.")


def _reason(arc: BlockingArc) -> str:
    if arc.at == "start":
        return f'"{arc.first}" must leave its start {_at(arc.place)} before "{arc.then}" can pass there'
    return f'"{arc.first}" must have passed {_at(arc.place)} before "{arc.then}" parks there, at its goal'


def _at(place: Point | None) -> str:
    return "an unknown place" if place is None else f"({place[0]:.2f}, {place[1]:.2f})"
