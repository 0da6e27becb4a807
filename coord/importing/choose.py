"""One door for all formats: which one a file is, and whether what came out can be planned."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Final

import yaml

from coord.errors import BadFileError, Fault
from coord.importing.dynobench import compose, dynobench_draft
from coord.importing.geojson import geojson_draft
from coord.importing.maps import image_draft, movingai_draft, ros_draft
from coord.importing.scenario import scenario_draft
from coord.importing.values import Imported, ImportOptions
from coord.importing.wkt import wkt_draft
from coord.output.files import write
from coord.output.problem_file import Draft, written
from coord.reading.problem_file import read_problem

Reader = Callable[[Path, Path, ImportOptions], Draft]

#: What a file is by its ending; YAML files are told apart by what stands in them.
_ENDINGS: Final = {
    ".scen": "scenario",
    ".map": "MovingAI map",
    ".yaml": "YAML",
    ".yml": "YAML",
    ".png": "image",
    ".pgm": "image",
    ".bmp": "image",
    ".jpg": "image",
    ".jpeg": "image",
    ".geojson": "GeoJSON",
    ".json": "GeoJSON",
    ".wkt": "WKT",
}

#: For each format its reader, and the options that mean something to it.
_FORMATS: Final[dict[str, tuple[Reader, frozenset[str]]]] = {
    "scenario": (scenario_draft, frozenset({"map", "robots", "resolution", "radius"})),
    "MovingAI map": (movingai_draft, frozenset({"resolution", "radius", "simplify"})),
    "ROS map": (ros_draft, frozenset({"unknown", "radius", "simplify"})),
    "image": (image_draft, frozenset({"resolution", "occupied_below", "radius", "simplify"})),
    "dynobench problem": (dynobench_draft, frozenset({"radius"})),
    "GeoJSON": (geojson_draft, frozenset({"metres", "radius"})),
    "WKT": (wkt_draft, frozenset({"radius"})),
}


def import_file(source: Path, output: Path, options: ImportOptions) -> Imported:
    """The text of a problem file made from a file of another format; nothing is written.

    Parameters
    ----------
    source : a MovingAI scenario or map, a ROS map, an image, a dynobench problem, GeoJSON or well-known text.
    output : where the problem file will stand; a map is named relative to it.

    Raises
    ------
    BadFileError
        When the output exists already (unless ``force``), when the file is of no such format or has faults, when an
        option means nothing to its format, or when the problem would not be accepted, with the reasons.
    """
    source, output = Path(source), Path(output)
    if output.exists() and not options.force:
        text = "it exists already; give another name, or --force to replace it"
        raise BadFileError([Fault(str(output), None, "", text)])
    kind = _kind(source)
    reader, takes = _FORMATS[kind]
    useless = [name for name in options.given() if name not in takes]
    if useless:
        raise BadFileError(
            Fault(str(source), None, "", f"--{name.replace('_', '-')} means nothing to a file that is a {kind}")
            for name in useless
        )
    draft = reader(source, output.parent, options)
    _check(draft, source, output.parent)
    return Imported(written(draft), draft.remarks)


def write_import(source: Path, output: Path, options: ImportOptions) -> tuple[str, ...]:
    """Import a file and write the problem file, whole or not at all; returns what a person should know about it."""
    imported = import_file(source, output, options)
    write(Path(output), imported.text.encode())
    return imported.remarks


def _kind(source: Path) -> str:
    kind = _ENDINGS.get(source.suffix.lower())
    if kind is None:
        known = " ".join(_ENDINGS)
        raise BadFileError([Fault(str(source), None, "", f"its ending says nothing; known are {known}")])
    if kind != "YAML":
        return kind
    top = compose(source)
    keys = {str(key.value) for key, _ in top.value} if isinstance(top, yaml.MappingNode) else set()
    if "image" in keys:
        return "ROS map"
    if "environment" in keys:
        return "dynobench problem"
    text = "this YAML is neither a ROS map (key image) nor a dynobench problem (keys environment and robots)"
    raise BadFileError([Fault(str(source), 1, "", text)])


def _check(draft: Draft, source: Path, folder: Path) -> None:
    """Read the problem as it would be read from its file; what is wrong with it is told of the source."""
    workspace = dict(draft.workspace)
    if "map" in workspace:
        workspace["map"] = str((folder / str(workspace["map"])).resolve())
    with tempfile.TemporaryDirectory() as place:
        file = Path(place) / "problem.toml"
        file.write_text(written(replace(draft, workspace=workspace)), encoding="utf-8")
        try:
            read_problem(file)
        except BadFileError as error:
            raise BadFileError(
                replace(fault, file=str(source), line=None) if fault.file == str(file) else fault
                for fault in error.faults
            ) from None
