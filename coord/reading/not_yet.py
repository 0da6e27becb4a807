"""What the problem format knows and coord cannot do yet: refused by name, never ignored.

This is the only list of such things; whoever builds one of them removes its entry.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from coord.reading.locate import KeyPath
from coord.reading.report import Report


class NotYet(NamedTuple):
    """A field of a table, the values of it that are refused, and how the fault speaks of them."""

    table: str
    field: str
    what: str
    applies: Callable[[Any], bool] = lambda value: True


NOT_YET: tuple[NotYet, ...] = (
    NotYet("map", "origin", "a map that is turned (origin's third number is not 0)", lambda pose: pose[2] != 0),
    NotYet("map", "mode", 'a mode other than "trinary"', lambda mode: mode != "trinary"),
)


def refusals(table: str, fields: Mapping[str, Any]) -> dict[str, str]:
    """The fields of a table that cannot be done yet, each with the sentence that says so."""
    return {
        entry.field: f"{entry.what} is not supported yet"
        for entry in NOT_YET
        if entry.table == table and entry.field in fields and entry.applies(fields[entry.field])
    }


def without_refused(table: str, fields: Mapping[str, Any], path: KeyPath, report: Report) -> dict[str, Any]:
    """The fields of a table without those that cannot be done yet, which are reported."""
    refused = refusals(table, fields)
    report.add_rules(path, refused.items())
    return {key: value for key, value in fields.items() if key not in refused}
