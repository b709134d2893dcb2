"""Kind of scene `surface-temperature`.

Heat of friction in a rough or smooth contact: surface temperature, its share between the bodies.
"""

TASK = "dry contact"
PLACE = 5
ALSO: tuple[str, ...] = (
    "flash-temperature",
    "temperature",
    "heat",
)
