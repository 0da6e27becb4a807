"""Fatrop once looped for ever inside one iteration; `fastest` must come back."""

from __future__ import annotations

import subprocess
import sys

import pytest

_CODE = """
from coord.alone.fastest import fastest
from coord.model.path import Path
from coord.model.robot import Limits

pieces = [
    (5.9470006376734, 0, 0), (0.27771100964747764, -1.25, -1.25), (1.5094736282187793, 0, 0),
    (0.8036887851110517, 1 / 0.35, 1 / 0.35), (2.252165942620897, 0, 0),
]
limits = Limits(0.7339473297264212, 0.20056166330780656, 0.5898772360330705, 2.0297376958537767, 0.20263407041859288)
assert 15 < fastest(Path((0.0, 0.0, 0.0), pieces), limits).arrival < 21.5
"""


@pytest.mark.xfail(strict=True, raises=subprocess.TimeoutExpired, reason="Fatrop never returns (seen: more than 100 s)")
def test_two_bends_that_fatrop_never_came_back_from():
    """A path of three lines and two arcs is timed within seconds."""
    subprocess.run([sys.executable, "-W", "error", "-c", _CODE], check=True, timeout=6)
