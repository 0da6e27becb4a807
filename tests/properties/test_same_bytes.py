"""Same input, same bytes, in other processes too."""

from __future__ import annotations

import os
import subprocess
import sys

_CODE = """
import hashlib, sys
import numpy as np
from coord import Circle, Footprint, Limits, Problem, Robot, Workspace, rectangle
from coord.plan import plan

rng = np.random.default_rng(7)
for scene in range(4):
    robots = []
    for k in range(8):
        turn = np.pi * (k + 0.3 * rng.random()) / 8
        c, s = float(9 * np.cos(turn)), float(9 * np.sin(turn))
        limits = Limits(*np.round(rng.uniform(0.4, 1.6, 5), 2).tolist())
        robots.append(Robot(f"r{k}", Footprint(0.3), limits, (-c, -s), (c, s)))
    obstacles = (Circle("c", (1.0, 2.0), 1.2), rectangle("r", (-3.0, -4.0, -1.0, -2.0), 0.4))[: scene % 3]
    result = plan(Problem("p", Workspace((-12.0, -12.0, 12.0, 12.0), 0.05), tuple(robots), obstacles))
    print(hashlib.sha256(result.document).hexdigest(), len(result.document), [d.text for d in result.diagnoses])
"""


def _run(**environment):
    return subprocess.run(
        [sys.executable, "-c", _CODE], check=True, capture_output=True, text=True, env=os.environ | environment
    ).stdout


def test_hash_seeds_and_threads_change_no_byte():
    """Four scenes, planned in processes with other hash seeds and numbers of threads: the same digests."""
    first = _run(PYTHONHASHSEED="0", OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
    assert len(set(first.splitlines())) == 4
    assert _run(PYTHONHASHSEED="12345", OMP_NUM_THREADS="2", OPENBLAS_NUM_THREADS="2") == first
