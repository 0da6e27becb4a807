"""Grey values of a map's image: PGM by a small exact reader, PNG, BMP and JPEG with Pillow.

Sizes are taken from the header and checked before anything is decoded.
"""

from __future__ import annotations

import io
import re
import struct
import warnings
import zlib
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

#: A map may have this many cells: 10,000 x 10,000.
LARGEST_MAP = 100_000_000

_GAP = rb"(?:\s|#[^\n\r]*[\n\r])+"
_PGM_HEADER = re.compile(rb"P([25])" + _GAP + rb"(\d{1,9})" + _GAP + rb"(\d{1,9})" + _GAP + rb"(\d{1,9})\s")
#: A header is found within this many bytes, comments included.
_HEADER_BYTES = 65536


class ImageError(ValueError):
    """An image cannot be read; the sentence says why."""


@dataclass(frozen=True, slots=True, eq=False)
class Image:
    """Grey values (rows, columns), the top row first, from 0 (black) to ``white``."""

    values: npt.NDArray[Any]
    white: int


def read_image(data: bytes) -> Image:
    """Read an image from the bytes of a PGM (P2 or P5), PNG, BMP or JPEG file.

    The value of a coloured pixel is the sum of its channels, alpha included, as in ROS' map_server.

    Raises
    ------
    ImageError
        When it is none of these, damaged, cut short, or has more than ``LARGEST_MAP`` cells.
    """
    return _read_pgm(data) if data[:2] in (b"P2", b"P5") else _read_other(data)


def _checked_size(columns: int, rows: int) -> tuple[int, int]:
    if columns * rows > LARGEST_MAP:
        raise ImageError(f"has {columns} x {rows} cells; at most {LARGEST_MAP // 10**6} million can be read")
    if columns * rows == 0:
        raise ImageError(f"has {columns} x {rows} cells; at least one is needed")
    return columns, rows


def _read_pgm(data: bytes) -> Image:
    header = _PGM_HEADER.match(data[:_HEADER_BYTES])
    if header is None:
        raise ImageError("has no PGM header: P5 or P2, width, height, largest value")
    columns, rows = _checked_size(int(header[2]), int(header[3]))
    white = int(header[4])
    if not 0 < white < 65536:
        raise ImageError(f"has the largest value {white}; it must be between 1 and 65535")
    values = _plain(data, header.end()) if header[1] == b"2" else _raw(data, header.end(), white)
    if len(values) < columns * rows:
        raise ImageError(f"is cut short: {columns} x {rows} cells are announced, {len(values)} are there")
    values = values[: columns * rows].reshape(rows, columns)
    if values.max() > white:
        raise ImageError(f"has a cell of value {values.max()}, above the largest value {white} of its header")
    return Image(values, white)


def _raw(data: bytes, offset: int, white: int) -> npt.NDArray[Any]:
    width = 1 if white < 256 else 2
    count = (len(data) - offset) // width
    return np.frombuffer(data, dtype=np.uint8 if width == 1 else ">u2", count=count, offset=offset)


def _plain(data: bytes, offset: int) -> npt.NDArray[Any]:
    if not re.fullmatch(rb"[0-9\s]*", data[offset:]) or re.search(rb"[0-9]{10}", data[offset:]):
        raise ImageError("has something else than whole numbers after its header")
    return np.fromstring(data[offset:].decode("ascii"), dtype=np.int64, sep=" ")


def _read_other(data: bytes) -> Image:
    import PIL.Image

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of its warnings, the one about large images is decided here
            with PIL.Image.open(io.BytesIO(data), formats=("PNG", "BMP", "JPEG")) as image:
                _checked_size(*image.size)
                if image.mode not in ("1", "L", "LA", "P", "PA", "RGB", "RGBA"):
                    raise ImageError(f'has cells of the kind "{image.mode}"; write it with 8 bits a channel')
                if image.mode in ("1", "L"):
                    return Image(np.asarray(image.convert("L")), 255)
                kind = "RGBA" if "A" in image.mode or "transparency" in image.info else "RGB"
                channels = np.asarray(image.convert(kind))
    except ImageError:
        raise
    except PIL.UnidentifiedImageError:
        raise ImageError("is no PGM, PNG, BMP or JPEG image") from None
    except PIL.Image.DecompressionBombError:
        raise ImageError(f"has too many cells; at most {LARGEST_MAP // 10**6} million can be read") from None
    except (OSError, SyntaxError, ValueError, EOFError, IndexError, TypeError, struct.error, zlib.error) as error:
        raise ImageError(f"is damaged: {error}") from None
    return Image(channels.sum(axis=2, dtype=np.uint16), 255 * channels.shape[2])
