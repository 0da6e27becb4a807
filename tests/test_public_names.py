import subprocess
import sys

import pytest

import coord


def test_importing_coord_loads_nothing_heavy():
    """Neither an optimiser nor pictures nor numpy, until a name that needs them is used."""
    code = "import sys, coord; sys.exit(bool({'casadi', 'ruckig', 'matplotlib', 'numpy'} & set(sys.modules)))"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_every_public_name_is_there():
    """Each loads from the module it lives in, and dir() lists them all."""
    assert 15 <= len(coord.__all__) <= 25
    assert set(coord.__all__) <= set(dir(coord))
    assert all(callable(getattr(coord, name)) for name in coord.__all__)


def test_an_unknown_name_is_an_error_that_lists_the_known_ones():
    """Otherwise a slip would go unnoticed until much later."""
    with pytest.raises(AttributeError, match=r"no attribute 'Robott'; it has .*Robot"):
        _ = coord.Robott


@pytest.mark.parametrize("first", ["", "import coord.plan, coord.verify.report\n", "from coord.plan import plan\n"])
def test_plan_and_verify_can_be_called_whoever_imported_their_modules_first(first: str):
    """The modules have the names of the functions, and do not hide them; they can be sent to other processes too."""
    code = first + (
        "import coord, pickle\n"
        "from coord import plan, verify\n"
        "assert plan is coord.plan and verify is coord.verify\n"
        "assert coord.verify(b'{}').verdict == 'malformed'\n"
        "assert pickle.loads(pickle.dumps(coord.verify))(b'{}').verdict == 'malformed'\n"
        "from coord.plan import plan as function\n"
        "try:\n    coord.plan()\nexcept TypeError as error:\n    assert 'problem' in str(error)\n"
        "else:\n    raise SystemExit('called without a problem')\n"
    )
    subprocess.run([sys.executable, "-W", "error", "-c", code], check=True)
