"""How all pictures look: colours, sizes, names, and the way from a figure to bytes."""

from __future__ import annotations

import io
import warnings
from collections.abc import Callable
from typing import Any, Final, TypeAlias

import matplotlib as mpl
import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.patheffects import AbstractPathEffect, withStroke
from matplotlib.text import Text

from coord.errors import InvalidValueError
from coord.model.arrays import Array
from coord.model.result import Plan, RobotPlan

LineStyle: TypeAlias = str | tuple[float, tuple[float, ...]]

#: Nine colours that stay apart for colour-blind eyes too (Paul Tol, "muted"), the darker ones first.
COLOURS: Final = ("#332288", "#CC6677", "#117733", "#DDAA33", "#88CCEE", "#882255", "#44AA99", "#999933", "#AA4499")

#: Line styles that tell robots of the same colour apart.
DASHES: Final[tuple[LineStyle, ...]] = ("solid", (0, (6, 1.5)), (0, (2, 1.5)), (0, (6, 1.5, 1.5, 1.5)))

#: Hatches that do the same for areas.
HATCHES: Final = ("", "////", "....", "xxxx")

INK: Final = "#222222"
GREY: Final = "#777777"
OBSTACLE: Final = "#9A9A9A"
ALARM: Final = "#BB3333"

#: [s] A smaller delay rounds to 0.00 s.
LATE: Final = 0.005

#: [dots per inch] of the files.
RESOLUTION: Final = 120

_SETTINGS: Final[dict[Any, Any]] = {
    "font.family": "DejaVu Sans",  # comes with matplotlib, so every machine draws the same letters
    "font.size": 9,
    "axes.titlesize": 10,
    "axes.labelsize": 9,
    "axes.edgecolor": INK,
    "axes.linewidth": 0.8,
    "axes.titlelocation": "left",
    "hatch.linewidth": 0.5,
    "legend.frameon": False,
    "legend.fontsize": 8.5,
    "savefig.dpi": RESOLUTION,
}


def png(draw: Callable[[], Figure]) -> bytes:
    """Draw with our settings, whatever the user's are, and return the bytes of the PNG, without metadata."""
    buffer = io.BytesIO()
    with mpl.rc_context(), warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Glyph .* missing from font")  # names may have any letters
        mpl.rcdefaults()
        mpl.rcParams.update(_SETTINGS)
        draw().savefig(buffer, format="png", metadata={"Software": None})
    return buffer.getvalue()


def new_figure(width: float, height: float) -> Figure:
    """An empty figure of this size [inch], laid out so that titles and legends find room."""
    return Figure(figsize=(width, height), layout=ConstrainedLayoutEngine(w_pad=0.12, h_pad=0.06))


def figure_of(ax: Axes) -> Figure:
    """The figure that axes belong to."""
    figure = ax.get_figure(root=True)
    if figure is None:
        raise InvalidValueError([("ax", "these axes belong to no figure; make them with figure.add_subplot()")])
    return figure


def colour(k: int) -> str:
    """The colour of the k-th robot of a plan."""
    return COLOURS[k % len(COLOURS)]


def dashes(k: int) -> LineStyle:
    """The line style of the k-th robot of a plan."""
    return DASHES[k // len(COLOURS) % len(DASHES)]


def hatch(k: int) -> str:
    """The hatch of the k-th robot's areas."""
    return HATCHES[k // len(COLOURS) % len(HATCHES)]


def shown(name: str, longest: int = 24) -> str:
    """A robot's name as matplotlib shall show it: cut, in one line, without mathematics or hidden labels."""
    name = " ".join(name.split())
    name = name if len(name) <= longest else name[: longest - 1] + "…"
    name = name.replace("$", r"\$")
    return f" {name}" if name.startswith("_") else name


def find(plan: Plan, name: str) -> RobotPlan:
    """The robot of this name.

    Raises
    ------
    InvalidValueError
        When the plan has none.
    """
    for robot in plan.robots:
        if robot.robot.name == name:
            return robot
    names = ", ".join(robot.robot.name for robot in plan.robots[:12])
    more = f" and {len(plan.robots) - 12} more" if len(plan.robots) > 12 else ""
    raise InvalidValueError([("robot", f'no robot is named "{name}"; the plan has {names}{more}')])


def delay(robot: RobotPlan) -> float:
    """How much later than alone a robot arrives [s]."""
    return robot.arrival - robot.solo_arrival


def is_late(robot: RobotPlan) -> bool:
    """Whether a robot is delayed by more than rounds to 0.00 s."""
    return delay(robot) > LATE


def points(ax: Axes, places: npt.ArrayLike) -> Array:
    """Places (n, 2) of the axes as points (n, 2) [pt] of the figure, once its layout is done."""
    pixels = ax.transData.transform(np.asarray(places, dtype=np.float64).reshape(-1, 2))
    return np.asarray(pixels * 72 / figure_of(ax).dpi)


def text_size(text: Text) -> tuple[float, float]:
    """Width and height of a text [pt]."""
    box, figure = text.get_window_extent(), text.get_figure(root=True)
    point = figure.dpi / 72 if figure is not None else 1.0
    return float(box.width / point), float(box.height / point)


def halo(width: float = 2.2) -> list[AbstractPathEffect]:
    """A white border round letters and lines, so that they are seen on any ground."""
    return [withStroke(linewidth=width, foreground="white")]
