"""What can be had from ``coord``, and how little importing it loads."""

from __future__ import annotations

import pickle
import subprocess
import sys
import types

import pytest

import coord
import coord.plan
import coord.verify


def test_importing_coord_loads_nothing_heavy():
    """Neither an optimiser nor pictures nor numpy, until a name that needs them is used."""
    code = (
        "import sys, coord; sys.exit(bool({'casadi', 'ruckig', 'matplotlib', 'numpy', 'shapely'} & set(sys.modules)))"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_planning_loads_no_pictures():
    """matplotlib is for the plots only; the checker needs no third-party package at all."""
    heavy = "{'numpy', 'casadi', 'ruckig', 'matplotlib', 'shapely', 'pydantic', 'typer', 'rich', 'PIL', 'yaml'}"
    for module, names in (("coord.plan", "{'matplotlib'}"), ("coord.verify", heavy)):
        code = f"import sys, {module}; sys.exit(bool({names} & set(sys.modules)))"
        subprocess.run([sys.executable, "-c", code], check=True)


def test_every_public_name_is_there():
    """Each loads from the module it lives in, and dir() lists them all."""
    assert 15 <= len(coord.__all__) <= 25
    assert set(coord.__all__) <= set(dir(coord))
    assert all(callable(getattr(coord, name)) for name in coord.__all__)
    assert all(getattr(coord, name).__module__.startswith("coord.") for name in coord.__all__)


def test_an_unknown_name_is_an_error_that_lists_the_known_ones():
    """Otherwise a slip would go unnoticed until much later."""
    with pytest.raises(AttributeError, match=r"no attribute 'Robott'; it has .*Robot"):
        _ = coord.Robott


@pytest.mark.parametrize("first", ["", "import coord.verify.report\n", "import coord.plan, coord.cli\n"])
def test_the_two_verbs_live_in_modules_of_their_own_name(first: str):
    """``coord.plan`` and ``coord.verify`` are modules, whatever was imported before, and hold the functions."""
    code = first + (
        "import types\n"
        "from coord.plan import plan\n"
        "from coord.verify import verify\n"
        "import coord\n"
        "assert isinstance(coord.plan, types.ModuleType) and coord.plan.plan is plan\n"
        "assert isinstance(coord.verify, types.ModuleType) and coord.verify.verify is verify\n"
        "assert verify(b'{}').verdict == 'malformed'\n"
    )
    subprocess.run([sys.executable, "-W", "error", "-c", code], check=True)


def test_the_verbs_can_be_sent_to_other_processes():
    """Both functions survive pickling as themselves."""
    for verb in (coord.plan.plan, coord.verify.verify):
        assert isinstance(verb, types.FunctionType)
        assert pickle.loads(pickle.dumps(verb)) is verb  # noqa: S301
