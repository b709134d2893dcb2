"""Kind of scene `rolling`.

Pressed bodies that roll over each other with creepage and spin: stick and slip, traction, energy of friction.
"""

TASK = "dry contact"
PLACE = 4
ALSO: tuple[str, ...] = (
    "creep",
    "creepage",
    "rolling-contact",
)
CITES = {
    "kalker1990": "rolling contact",
    "carter1926": "creepage",
    "love1929": "influence functions",
}
