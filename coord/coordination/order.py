"""The order in which robots are planned: the user's priorities wherever the blocking arcs allow."""

from __future__ import annotations

import dataclasses
import heapq
from collections.abc import Sequence

from coord.model.result import BlockingArc


def urgency(priorities: Sequence[float | None], solo_arrivals: Sequence[float]) -> list[int]:
    """Robots, most urgent first: by priority, then those without one, the longest alone first, then as given."""

    def key(i: int) -> tuple[int, float, int]:
        priority = priorities[i]
        return (1, -solo_arrivals[i], i) if priority is None else (0, priority, i)

    return sorted(range(len(priorities)), key=key)


def topological_order(urgent: Sequence[int], names: Sequence[str], arcs: Sequence[BlockingArc]) -> list[int] | None:
    """An order that respects all arcs and otherwise the urgency; None where the arcs form a cycle.

    Built from the back: the least urgent robot that nothing remaining must follow goes last. Built from
    the front, an urgent robot that waits for one other would be put behind strangers.
    """
    index = {name: i for i, name in enumerate(names)}
    rank = {robot: position for position, robot in enumerate(urgent)}
    followers: list[set[int]] = [set() for _ in names]
    leaders: list[set[int]] = [set() for _ in names]
    for arc in arcs:
        followers[index[arc.first]].add(index[arc.then])
        leaders[index[arc.then]].add(index[arc.first])
    ready = [(-rank[i], i) for i in range(len(names)) if not followers[i]]
    heapq.heapify(ready)
    backwards = []
    while ready:
        _, i = heapq.heappop(ready)
        backwards.append(i)
        for leader in leaders[i]:
            followers[leader].discard(i)
            if not followers[leader]:
                heapq.heappush(ready, (-rank[leader], leader))
    return backwards[::-1] if len(backwards) == len(names) else None


def order_of_groups(
    urgent: Sequence[int], names: Sequence[str], arcs: Sequence[BlockingArc], groups: Sequence[Sequence[int]]
) -> list[int] | None:
    """The same where groups of robots are planned together: a group as urgent as its first, its robots in a row.

    Arcs inside a group do not count.
    """
    rank = {robot: position for position, robot in enumerate(urgent)}
    members = {min(group, key=rank.__getitem__): sorted(group, key=rank.__getitem__) for group in groups}
    head = {i: first for first, group in members.items() for i in group}
    called = {name: names[head.get(i, i)] for i, name in enumerate(names)}
    outer = [arc for arc in arcs if called[arc.first] != called[arc.then]]
    between = [dataclasses.replace(arc, first=called[arc.first], then=called[arc.then]) for arc in outer]
    order = topological_order(urgent, names, between)
    if order is None:
        return None
    return [k for i in order if head.get(i, i) == i for k in members.get(i, [i])]


def shortest_cycle(names: Sequence[str], arcs: Sequence[BlockingArc]) -> list[BlockingArc]:
    """A cycle with the fewest arcs, the first in the order of the names among those; empty where there is none."""
    out: dict[str, list[BlockingArc]] = {name: [] for name in names}
    for arc in arcs:
        out[arc.first].append(arc)
    best: list[BlockingArc] = []
    for name in names:
        found = _way_back(name, out, len(best) or None)
        if found and (not best or len(found) < len(best)):
            best = found
        if len(best) in (1, 2):
            break
    return best


def _way_back(name: str, out: dict[str, list[BlockingArc]], shorter_than: int | None) -> list[BlockingArc]:
    """Breadth first from a robot back to itself."""
    came: dict[str, BlockingArc] = {}
    level = [name]
    depth = 0
    while level and (shorter_than is None or depth + 1 < shorter_than):
        depth += 1
        following = []
        for at in level:
            for arc in out[at]:
                if arc.then == name:
                    cycle = [arc]
                    while cycle[0].first != name:
                        cycle.insert(0, came[cycle[0].first])
                    return cycle
                if arc.then not in came:
                    came[arc.then] = arc
                    following.append(arc.then)
        level = following
    return []
