"""The one list of what cannot be done yet."""

from __future__ import annotations

import pytest

from coord.reading import not_yet
from coord.reading.form import FileForm, RobotForm, WorkspaceForm

FORMS = {"file": FileForm, "workspace": WorkspaceForm, "robot": RobotForm}


def test_every_entry_names_a_field_that_there_is():
    """A misspelt entry would refuse nothing; fields of maps are checked where maps are read."""
    named = {(entry.table, entry.field) for entry in not_yet.NOT_YET if entry.table != "map"}
    assert named
    assert all(field in FORMS[table].model_fields for table, field in named)


def test_what_leaves_the_list_is_no_longer_refused(read, good, faults_of, monkeypatch):
    """The list alone decides: whoever builds a feature removes its entry."""
    text = good.replace('"stay"', '"leave"')
    assert len(faults_of(text)) == 1
    rest = tuple(entry for entry in not_yet.NOT_YET if entry.field != "after_arrival")
    monkeypatch.setattr(not_yet, "NOT_YET", rest)
    assert read(text).workspace.after_arrival == "leave"


@pytest.mark.parametrize("entry", not_yet.NOT_YET, ids=lambda entry: f"{entry.table}.{entry.field}")
def test_every_refusal_reads_as_a_sentence(entry):
    """Each entry begins a sentence that ends in the same words."""
    value = {"after_arrival": "leave", "origin": [0, 0, 1]}.get(entry.field)
    assert not_yet.refusals(entry.table, {entry.field: value})[entry.field].endswith(" is not supported yet")
