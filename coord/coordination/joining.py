"""Sentences for people about robots that join a plan: why one cannot, or takes another way than alone."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from coord.model.arrays import Point
from coord.model.result import Diagnosis

#: What helps robots for which somebody would have to make way, or who would have to join together.
ANEW: Final = "Plan all robots anew, without extending"

#: More places than this are not named in a list.
_MOST_NAMED = 5


def gone_round(name: str, around: Sequence[tuple[str, str]], extra: float) -> str:
    """A robot on a longer path; ``around`` : names of others with "start" or "goal"; ``extra`` [s] alone."""
    places = _listed([f'"{other}" at its {at}' for other, at in around])
    return f'"{name}" goes round {places}, {extra:.2f} s more alone: those that rest there keep their motion.'


def gone_aside(name: str, passers: Sequence[tuple[str, float]], around: Sequence[tuple[str, str]], extra: float) -> str:
    """A robot that first goes out of the way; ``passers`` : names of those who pass its start, and when [s]."""
    told = _listed([f'"{other}", which passes its start at {when:.2f} s' for other, when in passers])
    places = _listed([f'"{other}" at its {at}' for other, at in around]) if around else ""
    more = f", and goes round {places}" if around else ""
    return f'"{name}" first goes aside for {told}{more}, {extra:.2f} s more alone: those others keep their motion.'


def cannot_join(name: str, reasons: Sequence[tuple[str, str, Point, float]], *, may_go_round: bool = True) -> Diagnosis:
    """A robot that cannot be planned after all others of a plan.

    ``reasons`` : who would have to make way, "start" or "goal" of which of the two is in the way, where [m], when [s].
    """
    told = []
    for other, at, (x, y), when in reasons:
        if at == "start":
            told.append(f'"{other}" passes its start ({x:.2f}, {y:.2f}) at {when:.2f} s, and it cannot leave in time')
        else:
            away = "nor finds a way round" if may_go_round else "nor may leave its path"
            parks = f'"{other}" parks on its way at ({x:.2f}, {y:.2f}) at {when:.2f} s'
            told.append(f"{parks}; it neither passes before {away}")
    text = f'"{name}" cannot join the plan, whose other robots keep their motion: {_listed(told)}.'
    remedy = f'{ANEW}: then "{name}" can go first. Or move its start or goal.'
    names = (name, *dict.fromkeys(other for other, *_ in reasons))
    _, _, place, when = reasons[0]
    return Diagnosis("cannot-join", names, text, place, when, remedy)


def _listed(words: Sequence[str]) -> str:
    """A list as a sentence has it; of a long one its beginning."""
    shown = list(words[:_MOST_NAMED])
    if len(words) > _MOST_NAMED:
        shown[-1] = f"{len(words) - _MOST_NAMED + 1} more"
    return shown[0] if len(shown) == 1 else f"{', '.join(shown[:-1])} and {shown[-1]}"
