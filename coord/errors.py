"""What can go wrong, as values: every error says who, what, which value, which rule and what to do."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from coord.model.result import Diagnosis


class CoordError(Exception):
    """Base of all errors that coord raises on purpose."""


class InvalidValueError(CoordError, ValueError):
    """A value object was given numbers that break its rules.

    Parameters
    ----------
    faults : (field, sentence) pairs, one for each broken rule; all of them, not only the first.
    """

    def __init__(self, faults: Iterable[tuple[str, str]]) -> None:
        self.faults = tuple(faults)
        super().__init__("; ".join(sentence for _, sentence in self.faults))

    def __reduce__(self) -> tuple[type[InvalidValueError], tuple[object, ...]]:
        return (type(self), (self.faults,))


@dataclass(frozen=True, slots=True)
class Fault:
    """One thing that is wrong with a file: where it stands, whom it concerns, and which rule it breaks."""

    file: str
    line: int | None
    subject: str
    text: str

    def __str__(self) -> str:
        place = self.file if self.line is None else f"{self.file}:{self.line}"
        return f"{place}: {self.subject}: {self.text}" if self.subject else f"{place}: {self.text}"


class BadFileError(CoordError):
    """A file that cannot be used, with all its faults at once (exit code 2)."""

    def __init__(self, faults: Iterable[Fault]) -> None:
        self.faults = tuple(faults)
        super().__init__("\n".join(str(fault) for fault in self.faults))

    def __reduce__(self) -> tuple[type[BadFileError], tuple[object, ...]]:
        return (type(self), (self.faults,))


class NoPlanError(CoordError):
    """There is no plan, and these diagnoses say why (exit code 1)."""

    def __init__(self, diagnoses: Iterable[Diagnosis]) -> None:
        self.diagnoses = tuple(diagnoses)
        super().__init__("\n".join(diagnosis.text for diagnosis in self.diagnoses))

    def __reduce__(self) -> tuple[type[NoPlanError], tuple[object, ...]]:
        return (type(self), (self.diagnoses,))


class NotCertifiedError(CoordError):
    """The independent checker refused a plan, or could not decide (exit code 4)."""


class SolverError(CoordError):
    """A numerical library failed where it should not have (exit code 70 when nothing catches it)."""
