"""Lines of values in TOML texts."""

from __future__ import annotations

import time
import tomllib

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from coord.reading.locate import Locator

TEXT = '''\
# a comment with [brackets] and "quotes
format = "x" # [robots]
prose = """
[robots]
name = "not a key"
ends with quotes ""\\""""""
"quo.ted" . b = 3
[workspace]
bounds = [ # ] "
  0.0, 1, # , [
  [2, 3],
]
lit = \'\'\'a"""[
\'\'\'
d.e.f = 1

[[robots]]
name = "a#b]"
footprint = { disc = 0.3, "s]" = [1, { x.y = 2 }] }
[[robots]] # second
start = [1, 2] # a comment
[robots.sub]
k = 1
  [[robots.sub.list]]
  q = 1
  [[robots.sub.list]]
  q = 2
[[robots]]
x = 'a\\'
footprint.disc = 3
inline = [{ a = 1 }, { a = 2 },
  { b = [1,
 2] }]
'''

LINES = [
    ((), 1),
    (("format",), 2),
    (("prose",), 3),
    (("quo.ted", "b"), 7),
    (("workspace",), 8),
    (("workspace", "bounds"), 9),
    (("workspace", "bounds", 0), 10),
    (("workspace", "bounds", 2, 1), 11),
    (("workspace", "lit"), 13),
    (("workspace", "d", "e"), 15),
    (("robots",), 17),
    (("robots", 0), 17),
    (("robots", 0, "name"), 18),
    (("robots", 0, "footprint", "s]", 1, "x"), 19),
    (("robots", 1), 20),
    (("robots", 1, "start", 1), 21),
    (("robots", 1, "sub"), 22),
    (("robots", 1, "sub", "list", 1, "q"), 27),
    (("robots", 2, "x"), 29),
    (("robots", 2, "footprint"), 30),
    (("robots", 2, "footprint", "disc"), 30),
    (("robots", 2, "inline", 1, "a"), 31),
    (("robots", 2, "inline", 2, "b", 1), 33),
]


@pytest.mark.parametrize(("path", "line"), LINES)
def test_every_value_is_found_on_its_line(path, line):
    """Comments, strings of all kinds, arrays over lines, inline tables, dotted and quoted keys do not lead astray."""
    assert tomllib.loads(TEXT)["robots"][2]["inline"][2] == {"b": [1, 2]}  # the text is TOML
    assert Locator(TEXT).line(path) == line


@pytest.mark.parametrize(
    ("path", "line"),
    [
        (("nothing",), 1),
        (("workspace", "clearance"), 8),
        (("workspace", "bounds", 7), 9),
        (("robots", 1, "goal"), 20),
        (("robots", 9, "goal"), 17),
        (("robots", 0, "footprint", "square"), 19),
        (("robots", 0, "name", "x", 0), 18),
    ],
)
def test_what_is_not_there_is_placed_at_what_encloses_it(path, line):
    """A missing value is placed at its table, a missing item at its array."""
    assert Locator(TEXT).line(path) == line


def test_ten_thousand_inline_tables_are_walked_once():
    """All values of a long list are found in one walk over it, not in one walk each."""
    text = "robots = [" + ",\n".join("{ name = 'a', start = [1, 2], speed = 1 }" for _ in range(10_000)) + "]\n"
    started = time.perf_counter()
    locator = Locator(text)
    assert [locator.line(("robots", k, "speed")) for k in range(10_000)] == list(range(1, 10_001))
    assert time.perf_counter() - started < 10  # 0.3 s when it was written; quadratic would be minutes


@given(
    st.lists(
        st.tuples(
            st.sampled_from(["1", '"#"', "'['", "[1, 2]", "[\n1, # ]\n2,\n]", '"""\nx = 1\n"""', "{ a = 1 }", "true"]),
            st.sampled_from(["", " # comment", "\n\n# x = 1", "\t"]),
        ),
        min_size=1,
        max_size=20,
    )
)
def test_keys_are_found_wherever_they_are_written(statements):
    """Whatever stands before it, a key is found on the line it was written on."""
    text, lines = "", []
    for k, (value, after) in enumerate(statements):
        lines.append(text.count("\n") + 1)
        text += f"k{k} = {value}{after}\n"
    assert len(tomllib.loads(text)) == len(statements)
    locator = Locator(text)
    assert [locator.line((f"k{k}",)) for k in range(len(statements))] == lines


@example('"\\1"', [])  # a key with an escape that TOML does not know
@given(st.text(alphabet="a.=[]{}\"'#,\n \\1"), st.lists(st.one_of(st.sampled_from(["a", "1"]), st.integers(0, 3))))
def test_a_locator_never_fails(text, path):
    """Any text whatever gives a line that it has."""
    assert 1 <= Locator(text).line(tuple(path)) <= text.count("\n") + 1
