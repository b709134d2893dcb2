"""Kind of scene `wear`.

Wear particles and running-in of a cylinder on a flat in boundary lubrication.
"""

TASK = "wear and running-in"
PLACE = 1
ALSO: tuple[str, ...] = (
    "wear-volume",
    "wear-scar",
    "wear-particles",
    "debris",
    "archard",
)
