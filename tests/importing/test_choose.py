"""The one door for all formats."""

from __future__ import annotations

import pytest

from coord.errors import BadFileError, InvalidValueError
from coord.importing.choose import import_file, write_import
from coord.importing.values import ImportOptions

WKT = "POLYGON ((0 0, 4 0, 4 4, 0 0))\n"


@pytest.mark.parametrize(
    ("name", "options", "fault"),
    [
        ("a.wkt", {"metres": True}, "a.wkt: --metres means nothing to a file that is a WKT"),
        ("a.wkt", {"occupied_below": 0.4}, "a.wkt: --occupied-below means nothing to a file that is a WKT"),
        ("a.dxf", {}, "a.dxf: its ending says nothing; known are .scen .map"),
    ],
)
def test_no_option_is_ignored_and_no_ending_guessed(refused, name, options, fault):
    """What a format has no use for is refused."""
    assert refused(name, WKT, **options)[0].startswith(fault)


def test_a_file_that_exists_is_replaced_only_by_force(tmp_path):
    """Neither read nor touched before that."""
    source, output = tmp_path / "a.wkt", tmp_path / "a.toml"
    source.write_text(WKT)
    output.write_text("mine")
    with pytest.raises(BadFileError, match="it exists already; give another name, or --force"):
        write_import(source, output, ImportOptions())
    assert output.read_text() == "mine"
    write_import(source, output, ImportOptions(force=True))
    assert output.read_text().startswith("# Imported from a.wkt.\n")


def test_importing_writes_nothing_by_itself(tmp_path):
    """The text is handed out; same input, same text."""
    source = tmp_path / "a.wkt"
    source.write_text(WKT)
    first, second = (import_file(source, tmp_path / "out" / "a.toml", ImportOptions()) for _ in range(2))
    assert first == second
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("name", ["a.scen", "a.map", "a.yaml", "a.png", "a.geojson", "a.wkt"])
def test_a_file_that_is_not_there_is_a_fault_of_its_own(tmp_path, name):
    """Whatever its format."""
    options = ImportOptions(resolution=0.1) if name == "a.png" else ImportOptions()
    with pytest.raises(BadFileError, match=f"{name}: the .* does not exist"):
        import_file(tmp_path / name, tmp_path / "a.toml", options)


@pytest.mark.parametrize(
    "options",
    [
        {"robots": 0},
        {"radius": 0.0},
        {"resolution": float("nan")},
        {"simplify": -1.0},
        {"unknown": "x"},
        {"occupied_below": 2},
    ],
)
def test_options_out_of_range_are_refused(options):
    """Each by its own rule."""
    (name,) = options
    with pytest.raises(InvalidValueError, match=name):
        ImportOptions(**options)
