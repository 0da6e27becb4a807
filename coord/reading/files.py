"""Bytes of files, with care: regular files only, and none larger than expected."""

from __future__ import annotations

import stat
from pathlib import Path

from coord.errors import CoordError


class UnreadableError(CoordError):
    """A named file cannot be used; the text goes on from its name: "does not exist"."""


def read_bytes(path: Path, largest: int) -> bytes:
    """All bytes of a regular file of at most ``largest`` bytes.

    Raises
    ------
    UnreadableError
        When there is no such file, it is a folder, a pipe or a device, it may not be read, or it is too large.
    """
    try:
        # looked at before it is opened: opening a pipe would wait for somebody to write into it
        if not stat.S_ISREG(path.stat().st_mode):
            raise UnreadableError("is not a regular file")
        with path.open("rb") as stream:
            data = stream.read(largest + 1)
    except FileNotFoundError:
        raise UnreadableError("does not exist") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise UnreadableError(f"cannot be read: {reason}") from None
    if len(data) > largest:
        size = f"{largest // 2**20} MiB" if largest >= 2**20 else f"{largest // 2**10} KiB"
        raise UnreadableError(f"is larger than {size}")
    return data
