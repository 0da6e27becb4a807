"""Rings of robots that all have to go before each other: the cycles of the blocking graph."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from coord.coordination.blocking import Block


def rings(members: Iterable[int], blocks: Iterable[Block]) -> list[list[int]]:
    """The strongly connected components with more than one robot, each ascending, in the order of their first.

    Only blocks between members count. Without rings there is an order that respects all blocks (Tarjan 1972, with a
    stack of its own, since chains of blocks may be longer than Python's).
    """
    out: dict[int, list[int]] = {i: [] for i in sorted(members)}
    for block in blocks:
        if block.first in out and block.then in out:
            out[block.first].append(block.then)
    number: dict[int, int] = {}
    lowest: dict[int, int] = {}
    path: list[int] = []
    on_path: set[int] = set()
    found = []
    for root in out:
        if root in number:
            continue
        calls = [(root, iter(out[root]))]
        number[root] = lowest[root] = len(number)
        path.append(root)
        on_path.add(root)
        while calls:
            i, following = calls[-1]
            step = next((k for k in following if k not in number or k in on_path), None)
            if step is None:
                calls.pop()
                if calls:
                    above = calls[-1][0]
                    lowest[above] = min(lowest[above], lowest[i])
                if lowest[i] == number[i]:
                    found.append(_cut_off(path, on_path, i))
            elif step in number:
                lowest[i] = min(lowest[i], number[step])
            else:
                number[step] = lowest[step] = len(number)
                path.append(step)
                on_path.add(step)
                calls.append((step, iter(out[step])))
    return sorted(ring for ring in found if len(ring) > 1)


def _cut_off(path: list[int], on_path: set[int], root: int) -> list[int]:
    """Take the component that begins at its root from the path."""
    component: list[int] = []
    while not component or component[-1] != root:
        component.append(path.pop())
    on_path.difference_update(component)
    return sorted(component)


def cycle_through(member: int, blocks: Sequence[Block]) -> list[Block]:
    """Blocks of a shortest cycle through a robot, breadth first; empty where there is none."""
    out: dict[int, list[Block]] = {}
    for block in blocks:
        out.setdefault(block.first, []).append(block)
    came: dict[int, Block] = {}
    level = [member]
    while level:
        following = []
        for i in level:
            for block in out.get(i, ()):
                if block.then in came:
                    continue
                came[block.then] = block
                if block.then == member:
                    return _back(member, came)
                following.append(block.then)
        level = following
    return []


def _back(member: int, came: dict[int, Block]) -> list[Block]:
    cycle = [came[member]]
    while cycle[0].first != member:
        cycle.insert(0, came[cycle[0].first])
    return cycle
