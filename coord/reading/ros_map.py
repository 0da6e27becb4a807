"""Maps of ROS' map_server: a YAML file that names an image and says what its grey values mean."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import yaml

from coord.errors import BadFileError, Fault
from coord.reading.files import UnreadableError, read_bytes
from coord.reading.grid_map import LARGEST_FILE, GridMap
from coord.reading.images import Image, ImageError, read_image
from coord.reading.not_yet import refusals
from coord.reading.report import shown
from coord.tolerances import LARGEST_COORDINATE

_LARGEST_YAML = 2**16


def read_ros_map(path: Path, unknown: str) -> GridMap:
    """Read a map and its image, which is found relative to it.

    Parameters
    ----------
    unknown : "occupied" or "free", what cells between the thresholds count as.

    A cell of value v is occupied with p = (255 - v)/255, or v/255 with ``negate``: occupied if
    p >= occupied_thresh, else free if p < free_thresh, else unknown. Keys that map_server does not
    know are passed over, as it does.

    Raises
    ------
    UnreadableError
        When the YAML file cannot be read at all.
    BadFileError
        With all faults of the YAML file, or of the image.
    """
    data = read_bytes(path, _LARGEST_YAML)
    nodes = _nodes(path, data)
    values = _values(path, nodes)
    file = path.parent / values["image"]
    try:
        image_data = read_bytes(file, LARGEST_FILE)
        occupied = _occupied(read_image(image_data), values, unknown)
    except UnreadableError as error:
        text = f"the image {shown(values['image'])} {error}"
        raise BadFileError([Fault(str(path), nodes["image"][0], "", text)]) from None
    except ImageError as error:
        raise BadFileError([Fault(str(file), None, "", f"the image {error}")]) from None
    ros_map = GridMap(occupied, values["resolution"], values["origin"][:2], (data, image_data))
    reach = max(abs(value) for value in ros_map.bounds)
    if reach > LARGEST_COORDINATE:
        text = f"the map reaches {reach:g} m from the origin; coordinates must stay within {LARGEST_COORDINATE:g} m"
        raise BadFileError([Fault(str(path), nodes["origin"][0], "", text)])
    return ros_map


def _values(path: Path, nodes: dict[str, tuple[int, Any]]) -> dict[str, Any]:
    """What the keys say, in their own types; all faults at once."""
    faults: list[Fault] = []
    values: dict[str, Any] = {"mode": nodes["mode"][1] if "mode" in nodes else "trinary"}
    for key, (reader, takes) in _KEYS.items():
        if key not in nodes:
            faults.append(Fault(str(path), 1, "", f"{key} is missing"))
            continue
        line, given = nodes[key]
        try:
            values[key] = reader(given)
        except (ValueError, TypeError):
            faults.append(Fault(str(path), line, "", f"{key} must be {takes} (got {shown(given)})"))
    faults += [Fault(str(path), nodes[key][0], "", text) for key, text in refusals("map", values).items()]
    if faults:
        raise BadFileError(faults)
    return values


def _occupied(image: Image, values: dict[str, Any], unknown: str) -> npt.NDArray[np.bool_]:
    grey = np.arange(image.white + 1)
    p = (grey if values["negate"] else image.white - grey) / image.white
    is_occupied = p >= values["occupied_thresh"]
    if unknown == "occupied":
        is_occupied |= p >= values["free_thresh"]
    return np.asarray(is_occupied[image.values[::-1]])


def _nodes(path: Path, data: bytes) -> dict[str, tuple[int, Any]]:
    """Each key of the YAML file with its line and what is written there: a text, or a list of texts.

    Numbers are read from the text, not by YAML's rules, which take 5e-2 for a word.
    """
    try:
        top = yaml.compose(data.decode("utf-8-sig"), Loader=yaml.SafeLoader)
    except UnicodeDecodeError:
        raise BadFileError([Fault(str(path), None, "", "the map is no text in UTF-8")]) from None
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        text = f"the map is no YAML: {getattr(error, 'problem', None) or error}"
        raise BadFileError([Fault(str(path), mark.line + 1 if mark else None, "", text)]) from None
    except RecursionError:
        raise BadFileError([Fault(str(path), None, "", "the map is nested too deeply")]) from None
    if not isinstance(top, yaml.MappingNode):
        raise BadFileError([Fault(str(path), 1, "", f"a map has the keys {', '.join(_KEYS)}")])
    return {str(key.value): (key.start_mark.line + 1, _content(value)) for key, value in top.value}


def _content(node: yaml.Node) -> Any:
    if isinstance(node, yaml.SequenceNode):
        return [str(item.value) if isinstance(item, yaml.ScalarNode) else "..." for item in node.value]
    return str(node.value) if isinstance(node, yaml.ScalarNode) else {}


def _number(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(text)
    return value


def _positive(text: str) -> float:
    value = _number(text)
    if not value > 0:
        raise ValueError(text)
    return value


def _share(text: str) -> float:
    value = _number(text)
    if not 0 <= value <= 1:
        raise ValueError(text)
    return value


def _pose(texts: list[str]) -> tuple[float, float, float]:
    if not isinstance(texts, list):
        raise TypeError(texts)
    x, y, yaw = (_number(text) for text in texts)
    return x, y, yaw


def _flag(text: str) -> bool:
    if text not in ("0", "1", "false", "true"):
        raise ValueError(text)
    return text in ("1", "true")


def _name(text: str) -> str:
    if not isinstance(text, str) or not text:
        raise TypeError(text)
    return text


_KEYS: dict[str, tuple[Callable[[Any], Any], str]] = {
    "image": (_name, "the name of a file"),
    "resolution": (_positive, "a number > 0 in m, the side of a cell"),
    "origin": (_pose, "[x, y, yaw], the pose of the lower left corner in m and rad"),
    "negate": (_flag, "0 or 1"),
    "occupied_thresh": (_share, "a number from 0 to 1"),
    "free_thresh": (_share, "a number from 0 to 1"),
}
