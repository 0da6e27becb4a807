"""Rings of robots that block each other are opened: as few robots as possible leave their quickest paths.

A block belongs to the robot that drives over the place where another rests: on a way round that place it vanishes.
Only where the robot itself must stand there, or its path is given, it stays.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import InitVar, dataclass, field, replace
from itertools import groupby, islice

from coord.conflicts.candidates import candidate_pairs
from coord.conflicts.chords import chords
from coord.coordination.blocking import Block, find_blocks, in_order, reaches_of, whose_place
from coord.coordination.rings import cycle_through, rings
from coord.coordination.way_round import Rests, Way, rests, way_round
from coord.model.problem import Problem
from coord.model.route import Route

#: Of robots that would open a ring equally well, so many ways round are compared by their times.
_MOST_COMPARED = 8

#: Ways round one place of a ring that are sought in all: where these are needed, there are many places, as a rule,
#: and robots that go round one after the other of them still leave the ring shut.
_MOST_ROUND_ONE = 60

#: From so many robots of a ring that stays a short cycle is sought.
_MOST_BEGINNINGS = 100


@dataclass(frozen=True, slots=True, eq=False)
class Rerouting:
    """What came of it.

    Parameters
    ----------
    routes, blocks : of all robots; without rings unless ``left`` has some.
    around : for each robot on a new path the blocks that it went round, and the robots of their ring.
    left : one cycle for each ring that could not be opened, and ``together`` its robots: they have to leave together.
    beside : for each robot of those that leaves others room to pass, which of them.
    """

    routes: tuple[Route, ...]
    blocks: tuple[Block, ...]
    around: dict[int, tuple[tuple[Block, ...], tuple[int, ...]]]
    left: tuple[tuple[Block, ...], ...] = ()
    together: tuple[tuple[int, ...], ...] = ()
    beside: Mapping[int, tuple[int, ...]] = field(default_factory=dict)

    def on(self, i: int, way: Way, beside: tuple[int, ...]) -> Rerouting:
        """The same with one robot on another way, which leaves room to those ``beside`` it."""
        routes = (*self.routes[:i], way.route, *self.routes[i + 1 :])
        blocks = sorted((*(block for block in self.blocks if block.driving != i), *way.blocks), key=in_order)
        return replace(self, routes=routes, blocks=tuple(blocks), beside={**self.beside, i: beside})

    @property
    def between(self) -> tuple[Block, ...]:
        """The blocks but for those inside groups that have to leave together: some order respects all of these."""
        group = {i: number for number, members in enumerate(self.together) for i in members}
        return tuple(block for block in self.blocks if group.get(block.first, -1) != group.get(block.then, -2))


def without_rings(
    problem: Problem,
    quickest: Sequence[Route],
    shape: str,
    *,
    keep_paths: bool,
    done: Callable[[int, int], None],
    check_time: Callable[[], None] = lambda: None,
) -> Rerouting:
    """Find out who blocks whom on the quickest routes, and open the rings; see ``reroute``."""
    robots, workspace = problem.robots, problem.workspace
    paths = [route.path for route in quickest]
    pairs = candidate_pairs([chords(path) for path in paths], reaches_of(robots, workspace.clearance))
    blocks = find_blocks(robots, paths, pairs, workspace.clearance, stay=workspace.after_arrival == "stay")
    return reroute(problem, quickest, blocks, shape, keep_paths=keep_paths, done=done, check_time=check_time)


def reroute(
    problem: Problem,
    routes: Sequence[Route],
    blocks: Sequence[Block],
    shape: str = "fitted",
    *,
    keep_paths: bool = False,
    done: Callable[[int, int], None] = lambda count, total: None,
    check_time: Callable[[], None] = lambda: None,
) -> Rerouting:
    """Open all rings of the blocking graph that can be opened.

    While there is a ring, a robot of it is sent round all places where others rest: one that opens the ring alone if
    there is one, else one with the most blocks in the ring; of equals the one that loses the least time. In the end
    every robot whose quickest path closes no ring any more gets it back. A new path never runs over a place that
    the old one did not, so no new rings come about.

    Parameters
    ----------
    keep_paths : all robots keep their paths, and the rings stay.
    done : called with the robots that are in no ring any more, and how many there were.
    check_time : called before each search of a way; may raise.
    """
    whole = rings(range(len(routes)), blocks)
    if not whole or keep_paths:
        return _rerouting(routes, blocks, {})
    search = _Search(problem, list(routes), blocks, shape, check_time)
    total = still = sum(map(len, whole))
    for ring in whole:
        todo = [ring]
        while todo:
            part = todo.pop()
            chosen = search.choose(part)
            if chosen is None:
                continue
            search.take(*chosen, part)
            smaller = rings(part, search.within(part))
            todo += smaller
            if free := len(part) - sum(map(len, smaller)):
                still -= free
                done(total - still, total)
        search.give_back(ring)
    around = {i: (search.gone_round(i), search.ring_of[i]) for i in sorted(search.ring_of)}
    return _rerouting(search.routes, search.blocks(), around)


def _rerouting(
    routes: Sequence[Route],
    blocks: Sequence[Block],
    around: dict[int, tuple[tuple[Block, ...], tuple[int, ...]]],
) -> Rerouting:
    left = rings(range(len(routes)), blocks)
    return Rerouting(tuple(routes), tuple(blocks), around, _cycles(left, blocks), tuple(map(tuple, left)))


def _cycles(left: Sequence[Sequence[int]], blocks: Sequence[Block]) -> tuple[tuple[Block, ...], ...]:
    """A short cycle of each ring; of a huge ring not the shortest, which would take long to find."""
    found = []
    for ring in left:
        members = set(ring)
        inside = [block for block in blocks if block.first in members and block.then in members]
        found.append(min((cycle_through(i, inside) for i in ring[:_MOST_BEGINNINGS]), key=len))
    return tuple(tuple(cycle) for cycle in found)


@dataclass(slots=True, eq=False)
class _Search:
    """Who is on which path while rings are opened; ``driven`` : the blocks that belong to each robot.

    ``left`` : ways round one place that may still be sought.
    """

    problem: Problem
    routes: list[Route]
    graph: InitVar[Sequence[Block]]
    shape: str
    check_time: Callable[[], None]
    known: Rests = field(init=False)
    first: tuple[Route, ...] = field(init=False)
    driven: list[frozenset[Block]] = field(init=False)
    driven_first: tuple[frozenset[Block], ...] = field(init=False)
    ring_of: dict[int, tuple[int, ...]] = field(init=False, default_factory=dict)
    staying: dict[Block, bool] = field(init=False, default_factory=dict)
    ways: dict[tuple[int, frozenset[Block]], Way | None] = field(init=False, default_factory=dict)
    left: int = field(init=False, default=_MOST_ROUND_ONE)

    def __post_init__(self, graph: Sequence[Block]) -> None:
        self.known, self.first = rests(self.problem), tuple(self.routes)
        own: list[list[Block]] = [[] for _ in self.routes]
        for block in graph:
            own[block.driving].append(block)
        self.driven = [frozenset(blocks) for blocks in own]
        self.driven_first = tuple(self.driven)

    def blocks(self) -> tuple[Block, ...]:
        """The whole graph as it is now, in the order of the pairs."""
        return tuple(sorted((block for own in self.driven for block in own), key=in_order))

    def within(self, ring: Collection[int]) -> list[Block]:
        """The blocks between the robots of a ring."""
        members = set(ring)
        return [block for i in ring for block in sorted(self.driven[i], key=in_order) if block.resting in members]

    def stays(self, block: Block) -> bool:
        """Whether no new path takes a block away."""
        if block not in self.staying:
            robots, clearance = self.problem.robots, self.problem.workspace.clearance
            given = bool(robots[block.driving].path)
            self.staying[block] = given or bool(whose_place(block, robots, clearance))
        return self.staying[block]

    def choose(self, ring: Sequence[int]) -> tuple[int, Way] | None:
        """The robot of a ring that is to leave its path, with its new one; None where nobody can."""
        inside = self.within(ring)
        among = set(inside)
        movable = {i: frozenset(b for b in self.driven[i] if b in among and not self.stays(b)) for i in ring}
        enough = _enough_alone(ring, inside, movable)

        def rank(i: int) -> tuple[bool, int]:
            return (i not in enough, -len(movable[i]))

        candidates = sorted((i for i in ring if movable[i]), key=rank)
        for search in (self._round_all, self._round_one):
            for _, equals in groupby(candidates, key=rank):
                found = ((i, way) for i in equals if (way := search(i, movable[i])) is not None)
                best = min(
                    islice(found, _MOST_COMPARED), key=lambda one: self._extra(one[0], one[1].route), default=None
                )
                if best is not None:
                    return best
        return None

    def take(self, i: int, way: Way, ring: Sequence[int]) -> None:
        """Give a robot its new path."""
        self.routes[i], self.driven[i] = way.route, way.blocks
        self.ring_of.setdefault(i, tuple(ring))

    def give_back(self, ring: Sequence[int]) -> None:
        """Give robots of what was a ring their quickest paths back where no ring comes of it, the slowest first."""
        changed = [i for i in ring if i in self.ring_of]
        left = rings(ring, self.within(ring))
        for i in sorted(changed, key=lambda i: -self._extra(i, self.routes[i])):
            now = self.routes[i], self.driven[i]
            self.routes[i], self.driven[i] = self.first[i], self.driven_first[i]
            if rings(ring, self.within(ring)) != left:
                self.routes[i], self.driven[i] = now
            else:
                del self.ring_of[i]

    def gone_round(self, i: int) -> tuple[Block, ...]:
        """The blocks of its ring that a robot's new path took away."""
        gone = self.driven_first[i] - self.driven[i]
        return tuple(sorted((block for block in gone if block.resting in self.ring_of[i]), key=in_order))

    def _extra(self, i: int, route: Route) -> float:
        return route.time - self.first[i].time

    def _round_all(self, i: int, movable: frozenset[Block]) -> Way | None:
        """Round everybody; where there is no such way, at least round those of the ring."""
        everybody = frozenset(block for block in self.driven_first[i] if not self.stays(block))
        return self._way(i, everybody) or self._way(i, movable)

    def _round_one(self, i: int, movable: frozenset[Block]) -> Way | None:
        """Round one place of the ring; in large problems not as often as there are places."""
        for block in sorted(movable, key=in_order):
            if self.left <= 0:
                return None
            self.left -= 1
            way = self._way(i, frozenset([block]))
            if way is not None:
                return way
        return None

    def _way(self, i: int, gone: frozenset[Block]) -> Way | None:
        """A path without these blocks, without those that are gone already, and without any that there never were."""
        gone |= self.driven_first[i] - self.driven[i]
        if (i, gone) not in self.ways:
            self.check_time()
            allowed = self.driven_first[i] - gone
            self.ways[i, gone] = way_round(self.known, i, self.first[i], allowed, self.shape)
        return self.ways[i, gone]


def _enough_alone(
    ring: Sequence[int], inside: Sequence[Block], movable: Mapping[int, frozenset[Block]]
) -> frozenset[int]:
    """The robots of which each opens a ring alone: each drives over a place on any of its cycles, so one shows them."""
    cycle = {(block.first, block.then) for block in cycle_through(ring[0], inside)}
    drivers = {block.driving for block in inside if (block.first, block.then) in cycle}
    return frozenset(i for i in drivers if not rings(ring, [block for block in inside if block not in movable[i]]))
