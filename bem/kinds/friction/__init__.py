"""Kind of scene `friction`.

Load sharing between oil film and rough contact over speed: the Stribeck curve.
"""

TASK = "mixed lubrication"
PLACE = 1
ALSO: tuple[str, ...] = (
    "stribeck",
    "stribeck-curve",
    "mixed",
    "mixed-lubrication",
    "boundary",
)
