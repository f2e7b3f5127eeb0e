"""Physical constants and the few unit factors that exist where a person types or reads."""

import math

#: Standard acceleration of gravity used throughout the paper and this package [m/s²].
g: float = 9.81

#: Degrees to radians.
DEGREE: float = math.pi / 180.0

#: Time after motion and tail at which a run that waits, for rest or for its verdict, is given up [s].
LONGEST_WAIT: float = 60.0
