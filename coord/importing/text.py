"""Texts of files to import, read with care."""

from __future__ import annotations

from pathlib import Path

from coord.errors import BadFileError, Fault
from coord.reading.files import UnreadableError, read_bytes

_LARGEST = 2**26


def read_text(source: Path) -> str:
    """The text of a file in UTF-8; a BadFileError says why it cannot be read."""
    try:
        return read_bytes(source, _LARGEST).decode("utf-8-sig")
    except UnreadableError as error:
        raise BadFileError([Fault(str(source), None, "", f"the file {error}")]) from None
    except UnicodeDecodeError:
        raise BadFileError([Fault(str(source), None, "", "the file is no text in UTF-8")]) from None
