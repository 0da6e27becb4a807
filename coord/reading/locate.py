"""Where in a TOML text a value stands: lines for error messages, which tomllib does not give.

Only texts that tomllib has accepted come here, so this reads just enough of TOML to keep its place: comments,
strings of all four kinds, arrays over several lines, inline tables, dotted and quoted keys. What it cannot find,
it places at the table around it; it never fails.
"""

from __future__ import annotations

import re
import tomllib
from bisect import bisect_right
from typing import TypeAlias

KeyPath: TypeAlias = tuple[str | int, ...]

_BLANK = re.compile(r"(?:[ \t\r\n]+|#[^\n]*)*")
_KEY = re.compile(r"""[A-Za-z0-9_-]+|"(?:[^"\\\n]|\\.)*"|'[^'\n]*'""")
_SPACE = re.compile(r"[ \t]*")
#: The common statement, a bare key and a value on one line, in one step: ten thousand robots have many of them.
_SIMPLE = re.compile(
    r"""([A-Za-z0-9_-]+)[ \t]*=[ \t]*("[^"\\\n]*"|'[^'\n]*'|[^\s"'#\[\]{}]+|\[[^\n"'#\[\]{}]*\])[ \t\r]*(?=\n|\Z)"""
)
_PIECE = re.compile(
    r'''"""(?:\\.|[^\\])*?"""(?:"{0,2})|\'\'\'.*?\'\'\'(?:'{0,2})|"(?:[^"\\\n]|\\.)*"|'[^'\n]*\''''
    r"""|\#[^\n]*|[\[\]{},\n]|[^\[\]{},\n"'\#]+""",
    re.DOTALL,
)
#: Faults name at most this many levels; deeper keys are not remembered.
_LEVELS = 8


class Locator:
    """The lines of all keys and values of one TOML text."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._newlines = [match.start() for match in re.finditer("\n", text)]
        self._keys: dict[KeyPath, int] = {(): 0}
        self._values: dict[KeyPath, int] = {}
        self._parts: dict[int, dict[str | int, tuple[int, int]]] = {}
        self._index()

    def line(self, path: KeyPath) -> int:
        """The line, from 1, of the value at a path such as ("robots", 6, "speed"), or of what encloses it."""
        for levels in range(min(len(path), _LEVELS), -1, -1):
            if (offset := self._keys.get(path[:levels])) is not None:
                value = self._values.get(path[:levels])
                if value is not None:
                    offset = self._inside(offset, value, path[levels:])
                return bisect_right(self._newlines, offset - 1) + 1
        return 1

    def _index(self) -> None:
        """Walk over the statements of the text and remember where keys and values begin."""
        text = self._text
        counts: dict[KeyPath, int] = {}
        table: KeyPath = ()
        at = _end(_BLANK, text, 0)
        while at < len(text):
            if simple := _SIMPLE.match(text, at):
                self._keys.setdefault((*table, simple[1]), at)
                self._values.setdefault((*table, simple[1]), simple.start(2))
                at = simple.end()
            elif text[at] == "[":
                repeated = text.startswith("[[", at)
                names, _ = _key(text, at + 1 + repeated)
                table = ()
                for name in names[:-1]:
                    table = _last((*table, name), counts)
                    self._keys.setdefault(table, at)
                table = (*table, *names[-1:])
                if repeated:
                    self._keys.setdefault(table, at)
                    counts[table] = counts.get(table, 0) + 1
                table = _last(table, counts)
                self._keys.setdefault(table, at)
                at = _skip(text, at, "\n")
            else:
                names, after = _key(text, at)
                if not names or text[after : after + 1] != "=":
                    return
                for levels in range(1, len(names) + 1):
                    self._keys.setdefault((*table, *names[:levels]), at)
                value = _end(_SPACE, text, after + 1)
                self._values.setdefault((*table, *names), value)
                at = _skip(text, value, "\n")
            at = _end(_BLANK, text, at)

    def _inside(self, offset: int, value: int, rest: KeyPath) -> int:
        """The offset of the innermost part of an array or inline table that lies on the way to ``rest``."""
        for part in rest:
            if value not in self._parts:
                self._parts[value] = _parts(self._text, value)
            if part not in self._parts[value]:
                break
            offset, value = self._parts[value][part]
        return offset


def _last(table: KeyPath, counts: dict[KeyPath, int]) -> KeyPath:
    """The table itself, or where it is an array of tables, the last one so far."""
    return (*table, counts[table] - 1) if table in counts else table


def _parts(text: str, value: int) -> dict[str | int, tuple[int, int]]:
    """The items of an array, or the keys of an inline table: where each begins, and where its value does."""
    parts: dict[str | int, tuple[int, int]] = {}
    opening = text[value : value + 1]
    if opening not in ("[", "{") or not opening:
        return parts
    closing = "]" if opening == "[" else "}"
    at = _end(_BLANK, text, value + 1)
    while at < len(text) and text[at] != closing:
        if opening == "[":
            parts[len(parts)] = (at, at)
        else:
            names, after = _key(text, at)
            if not names or text[after : after + 1] != "=":
                break
            # of a dotted key a.b = 1 only the first name is found; its parts are placed where it stands
            parts.setdefault(names[0], (at, _end(_SPACE, text, after + 1) if len(names) == 1 else at))
            at = after + 1
        at = _skip(text, at, "," + closing)
        if text[at : at + 1] == ",":
            at = _end(_BLANK, text, at + 1)
    return parts


def _key(text: str, at: int) -> tuple[tuple[str, ...], int]:
    """The names of a dotted key that begins at ``at`` (blanks allowed), and where it ends."""
    names: list[str] = []
    while match := _KEY.match(text, _end(_SPACE, text, at)):
        name = match[0]
        if len(names) < _LEVELS:
            names.append(_unquoted(name))
        at = _end(_SPACE, text, match.end())
        if text[at : at + 1] != ".":
            break
        at += 1
    return tuple(names), at


def _unquoted(name: str) -> str:
    """The name that a key says; one with escapes that TOML does not know stands for itself."""
    if name[0] not in "\"'":
        return name
    try:
        return str(tomllib.loads(f"name = {name}")["name"])
    except tomllib.TOMLDecodeError:
        return name


def _skip(text: str, at: int, stops: str) -> int:
    """Where the first of the stop characters stands that is in no string, comment, array or inline table."""
    depth = 0
    while match := _PIECE.match(text, at):
        piece = match[0]
        if depth <= 0 and piece in stops:
            break
        depth += (piece in "[{") - (piece in "]}")
        at = match.end()
    return at


def _end(pattern: re.Pattern[str], text: str, at: int) -> int:
    match = pattern.match(text, at)
    return match.end() if match else at
