"""Kind of scene `rolling`.

Pressed bodies that roll over each other with creepage and spin: stick and slip, traction, energy of friction.
"""

TASK = "dry contact"
PLACE = 4
ALSO: tuple[str, ...] = (
    "creep",
    "creepage",
    "wheel-rail",
    "rolling-contact",
)
