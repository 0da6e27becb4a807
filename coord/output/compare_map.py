"""Whether the obstacles of a plan are the map of this problem, by the checker's own eyes."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from coord.verify.cells import map_faults
from coord.verify.document import read
from coord.verify.grid import MapDescription, NotReadHereError
from coord.verify.report import Findings


@dataclass(frozen=True, slots=True)
class MapComparison:
    """What was found: sentences where plan and map differ, and a remark where cells could not be compared."""

    differences: tuple[str, ...] = ()
    remark: str = ""


def compare_map(plan: bytes, problem: Path) -> MapComparison:
    """Compare the obstacles of a plan with the cells of the map that a problem names.

    Parameters
    ----------
    plan : the bytes of a well-formed plan file.
    problem : a problem file that can be read; its own obstacles come first in a plan, those of its map after them.

    A problem without a map, and a plan that is malformed, have nothing to compare.
    """
    document = tomllib.loads(problem.read_text(encoding="utf-8-sig"))
    description = _description(document.get("workspace", {}), problem.parent)
    whole = read(plan, Findings())
    if description is None or whole is None:
        return MapComparison()
    own = len(document.get("obstacles", []))
    try:
        return MapComparison(tuple(f"map: {text}" for text in map_faults(description, whole.obstacles[own:])))
    except (NotReadHereError, OSError, UnicodeDecodeError) as error:
        text = f"the cells of the map were not compared, only digests: {error}"
        return MapComparison(remark=text)


def _description(workspace: dict[str, Any], folder: Path) -> MapDescription | None:
    if "map" not in workspace:
        return None
    given = {key: workspace[key] for key in ("resolution", "occupied_below", "unknown") if key in workspace}
    return MapDescription(folder / workspace["map"], **given)
