"""What the checker says: a verdict, the faults found, and how close any two robots come."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass

from coord.verify import tolerances

Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that is wrong with a plan, or that could not be decided.

    Parameters
    ----------
    code : one word for programs; "undecided" marks what was neither proved nor refuted.
    text : a sentence with names, place, time, the value with its unit, and the rule.
    robots : names of those concerned.
    place, time : [m] and [s], None where there is none.
    """

    code: str
    text: str
    robots: tuple[str, ...] = ()
    place: Point | None = None
    time: float | None = None


@dataclass(frozen=True, slots=True)
class Clearance:
    """The least distance between two footprints over all pairs and times: value [m], who, when [s]."""

    value: float
    robots: tuple[str, str]
    time: float


@dataclass(frozen=True, slots=True)
class Report:
    """The checker's answer.

    Parameters
    ----------
    verdict : "certified", "refused", "undecided" or "malformed"; only the first one vouches for the plan.
    faults : the findings, the first 20 at most; empty if and only if the plan is certified.
    min_clearance : None with a single robot, or where the motions are too broken to say.
    robots : how many robots the plan has.
    """

    verdict: str
    faults: tuple[Finding, ...] = ()
    min_clearance: Clearance | None = None
    robots: int = 0

    @property
    def certified(self) -> bool:
        """Whether everything was proved."""
        return self.verdict == "certified"

    def __str__(self) -> str:
        lines = [f"{self.verdict}: {self.robots} robot{'' if self.robots == 1 else 's'}"]
        lines += [f"  {fault.code}: {fault.text}" for fault in self.faults]
        if self.min_clearance is not None:
            first, second = self.min_clearance.robots
            value, time = self.min_clearance.value, self.min_clearance.time
            lines.append(f"  least clearance {value:.6f} m, {who(first)} and {who(second)} at t = {time:.3f} s")
        return "\n".join(lines)


class Findings:
    """Collects findings up to a sensible number; ``full`` says that looking for more is pointless."""

    def __init__(self) -> None:
        self._found: list[Finding] = []

    def add(
        self, code: str, text: str, robots: Iterable[str] = (), place: Point | None = None, time: float | None = None
    ) -> None:
        """Keep one more finding, unless there are enough."""
        if not self.full:
            self._found.append(Finding(code, text, tuple(robots), place, time))

    @property
    def full(self) -> bool:
        """Whether as many findings are kept as are ever reported."""
        return len(self._found) >= tolerances.FINDINGS

    @property
    def found(self) -> tuple[Finding, ...]:
        """The findings so far, in the order of the checks."""
        return tuple(self._found)

    @property
    def verdict(self) -> str:
        """The verdict that follows from the findings of a well-formed plan."""
        if any(finding.code != "undecided" for finding in self._found):
            return "refused"
        return "undecided" if self._found else "certified"


def who(name: str) -> str:
    """A name in quotes, with control characters made visible."""
    return json.dumps(name, ensure_ascii=False)


def at(place: Point) -> str:
    """A place in words."""
    return f"({place[0]:.6g}, {place[1]:.6g}) m"
