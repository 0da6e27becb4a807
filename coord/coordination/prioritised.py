"""One robot after the other: each is planned against those before it, which never change any more."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from coord.coordination import diagnose
from coord.coordination.courtesy import courteous
from coord.coordination.homeward import Homeward
from coord.coordination.scene import Scene
from coord.coordination.together import plan_together
from coord.errors import NoPlanError, SolverError
from coord.model.result import Diagnosis
from coord.timing.ego import Ego
from coord.timing.meeting import Meeting
from coord.timing.passing import Timing, time_robot
from coord.timing.stopping import stop_robot


def plan_in_order(
    scene: Scene,
    order: Sequence[int],
    done: Callable[[int], None],
    time_is_up: Callable[[], bool] = lambda: False,
    *,
    profile: str = "fastest",
    method: str = "velocity",
    certify: bool = False,
    together: Mapping[tuple[int, ...], Diagnosis] | None = None,
    homeward: Mapping[tuple[int, ...], Homeward] | None = None,
) -> dict[int, Timing]:
    """A profile for every robot, each against those before it in an order that respects the blocking arcs.

    They come in the order in which they were planned.

    Parameters
    ----------
    done : called after each robot with the number of robots that have a profile.
    time_is_up : asked before each robot.
    profile : "fastest" or "gentle", as in ``time_robot``; a robot that stops always drives its legs the fastest way.
    method : "velocity" or "stop".
    certify : whether to spend the time to close the gap to each robot's certified bound, as in ``time_robot``.
    together : groups of robots that have to leave together, each planned when its first one is due; and what to say
        where that fails. ``homeward`` : of some of them, moves that bring them home.

    Raises
    ------
    NoPlanError
        When the time is up, or robots that have to leave together find no way to do so.
    """
    timings: dict[int, Timing] = {}
    group_of = {i: group for group in together or () for i in group}

    def check_time() -> None:
        if time_is_up():
            raise NoPlanError([diagnose.time_is_up(len(timings), len(order))])

    def solve(ego: Ego, meetings: list[Meeting], *, hurried: bool = False) -> Timing | None:
        return timing(ego, meetings, profile=profile, method=method, certify=certify, hurried=hurried)

    stuck: dict[tuple[int, ...], Diagnosis] = {}
    for i in order:
        check_time()
        if i in timings or group_of.get(i) in stuck:
            continue
        if i in group_of:
            group = [k for k in order if k in group_of[i]]
            moves = (homeward or {}).get(group_of[i])
            found = plan_together(scene, group, timings, solve, check_time, moves)
            if found is None:
                stuck[group_of[i]] = (together or {})[group_of[i]]
            timings.update(found or {})
            done(len(timings))
            continue
        if stuck:
            continue  # all that is left to find out is which other groups get stuck, even among few
        meetings = scene.meetings(i, [k for k in scene.neighbours[i] if k in timings], timings)
        own = timing(scene.egos[i], meetings, profile=profile, method=method, certify=certify)
        timings[i] = own or waiting(scene.egos[i], meetings)
        if method == "velocity":
            timings[i] = courteous(scene, i, timings[i], meetings, timings)
        scene.forget(i)
        done(len(timings))
    if stuck:
        raise NoPlanError(stuck.values())
    return timings


def timing(
    ego: Ego,
    meetings: list[Meeting],
    *,
    profile: str,
    method: str = "velocity",
    certify: bool = False,
    hurried: bool = False,
) -> Timing | None:
    """The profile that the timing stage finds; None where it finds none, or a library fails it."""
    try:
        if method == "stop":
            return stop_robot(ego, meetings)
        return time_robot(ego, meetings, profile=profile, certify=certify, hurried=hurried)
    except SolverError:
        return None


def waiting(ego: Ego, meetings: list[Meeting]) -> Timing:
    """Wait at the start until all that come near have arrived, then drive alone: with acyclic blocks always possible.

    Nobody who rests at its goal by then is in the way, since it would come later in the order; and the robot itself
    is in nobody's way while it waits, since it would come earlier. So this needs no check but the certificate.
    """
    last = max((meeting.profile.arrival for meeting in meetings), default=0.0)
    alone = ego.alone.shifted(max(last - ego.alone.departure, 0.0))
    return Timing(alone, tuple(sorted({meeting.other for meeting in meetings})), (), "waited")
