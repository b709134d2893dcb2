"""Kind of scene `particles`.

Sizes of the wear particles in an AFM height map.
"""

TASK = "wear and running-in"
PLACE = 4
ALSO: tuple[str, ...] = (
    "afm",
    "particle",
)
CITES = {
    "akchurin2017": "wear particles of height maps",
}
