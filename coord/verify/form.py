"""The form of values in a plan file: types, keys, finite numbers."""

from __future__ import annotations

import json
from collections.abc import Sequence
from math import isfinite
from typing import Any

from coord.verify.tolerances import LARGEST_NUMBER

Table = dict[str, Any]


class MalformedError(Exception):
    """A plan file that is not of the form coord-plan/1; the text says where and why."""


def decode(data: bytes) -> object:
    """The JSON value in some bytes, strictly: UTF-8, no repeated keys, no NaN or Infinity; all numbers are floats.

    Raises
    ------
    MalformedError
        When the bytes are no such value, or nested too deeply to be read.
    """
    try:
        return json.loads(
            data.decode("utf-8"), parse_int=float, parse_constant=_constant, object_pairs_hook=_without_repeats
        )
    except UnicodeDecodeError as error:
        raise MalformedError(f"the file is not UTF-8 text: {error.reason} at byte {error.start}") from error
    except RecursionError as error:
        raise MalformedError("the file is nested too deeply to be a plan") from error
    except ValueError as error:
        raise MalformedError(f"the file is not JSON: {error}") from error


def _constant(text: str) -> float:
    raise MalformedError(f"{text} is not a finite number")


def _without_repeats(pairs: list[tuple[str, object]]) -> Table:
    table = dict(pairs)
    if len(table) != len(pairs):
        seen: set[str] = set()
        repeated = next(key for key, _ in pairs if key in seen or seen.add(key))  # type: ignore[func-returns-value]
        raise MalformedError(f"the key {json.dumps(repeated)} is given more than once in one object")
    return table


def table(value: object, where: str, keys: frozenset[str]) -> Table:
    """An object with exactly these keys."""
    if not isinstance(value, dict):
        raise MalformedError(f"{where} must be an object")
    if value.keys() != keys:
        missing, unknown = sorted(keys - value.keys()), sorted(value.keys() - keys)
        faults = [f"lacks {', '.join(missing)}"] * bool(missing)
        faults += [f"has the unknown key {', '.join(json.dumps(key) for key in unknown)}"] * bool(unknown)
        raise MalformedError(f"{where} {' and '.join(faults)}")
    return value


def array(value: object, where: str) -> list[Any]:
    """A list of anything."""
    if not isinstance(value, list):
        raise MalformedError(f"{where} must be a list")
    return value


def number(value: object, where: str, least: float = -LARGEST_NUMBER) -> float:
    """A finite number that is not below the least one allowed."""
    if type(value) is not float or not isfinite(value) or abs(value) > LARGEST_NUMBER:
        raise MalformedError(f"{where} must be a finite number, at most {LARGEST_NUMBER:g} in size")
    if value < least:
        raise MalformedError(f"{where} must be >= {least:g} (got {value:g})")
    return value


def positive(value: object, where: str) -> float:
    """A finite number > 0."""
    found = number(value, where)
    if not found > 0.0:
        raise MalformedError(f"{where} must be > 0 (got {found:g})")
    return found


def numbers(value: object, where: str, count: int | None = None) -> tuple[float, ...]:
    """A list of finite numbers, of a given length if one is given."""
    if isinstance(value, list) and (count is None or len(value) == count):
        if not value:
            return ()
        if set(map(type, value)) == {float} and min(value) >= -LARGEST_NUMBER and max(value) <= LARGEST_NUMBER:
            return tuple(value)
    size = "" if count is None else f"{count} "
    raise MalformedError(f"{where} must be a list of {size}finite numbers, at most {LARGEST_NUMBER:g} in size")


def rows(value: object, where: str, columns: int) -> tuple[tuple[float, ...], ...]:
    """A list of rows of finite numbers, each of the same length."""
    return tuple([numbers(row, where, columns) for row in array(value, where)])


def text(value: object, where: str) -> str:
    """A string of characters that can be written."""
    if not isinstance(value, str):
        raise MalformedError(f"{where} must be a string")
    if not value.isascii():
        try:
            value.encode("utf-8")
        except UnicodeEncodeError as error:
            raise MalformedError(f"{where} holds half a character (a lone surrogate)") from error
    return value


def texts(value: object, where: str) -> tuple[str, ...]:
    """A list of strings."""
    return tuple([text(item, where) for item in array(value, where)])


def choice(value: object, where: str, allowed: Sequence[str]) -> str:
    """One of some words."""
    if not isinstance(value, str) or value not in allowed:
        raise MalformedError(f"{where} must be {' or '.join(json.dumps(word) for word in allowed)}")
    return value
