"""The cells of a map, read with nothing but the standard library: PGM images, ROS maps of them, MovingAI maps.

It is a second reader on purpose: it shares no line with the one that planning uses, so that a slip in one of them
shows as a difference.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from coord.verify.records import Point


class NotReadHereError(Exception):
    """A map of a kind that the checker cannot read; the text says which, beginning with a small letter."""


@dataclass(frozen=True, slots=True)
class MapDescription:
    """What a problem's [workspace] says of its map.

    Parameters
    ----------
    path : the file; a ROS map if it ends with .yaml or .yml, a MovingAI map if with .map, else an image.
    resolution : side of a cell [m]; a ROS map says its own.
    occupied_below : share of white below which a cell of an image is occupied.
    unknown : "occupied" or "free": what the cells of a ROS map between its thresholds count as.
    """

    path: Path
    resolution: float = 1.0
    occupied_below: float = 0.5
    unknown: str = "occupied"


@dataclass(frozen=True, slots=True)
class Cells:
    """A map as read: rows from the bottom, a byte a cell, 1 where it is occupied; where it lies [m]."""

    rows: tuple[bytes, ...]
    columns: int
    resolution: float
    origin: Point


def read_cells(description: MapDescription) -> Cells:
    """The cells of a map.

    Raises
    ------
    NotReadHereError
        When the map is an image that is no PGM, or what should be a map is none.
    OSError
        When a file cannot be read.
    """
    kind = description.path.suffix.lower()
    if kind == ".map":
        return _movingai(description.path.read_bytes(), description.resolution)
    if kind in (".yaml", ".yml"):
        return _ros(description.path, description.unknown)
    rows, columns, white = _pgm(description.path.read_bytes())
    below = description.occupied_below
    return Cells(_decided(rows, white, lambda v: v / white < below), columns, description.resolution, (0.0, 0.0))


def _movingai(data: bytes, resolution: float) -> Cells:
    lines = data.decode("latin-1").replace("\r\n", "\n").split("\n")
    header = dict(line.split()[:2] for line in lines[:3] if len(line.split()) == 2)
    if len(lines) < 4 or lines[3].strip() != "map" or not {"height", "width"} <= header.keys():
        raise NotReadHereError("the map has no header of a MovingAI map")
    height, width = _whole(header["height"]), _whole(header["width"])
    rows = lines[4 : 4 + height]
    if len(rows) != height or any(len(row) != width for row in rows):
        raise NotReadHereError("the map's rows are not what its header says")
    table = bytes(0 if chr(v) in ".GS" else 1 for v in range(256))
    return Cells(tuple(row.encode("latin-1").translate(table) for row in reversed(rows)), width, resolution, (0.0, 0.0))


def _ros(path: Path, unknown: str) -> Cells:
    keys = _keys(path.read_text(encoding="utf-8-sig"))
    try:
        origin = [float(text) for text in keys["origin"].strip("[]").split(",")]
        resolution, negate = float(keys["resolution"]), keys["negate"] in ("1", "true")
        limit = float(keys["occupied_thresh" if unknown == "free" else "free_thresh"])
        occupied = float(keys["occupied_thresh"])
        image = path.parent / keys["image"]
        x, y = origin[0], origin[1]
    except (KeyError, ValueError, IndexError):
        raise NotReadHereError("the map's YAML is written in a way that the checker does not read") from None
    rows, columns, white = _pgm(image.read_bytes())

    def is_occupied(value: int) -> bool:
        p = (value if negate else white - value) / white
        return p >= occupied or p >= limit

    return Cells(_decided(rows, white, is_occupied), columns, resolution, (x, y))


def _keys(text: str) -> dict[str, str]:
    """Lines ``key: value``, comments and quotes taken off; a list may stand below its key, an item a line."""
    keys: dict[str, str] = {}
    last = ""
    for line in text.splitlines():
        content = re.sub(r"(^|\s)#.*", "", line).strip()
        if content.startswith("- ") and last:
            keys[last] = ",".join(filter(None, (keys[last], content[2:].strip())))
        elif match := re.fullmatch(r"(\w+)\s*:\s*(.*)", content):
            last = match[1]
            keys[last] = match[2].strip("\"'")
    return keys


def _pgm(data: bytes) -> tuple[list[list[int] | bytes], int, int]:
    """Rows of grey values from the bottom up, their number of columns, and the value of white."""
    words: list[bytes] = []
    at = 0
    for match in re.finditer(rb"#[^\r\n]*[\r\n]|[^\s#]+", data[:65536]):
        if not match[0].startswith(b"#"):
            words.append(match[0])
            at = match.end() + 1
        if len(words) == 4:
            break
    if not words or words[0] not in (b"P2", b"P5"):
        raise NotReadHereError("the checker reads the cells of PGM images only, and this is none")
    if len(words) < 4:
        raise NotReadHereError("the image has no whole header")
    columns, rows, white = (_whole(word.decode("latin-1")) for word in words[1:])
    if words[0] == b"P2":
        values: list[int] | bytes = [_whole(word.decode("latin-1")) for word in data[at:].split()]
    elif white < 256:
        values = data[at:]
    else:
        values = [high << 8 | low for high, low in zip(data[at::2], data[at + 1 :: 2], strict=False)]
    if not columns * rows * white or len(values) < columns * rows:
        raise NotReadHereError("the image is cut short")
    return [values[columns * k : columns * (k + 1)] for k in reversed(range(rows))], columns, white


def _decided(rows: list[list[int] | bytes], white: int, is_occupied: Callable[[int], bool]) -> tuple[bytes, ...]:
    table = bytes(is_occupied(value) for value in range(white + 1))
    padded = table + bytes(256 - len(table)) if len(table) < 256 else table
    return tuple(
        row.translate(padded) if isinstance(row, bytes) else bytes(table[min(value, white)] for value in row)
        for row in rows
    )


def _whole(text: str) -> int:
    if not re.fullmatch(r"[0-9]{1,9}", text):
        raise NotReadHereError(f"the map has {text[:20]!r} where a whole number should be")
    return int(text)
