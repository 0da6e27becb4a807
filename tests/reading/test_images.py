"""Images of maps: grey values exactly as stored, and damage told."""

from __future__ import annotations

import io
import struct
import zlib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image as Pillow

from coord.reading.images import ImageError, read_image


def stored(cells: np.ndarray, kind: str) -> bytes:
    """Cells as an image file."""
    stream = io.BytesIO()
    Pillow.fromarray(cells).save(stream, kind)
    return stream.getvalue()


def values_or_fault(data: bytes) -> tuple[int, ...] | str:
    """The shape of the values, or what was wrong."""
    try:
        return read_image(data).values.shape
    except ImageError as error:
        return str(error)


@pytest.mark.parametrize(
    ("data", "values", "white"),
    [
        (b"P5\n3 2\n255\n\x00\x01\x02\x03\xfe\xff", [[0, 1, 2], [3, 254, 255]], 255),
        (b"P5 # c 9 9\n# d\n2\t1 7\n\x00\x07rest", [[0, 7]], 7),
        (b"P5 2 1 65535\n\x01\x00\xff\xff", [[256, 65535]], 65535),
        (b"P5 1 1 255\n\n", [[10]], 255),
        (b"P2\n# a\n3 2 # b\n10\n1 2 3\n4\n5\t10\n", [[1, 2, 3], [4, 5, 10]], 10),
    ],
)
def test_pgm_values_are_exact(data, values, white):
    """Raw and plain, one byte and two, comments in the header, bytes that look like blanks."""
    image = read_image(data)
    assert image.values.tolist() == values
    assert image.white == white


@pytest.mark.parametrize("kind", ["PNG", "BMP", "PPM"])
def test_grey_images_of_all_kinds_have_the_same_values(kind):
    """Pillow writes, coord reads: PNG, BMP and PGM agree."""
    cells = np.arange(256, dtype=np.uint8).reshape(16, 16)
    image = read_image(stored(cells, kind))
    assert np.array_equal(image.values, cells)
    assert image.white == 255


def test_colours_are_the_sum_of_their_channels_alpha_included():
    """The average of all channels is the grey value, as in map_server; kept as an exact sum."""
    cells = np.random.default_rng(0).integers(0, 256, (5, 7, 4), dtype=np.uint8)
    rgb, rgba = read_image(stored(cells[:, :, :3], "PNG")), read_image(stored(cells, "PNG"))
    assert np.array_equal(rgb.values, cells[:, :, :3].sum(axis=2))
    assert np.array_equal(rgba.values, cells.sum(axis=2))
    assert (rgb.white, rgba.white) == (765, 1020)


@pytest.mark.parametrize(
    ("data", "fault"),
    [
        (b"", "is no PGM, PNG, BMP or JPEG image"),
        (b"P6 1 1 255\n000", "is no PGM, PNG, BMP or JPEG image"),
        (b"P5 two 1 255\n0", "has no PGM header: P5 or P2, width, height, largest value"),
        (b"P5 2 1 255\n0", "is cut short: 2 x 1 cells are announced, 1 are there"),
        (b"P2 2 2 255\n0 1 2", "is cut short: 2 x 2 cells are announced, 3 are there"),
        (b"P2 1 1 255\n-1", "has something else than whole numbers after its header"),
        (b"P2 1 1 9\n10", "has a cell of value 10, above the largest value 9 of its header"),
        (b"P5 0 1 255\n", "has 0 x 1 cells; at least one is needed"),
        (b"P5 1 1 70000\n0", "has the largest value 70000; it must be between 1 and 65535"),
        (b"P5 99999 99999 255\n", "has 99999 x 99999 cells; at most 100 million can be read"),
        (
            stored(np.zeros((2, 2), dtype=np.uint16), "PNG"),
            'has cells of the kind "I;16"; write it with 8 bits a channel',
        ),
    ],
)
def test_a_bad_image_is_told(data, fault):
    """What is wrong is said, and sizes are checked before a cell is read."""
    with pytest.raises(ImageError) as caught:
        read_image(data)
    assert str(caught.value) == fault


@pytest.mark.parametrize("side", [10_001, 20_000])
def test_an_image_bomb_is_refused_by_its_header(side):
    """A few bytes of PNG that announce hundreds of megabytes are refused before anything is decoded."""
    header = b"IHDR" + struct.pack(">IIBBBBB", side, side, 1, 0, 0, 0, 0)
    cells = b"IDAT" + zlib.compress(b"")
    chunks = [struct.pack(">I", len(c) - 4) + c + struct.pack(">I", zlib.crc32(c)) for c in (header, cells, b"IEND")]
    with pytest.raises(ImageError, match="at most 100 million can be read"):
        read_image(b"\x89PNG\r\n\x1a\n" + b"".join(chunks))


@settings(deadline=None)
@given(
    st.sampled_from(["PNG", "BMP", "PPM"]),
    st.lists(st.tuples(st.integers(0, 10_000), st.integers(0, 255)), max_size=4),
    st.integers(0, 200),
)
def test_a_damaged_image_is_read_or_told(kind, changes, cut):
    """Whatever bytes are changed or lost, reading raises nothing but ImageError."""
    data = bytearray(stored(np.arange(63, dtype=np.uint8).reshape(7, 9), kind))
    for place, value in changes:
        data[place % len(data)] = value
    assert values_or_fault(bytes(data[: max(len(data) - cut, 0)]))
