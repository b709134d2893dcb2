"""Kind of scene `partial-slip`.

Pressed bodies pushed along, once or there and back: where they stick and slip, loop, energy of friction.
"""

TASK = "dry contact"
PLACE = 3
ALSO: tuple[str, ...] = (
    "fretting",
    "cattaneo",
    "stick-slip",
)
CITES = {
    "kalker1990": "partial slip as a convex program",
    "kalker1977": "contact as a quadratic program",
    "love1929": "influence functions",
}
