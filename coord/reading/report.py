"""The faults of a problem file while it is read: collected by place, told to people at the end."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, TypeVar

from coord.errors import Fault, InvalidValueError
from coord.reading.locate import KeyPath, Locator

Value = TypeVar("Value")

#: Values are shown up to this many characters.
_SHOWN = 60


class Report:
    """Faults found so far, by their place in the file.

    Reading goes on after a fault, so that all of them are told at once; what is known to be wrong is left out.
    A place is a path of keys and indices, ("robots", 6, "speed"); people are told it as robots[7], counting from 1.
    """

    def __init__(self, file: str, text: str, raw: dict[str, Any]) -> None:
        self._file, self._text, self._raw = file, text, raw
        self._found: list[tuple[KeyPath, str]] = []
        self._elsewhere: list[Fault] = []

    def __bool__(self) -> bool:
        return bool(self._found or self._elsewhere)

    def add(self, path: KeyPath, text: str) -> None:
        """Note a broken rule, as a sentence, at a place."""
        self._found.append((path, text))

    def add_rules(self, path: KeyPath, faults: Iterable[tuple[str, str]]) -> None:
        """Note what a constructor of the model said: (field, sentence) pairs about the table at a place."""
        for field, text in faults:
            self.add((*path, field), text)

    def attempt(self, path: KeyPath, make: Callable[[], Value]) -> Value | None:
        """What a constructor of the model makes of the table at a place, or None and the rules it breaks."""
        try:
            return make()
        except InvalidValueError as error:
            self.add_rules(path, error.faults)
            return None

    def add_faults(self, faults: Iterable[Fault]) -> None:
        """Note the faults of another file, which know their own lines."""
        self._elsewhere.extend(faults)

    def faults(self) -> list[Fault]:
        """All faults: those of this file from top to bottom, then those of the files it names."""
        locator = Locator(self._text)
        found = [
            Fault(self._file, locator.line(path), self.subject(path), _printable(text)) for path, text in self._found
        ]
        return sorted(found, key=lambda fault: fault.line or 0) + self._elsewhere

    def subject(self, path: KeyPath) -> str:
        """Whom a place concerns: robots[7] "amr-8", counted from 1, or [workspace], or the file as a whole."""
        if len(path) > 1 and path[0] in ("robots", "obstacles") and isinstance(path[1], int):
            table = self._raw[path[0]][path[1]]
            name = table.get("name") if isinstance(table, dict) else None
            return f"{path[0]}[{path[1] + 1}]" + (f" {shown(name)}" if isinstance(name, str) and name else "")
        return f"[{path[0]}]" if path and path[0] in ("workspace", "plan", "defaults") else ""


def shown(value: object, levels: int = 4) -> str:
    """A value as it would be written in TOML, on one line, cut where it gets long."""
    if isinstance(value, bool):
        text = str(value).lower()
    elif isinstance(value, int) and value.bit_length() > 200:
        text = "a huge number"
    elif isinstance(value, str):
        text = f'"{_printable(value[: _SHOWN + 1])}"'
    elif isinstance(value, list):
        items = [shown(item, levels - 1) for item in value[:8]] if levels else ["..."]
        text = "[" + ", ".join(items) + (", ..." if len(value) > 8 else "") + "]"
    elif isinstance(value, dict):
        entries = (
            [f"{_printable(k[:_SHOWN])} = {shown(v, levels - 1)}" for k, v in [*value.items()][:4]]
            if levels
            else ["..."]
        )
        text = "{ " + ", ".join(entries) + (", ..." if len(value) > 4 else "") + " }" if value else "{}"
    else:
        text = str(value)
    return text if len(text) <= _SHOWN else text[: _SHOWN - 3] + "..."


def _printable(text: str) -> str:
    """The text on one line: a name with a line break in it must not break the list of faults."""
    return text if text.isprintable() else "".join(c if c.isprintable() else ascii(c)[1:-1] for c in text)
