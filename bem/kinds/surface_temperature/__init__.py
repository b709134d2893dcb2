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
CITES = {
    "carslaw1959": "moving sources of heat",
    "jaeger1942": "moving sources of heat",
    "blok1937": "heat partition",
    "polonsky1999": "conjugate gradients of the contact",
}
