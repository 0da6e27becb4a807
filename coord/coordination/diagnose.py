"""Sentences for people: why there is no plan, or why a path is not the quickest."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

from coord.model.arrays import Point
from coord.model.result import BlockingArc, Diagnosis

#: More robots than this are not named in a list.
_MOST_NAMES = 5

#: What helps robots in a ring: in general, where their own places are the reason, and where paths were to be kept.
_MOVE = "Move one of these starts or goals out of the other's way"
MAKE_ROOM: Final = f"{_MOVE}, or make room for a way round it."
MOVE: Final = f"{_MOVE}."
ALLOW_WAYS_ROUND: Final = f"Allow ways round, since the paths were to be kept. Otherwise: {MAKE_ROOM}"

#: [s] A smaller difference rounds to 0.00 s.
_SHOWN = 0.005


def cycle(
    arcs: Sequence[BlockingArc], why: Sequence[str] = (), remedy: str = MAKE_ROOM, not_together: str = ""
) -> Diagnosis:
    """Robots that all wait for each other; ``why`` : for each arc, the reason why no way round takes it away.

    ``not_together`` : a sentence on why they do not leave together.
    """
    names = tuple(dict.fromkeys(arc.first for arc in arcs))
    way = "stand in each other's way" if len(names) == 2 else "stand in each other's way, in a ring"
    notes = [f" ({note})" if note else "" for note in why or [""] * len(arcs)]
    reasons = [_reason(arc) + note for arc, note in zip(arcs, notes, strict=True)]
    text = (
        f"{_listed(names)} {way}: {', and '.join(reasons)}. "
        "Each would have to go before the other: on these paths no order brings all of them home one after the other. "
        f"{not_together}"
    ).strip()
    return Diagnosis("blocking-cycle", names, text, arcs[0].place, None, remedy)


#: Why robots of a ring did not leave together, where nothing proves that they cannot.
NO_DEADLINES: Final = (
    "To let them leave together was tried, too: no motions were found, which does not prove that there are none."
)


def cannot_pass(names: tuple[str, str], *, proved: bool) -> str:
    """Why robots of a ring cannot leave together: two of them have no room to pass each other."""
    pair = f'"{names[0]}" and "{names[1]}"'
    if proved:
        return f"Nor can they leave together: on these paths {pair} cannot pass each other, at whatever speeds."
    return f"Nor did they find room to leave together: {pair} come too near to pass each other on these paths."


def leaves_room(name: str, rivals: Sequence[str], extra: float) -> str:
    """A robot on a path beside that of others with which it has to leave together."""
    others = _and_more([f'"{rival}"' for rival in rivals])
    return f'"{name}" leaves {others} room to pass, {_cost(extra)}: they have to leave together.'


def handed_over(name: str, which: str) -> str:
    """Why no way round helps: one robot needs the place of another; ``which`` : its "start", "goal" or "via point"."""
    return f'no way round: the {which} of "{name}" is there'


def given(name: str) -> str:
    """Why no way round helps: the path is given."""
    return f'no way round: the path of "{name}" is given'


def no_way_round(name: str) -> str:
    """Why no way round helps: there is none."""
    return f'"{name}" finds no way round'


def rerouted(name: str, around: Sequence[tuple[str, str]], ring: Sequence[str], extra: float) -> str:
    """A robot on a longer path; ``around`` : names of others with "start" or "goal"; ``extra`` [s] alone."""
    places = _and_more([f'"{other}" at its {at}' for other, at in around])
    others = _and_more([f'"{other}"' for other in ring])
    return (
        f'"{name}" goes round {places}, {_cost(extra)}: on its quickest path, '
        f"it and {others} would all have to go before each other, in a ring."
    )


class Wait(NamedTuple):
    """A robot that stands at a place [m] since a time [s]."""

    name: str
    place: Point
    since: float


def jam(ring: Sequence[Wait], behind: int) -> Diagnosis:
    """Robots that wait for each other in a ring, each for the next; ``behind`` : how many more wait because of jams."""
    following = [*ring[1:], ring[0]]
    waits = [
        f'"{one.name}" waits at {_at(one.place)} since {one.since:.2f} s for "{other.name}"'
        for one, other in zip(ring, following, strict=True)
    ]
    more = f" {behind} more {'waits' if behind == 1 else 'wait'} behind." if behind else ""
    text = f"{', and '.join(waits)}: a jam. Each is to go before the one that waits for it, so none can move.{more}"
    last = max(ring, key=lambda one: one.since)
    names = tuple(one.name for one in ring)
    return Diagnosis("jam", names, text, last.place, last.since, "Let priorities decide: --method velocity (or stop).")


def time_is_up(planned: int, total: int) -> Diagnosis:
    """The time limit came before the first whole plan."""
    text = (
        f"The time limit ended the run when {planned} of {total} robots had a velocity profile: there is no plan yet."
    )
    return Diagnosis("time-limit", (), text, None, None, "Allow more time.")


def _cost(extra: float) -> str:
    return f"{extra:.2f} s more alone" if extra >= _SHOWN else "which costs it no time alone"


def _reason(arc: BlockingArc) -> str:
    if arc.at == "start":
        return f'"{arc.first}" must leave its start {_at(arc.place)} before "{arc.then}" can pass there'
    return f'"{arc.first}" must have passed {_at(arc.place)} before "{arc.then}" parks there, at its goal'


def _listed(names: Sequence[str]) -> str:
    quoted = [f'"{name}"' for name in names]
    return f"{', '.join(quoted[:-1])} and {quoted[-1]}"


def _and_more(words: Sequence[str]) -> str:
    """A list as a sentence has it; of a long one its beginning."""
    if len(words) > _MOST_NAMES:
        words = [*words[: _MOST_NAMES - 1], f"{len(words) - _MOST_NAMES + 1} more"]
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def _at(place: Point | None) -> str:
    return "an unknown place" if place is None else f"({place[0]:.2f}, {place[1]:.2f})"
