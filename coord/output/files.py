"""Files on disk: read whole, and written so that nobody ever sees half of one."""

from __future__ import annotations

import json
import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO, Final

from coord.errors import BadFileError, Fault
from coord.model.result import Plan, Result
from coord.output.plan_file import parse
from coord.output.summary import diagnosis_record

PLAN: Final = "plan.json"
OLD_PLAN: Final = "plan.old.json"
DIAGNOSIS: Final = "diagnosis.json"


def read(path: Path) -> bytes:
    """Read a whole file; a BadFileError says why it cannot be read."""
    try:
        return path.read_bytes()
    except OSError as error:
        raise _unusable(path, "cannot be read", error) from error


def read_plan(path: Path | str) -> Plan:
    """Read a plan file.

    Raises
    ------
    BadFileError
        When there is no such file, or when it is not a well-formed plan file.
    """
    return parse(read(Path(path)), str(path))


@contextmanager
def replacing(path: Path) -> Iterator[BinaryIO]:
    """Open a stream whose bytes take the place of ``path`` when all of them are written, and never before.

    They go to a temporary file in the same folder, which is then renamed. Folders on the way are made.
    A path that is a device or a pipe is written directly.

    Raises
    ------
    BadFileError
        When the place cannot be written.
    """
    try:
        if path.exists() and not path.is_file() and not path.is_dir():
            with path.open("wb") as stream:
                yield stream
            return
        target = path.resolve()  # a link stays a link: the file that it names is replaced
        if target.is_dir():
            raise IsADirectoryError(21, "it is a folder")
        target.parent.mkdir(parents=True, exist_ok=True)
        temporary = target.with_name(f".{target.name}.{secrets.token_hex(4)}.tmp")
        try:
            with temporary.open("xb") as stream:
                yield stream
                stream.flush()
                os.fsync(stream.fileno())
            temporary.replace(target)
        finally:
            temporary.unlink(missing_ok=True)
    except OSError as error:
        raise _unusable(path, "cannot be written", error) from error


def write(path: Path, data: bytes) -> None:
    """Write a whole file at once, see ``replacing``."""
    with replacing(path) as stream:
        stream.write(data)


def prepare(folder: Path) -> None:
    """Make the folder of the results, and see that it can be written before a long computation, not after it."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        probe = folder / f".{secrets.token_hex(4)}.tmp"
        probe.touch(exist_ok=False)
        probe.unlink()
    except OSError as error:
        raise _unusable(folder, "cannot be written", error) from error


def save(folder: Path, result: Result) -> Path:
    """Write what a run has to show into its folder and return the file written.

    A certified plan becomes ``plan.json``, its bytes exactly those that were verified, and an older
    ``diagnosis.json`` goes. Otherwise the reasons become ``diagnosis.json``, and an older ``plan.json`` is
    kept as ``plan.old.json``: nobody shall take it for the answer to this run.

    Raises
    ------
    BadFileError
        When the folder cannot be written.
    """
    plan, diagnosis = folder / PLAN, folder / DIAGNOSIS
    if result.plan is not None and result.certified:
        write(plan, result.document)
        _move(diagnosis, None)
        return plan
    _move(plan, folder / OLD_PLAN)
    text = json.dumps(diagnosis_record(result), ensure_ascii=False, indent=1, allow_nan=False)
    write(diagnosis, f"{text}\n".encode(errors="backslashreplace"))
    return diagnosis


def _move(path: Path, target: Path | None) -> None:
    """Rename a file, or remove it where there is no target; nothing happens when there is none."""
    try:
        if target is None:
            path.unlink(missing_ok=True)
        elif path.exists():
            path.replace(target)
    except OSError as error:
        raise _unusable(path, "cannot be moved out of the way", error) from error


def _unusable(path: Path, what: str, error: OSError) -> BadFileError:
    reason = error.strerror or str(error)
    return BadFileError([Fault(str(path), None, "", f"{what}: {reason[:1].lower()}{reason[1:]}")])
