"""Every numerical tolerance of the planner: name, value, unit and reason.

The independent checker in ``coord.verify`` keeps its own, so that a slip here cannot loosen the check.
"""

from typing import Final

#: [m] Two places closer than this are the same place. Coordinates are below 1e6 m, doubles resolve 1e-10 m there.
SAME_PLACE: Final = 1e-9

#: [m] The checker accepts distances that fall short by this much; poses at rest may touch exactly.
DISTANCE: Final = 1e-9

#: [m] Added to the growth of obstacles while a path is searched, so that the certificate, which measures
#: the finished path with rounding, finds the clearance kept.
PLANNING_MARGIN: Final = 1e-6

#: [m] Added to the distance that robots keep from each other in the coordination plane, for the same reason.
REGION_MARGIN: Final = 1e-6

#: [1] Limits are planned a little tighter than given, so that rounded states still keep them.
LIMIT_MARGIN: Final = 1e-7

#: [m] A coordinate beyond this is refused: doubles no longer resolve the tolerances above.
LARGEST_COORDINATE: Final = 1e6

#: [m] A smaller robot is a slip of the pen: bends of its size would need stops.
SMALLEST_RADIUS: Final = 1e-3

#: [m/s, m/s2, m/s3] Limits beyond these are slips of the pen, and lose the digits that the checks need.
SMALLEST_LIMIT: Final = 1e-4
LARGEST_LIMIT: Final = 1e4

#: [s] A later release is refused: doubles resolve 1e-11 s there, which the check of jerks needs.
LATEST_RELEASE: Final = 1e5

#: [1] An arrival this close to its bound, relatively, counts as optimal.
OPTIMAL: Final = 1e-4

#: [m] Length of the cells into which the coordination plane is cut along the robot that is waited for.
REGION_CELL: Final = 0.05

#: [m] Arcs are cut into chords whose distance from the arc stays below this.
CHORD_SAGITTA: Final = 2e-4

#: [m] Arcs keep this from the barriers that force a path to one side of an obstacle.
BARRIER: Final = 1e-5
