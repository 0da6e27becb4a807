"""Looking for the least start delay once crept up in thousands of tiny steps where a robot comes to rest."""

from __future__ import annotations

import pytest

import coord.timing.delay
from coord.model.footprint import Footprint
from coord.model.obstacle import Circle
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.plan import plan


def problem():
    """Robots of 1 to 4 cm, one of which creeps at 4 mm/s; another's goal lies next to its way."""
    first = Robot(
        "r0",
        Footprint(0.03175187614298335),
        Limits(2.5882270484411602, 0.02655797187687688, 1.5515068174494153, 53.338232339326794, 0.9254557648427825),
        (1000.1359921751014, -998.8626464044365),
        (1000.1526834722179, -998.9817906664115),
    )
    slow = Robot(
        "r1",
        Footprint(0.013486851925886945),
        Limits(
            0.004189749039976561, 0.08852606260344438, 0.04874256822123501, 0.4754919739950353, 0.026463921092183918
        ),
        (1000.7543712169768, -999.6534277858282),
        (1000.8067963358714, -998.7364867009483),
    )
    quick = Robot(
        "r2",
        Footprint(0.043438839388289296),
        Limits(0.3555402792624344, 0.3458759053046776, 9.373120836692133, 44.391095448162325, 0.03710383665923253),
        (1000.9859280689597, -999.7508305864815),
        (1000.7507016340205, -999.0601950408457),
    )
    columns = (
        Circle("c0", (1000.6504993360647, -999.4498628581258), 0.05116675816104535),
        Circle("c1", (1000.5784896420524, -999.4375210552158), 0.10219207777390785),
    )
    return Problem("slow", Workspace((1000.0, -1000.0, 1001.4, -998.6), 0.005), (first, slow, quick), columns)


def test_a_start_delay_is_found_in_few_steps(monkeypatch):
    """Fewer than 2,000 checks against windows for three robots."""
    checks = 0
    original = coord.timing.delay.excess

    def counted(*arguments):
        nonlocal checks
        checks += 1
        if checks > 2000:
            pytest.fail("more than 2,000 checks")
        return original(*arguments)

    monkeypatch.setattr(coord.timing.delay, "excess", counted)
    assert plan(problem()).certified
