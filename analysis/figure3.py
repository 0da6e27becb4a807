"""Every shape of a detour on one floor each: ``python analysis/figure3.py``.

Two scenes, one robot: a box across the straight line, and a bay open towards the start. All shapes are drawn
over each other, with the length and the time of each, measured alone from rest to rest. Writes
``problems/seed/shapes.png`` and ``analysis/figure3.csv``.
"""

from __future__ import annotations

import csv
from pathlib import Path as File
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from coord.alone.fastest import fastest
from coord.geometry.growth import grow
from coord.model.arrays import Point
from coord.model.footprint import Footprint
from coord.model.obstacle import Polygon, rectangle
from coord.model.path import Path, straight
from coord.model.problem import Problem, Workspace
from coord.model.robot import Limits, Robot
from coord.model.route import Shaped
from coord.output.plots.outlines import line
from coord.output.plots.style import COLOURS, GREY, INK, halo, new_figure, png
from coord.output.plots.surroundings import draw_surroundings
from coord.paths.exponential import exponential
from coord.paths.fitted import fitted
from coord.paths.follow import follow
from coord.paths.skeleton import NoWay, search_floor, skeleton
from coord.paths.taut import taut

HERE = File(__file__).resolve().parent
LIMITS = Limits(speed=1.0, acceleration=0.5, deceleration=0.5, jerk=1.0, lateral_acceleration=0.5)
FOOTPRINT, CLEARANCE = Footprint(0.35), 0.15

#: How each shape is drawn, the widest line first; and what it is, for the table.
SHAPES: dict[str, dict[str, Any]] = {
    "follow": {"color": COLOURS[1], "lw": 2.0, "ls": (0, (1.2, 1.0))},
    "exponential": {"color": COLOURS[2], "lw": 2.0, "ls": (0, (6, 1.5))},
    "fitted": {"color": COLOURS[0], "lw": 2.4, "ls": "solid"},
    "taut": {"color": COLOURS[3], "lw": 1.6, "ls": (0, (3, 1.2))},
}
TOLD = {
    "fitted": "every turn as wide as pays (default)",
    "exponential": "least-squares exponentials on the line",
    "taut": "the shortest; its 0.5 m arcs are driven at half speed",
    "follow": "along the edge and back; corners of 0.2 m are slow",
}


class Scene(NamedTuple):
    """One floor, and what it is about."""

    name: str
    title: str
    bounds: tuple[float, float, float, float]
    obstacle: Polygon
    start: Point
    goal: Point


SCENES = (
    Scene(
        "box",
        "A box across the straight line",
        (0.0, 0.0, 18.0, 7.4),
        rectangle("box", (7.2, 1.7, 10.8, 4.9)),
        (1.4, 3.7),
        (16.6, 3.7),
    ),
    Scene(
        "bay",
        "A bay that opens towards the start",
        (0.0, 0.0, 18.0, 7.4),
        Polygon(
            "bay", [(6.2, 1.4), (11.6, 1.4), (11.6, 5.2), (6.2, 5.2), (6.2, 4.6), (10.9, 4.6), (10.9, 2.0), (6.2, 2.0)]
        ),
        (1.4, 3.7),
        (16.6, 3.7),
    ),
)


def shapes(scene: Scene) -> dict[str, Shaped]:
    """All shapes of the path of one scene, the straight line of a free floor first."""
    floor = search_floor(grow([scene.obstacle], FOOTPRINT, CLEARANCE, scene.bounds), [scene.start, scene.goal])
    bones = skeleton(floor, scene.start, scene.goal)
    if isinstance(bones, NoWay):
        raise SystemExit(f"{scene.name}: there is no way")
    found = {
        "taut": Shaped(_is_path(taut(bones, floor)), "taut"),
        "fitted": Shaped(_is_path(fitted(bones, LIMITS, floor)), "fitted"),
        "exponential": exponential(bones, LIMITS, floor),
        "follow": follow(floor, scene.start, scene.goal, LIMITS),
    }
    return {name: shaped for name, shaped in found.items() if isinstance(shaped, Shaped)}


def _is_path(path: Path | None) -> Path:
    if path is None:
        raise SystemExit("a shape has no path")
    return path


