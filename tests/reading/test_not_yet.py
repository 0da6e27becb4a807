"""The one list of what cannot be done yet."""

from __future__ import annotations

import pytest

from coord.reading import not_yet


@pytest.mark.parametrize("entry", not_yet.NOT_YET, ids=lambda entry: f"{entry.table}.{entry.field}")
def test_every_refusal_reads_as_a_sentence(entry):
    """Each entry begins a sentence that ends in the same words."""
    value = {"origin": [0, 0, 1]}.get(entry.field)
    assert not_yet.refusals(entry.table, {entry.field: value})[entry.field].endswith(" is not supported yet")
