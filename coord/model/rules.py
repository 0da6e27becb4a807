"""The rule of a range, as a sentence: who, which value, which rule."""

from __future__ import annotations


def range_fault(what: str, value: float, unit: str, least: float, most: float) -> str | None:
    """Why a value is not a number from ``least`` to ``most``; a least of 0.0 is allowed, one above it is not said.

    What is forbidden is said by its nearest bound: a negative value hears "> 0" or ">= 0", not the largest one.
    """
    if least <= value <= most:
        return None
    got = f"(got {value:g})"
    if value > most:
        return f"{what} must be at most {most:g}{unit} {got}"
    if least > 0 and value > 0:
        return f"{what} must be at least {least:g}{unit} {got}"
    return f"{what} must be {'>' if least > 0 else '>='} 0{unit} {got}"
