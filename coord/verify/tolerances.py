"""The checker's own margins: name, value, unit and reason. They are not the planner's, on purpose."""

from typing import Final

#: [m] A distance may fall short of what is asked by this much: two poses may touch exactly, and doubles
#: resolve 1e-10 m at the largest coordinate.
DISTANCE: Final = 1e-9

#: [m] The end of one phase and the state written at the next knot may differ by this much.
POSITION: Final = 1e-9

#: [m/s] The same for speeds; also how far below zero a speed may round.
SPEED: Final = 1e-9

#: [m/s2] The same for accelerations.
ACCELERATION: Final = 1e-9

#: [s] The same for times.
TIME: Final = 1e-9

#: [1] A limit may be exceeded by this share of itself, and a reported sum may differ by it.
RELATIVE: Final = 1e-9

#: [s] A robot's own lower bound may exceed the fastest motion along its line by this much.
BOUND: Final = 1e-6

#: [1] Rounding of one step of a chain, relative to the numbers in it; the ends of long chains may differ by the sum.
ROUNDING: Final = 1e-15

#: [m] The least clearance is found to within this.
RESOLUTION: Final = 5e-7

#: [m] A motion is cut where it passes from one piece of its path to the next, to within this.
PIECE_END: Final = 1e-11

#: [1/m] Less curvature than this is none: over 1e6 m it bends by 1e-18 m, and its reciprocal may not be a number.
FLAT: Final = 1e-30

#: [m] Boxes of the coarse search are wider by this, so that no rounding can part what touches.
BOX: Final = 1e-6

#: [m] Coordinates and lengths beyond this are refused: doubles no longer resolve the margins above.
LARGEST_COORDINATE: Final = 1e6

#: [s] The same for times: 1e-10 s at this time.
LARGEST_TIME: Final = 1e6

#: [any] No number of a plan is larger; products of three of them stay far from the end of the doubles.
LARGEST_NUMBER: Final = 1e12

#: [rad] A path that turns more than this in all is refused: it would be cut into too many pieces.
LARGEST_TURN: Final = 1e4

#: [1] Halvings of one stretch before the checker gives up and says "undecided".
HALVINGS: Final = 100_000

#: [1] Halvings spent on how bad a violation is, once there is one.
HALVINGS_REFUSED: Final = 300

#: [1] Findings reported at most.
FINDINGS: Final = 20