def rows(scene: Scene, found: dict[str, Shaped]) -> list[tuple[str, str, float, float, str]]:
    """Scene, shape, length [m], time [s], remarks; the quickest first."""
    table = [
        (scene.name, name, one.path.length, fastest(one.path, LIMITS).arrival, " ".join(one.remarks))
        for name, one in found.items()
    ]
    free = straight(scene.start, scene.goal)
    return [
        *sorted(table, key=lambda row: row[3]),
        (scene.name, "straight", free.length, fastest(free, LIMITS).arrival, "if nothing were in the way"),
    ]


def draw() -> Figure:
    """Both scenes, one above the other, each with its table."""
    figure = new_figure(11.4, 7.6)
    figure.suptitle("Four shapes of a detour for the same robot: the shortest is not the quickest", x=0.01, ha="left")
    grid = figure.add_gridspec(2, 2, width_ratios=(7.2, 4.2))
    for k, scene in enumerate(SCENES):
        found = shapes(scene)
        ax, words = figure.add_subplot(grid[k, 0]), figure.add_subplot(grid[k, 1])
        _floor(ax, scene, found)
        _table(words, rows(scene, found), found, last=k == len(SCENES) - 1)
    return figure


def _floor(ax: Axes, scene: Scene, found: dict[str, Shaped]) -> None:
    robot = Robot("robot", FOOTPRINT, LIMITS, scene.start, scene.goal)
    draw_surroundings(ax, Problem("", Workspace(scene.bounds, CLEARANCE), (robot,), (scene.obstacle,)))
    ax.plot(*np.array([scene.start, scene.goal]).T, color=GREY, lw=1.0, ls=":", zorder=3.6)
    for name, style in SHAPES.items():
        ax.plot(*line(found[name].path)[:, :2].T, zorder=4, path_effects=halo(style["lw"] + 1.0), **style)
    ax.add_patch(Circle(scene.start, FOOTPRINT.radius, fc=INK, ec="white", zorder=6))
    ax.add_patch(Circle(scene.goal, FOOTPRINT.radius, fc="white", ec=INK, lw=1.8, zorder=6))
    for place, word in ((scene.start, "start"), (scene.goal, "goal")):
        ax.annotate(word, place, (0, -15), textcoords="offset points", ha="center", va="top", zorder=7)
    xmin, ymin, xmax, ymax = scene.bounds
    ax.set(xlim=(xmin, xmax), ylim=(ymin, ymax), xlabel="x [m]", ylabel="y [m]", aspect="equal", title=scene.title)


def _table(ax: Axes, table: list[tuple[str, str, float, float, str]], found: dict[str, Shaped], last: bool) -> None:
    ax.set_axis_off()
    ax.set(xlim=(0, 1), ylim=(0, 1))
    ax.text(0.68, 0.97, "length", ha="right")
    ax.text(0.98, 0.97, "time", ha="right")
    y = 0.86
    for _, name, length, time, _ in table:
        style = SHAPES.get(name, {"color": GREY, "lw": 1.0, "ls": ":"})
        ax.plot([0.0, 0.11], [y + 0.018] * 2, **style)
        ax.text(
            0.14, y, "straight line" if name == "straight" else name, weight="bold" if name == "fitted" else "normal"
        )
        ax.text(0.68, y, f"{length:.2f} m", ha="right")
        ax.text(0.98, y, f"{time:.2f} s", ha="right")
        told = TOLD.get(name, "if nothing were in the way")
        ax.text(0.14, y - 0.058, told, fontsize=7.5, color=GREY)
        y -= 0.155
    notes = [
        f"{fit.flank}: y = {fit.A:.3g} exp({fit.B:+.3g} x), R² = {fit.r_squared:.3f}"
        for fit in found["exponential"].fits
    ]
    if last:
        notes.append("dashed, grey: no nearer may its centre come")
    for note in notes:
        ax.text(0.0, y, note, fontsize=7.5, color=INK)
        y -= 0.06


def main() -> None:
    """Write the picture and the figures."""
    (HERE.parent / "problems" / "seed" / "shapes.png").write_bytes(png(draw))
    with (HERE / "figure3.csv").open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow(("scene", "shape", "length [m]", "time [s]", "remarks"))
        for scene in SCENES:
            for name, shape, length, time, remark in rows(scene, shapes(scene)):
                writer.writerow((name, shape, f"{length:.3f}", f"{time:.3f}", remark))
                print(f"{name:<5}{shape:<13}{length:>8.3f} m{time:>8.3f} s  {remark}")


if __name__ == "__main__":
    main()
