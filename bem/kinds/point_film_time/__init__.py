"""Kind of scene `point-film-time`.

Film of a ball or barrel in time: dents, waviness and roughness that pass through, start, stop, impact.
"""

TASK = "oil films (EHL)"
PLACE = 4
ALSO: tuple[str, ...] = (
    "dimple",
    "dent",
    "waviness",
    "impact",
)
