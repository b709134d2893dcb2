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
CITES = {
    "reynolds1886": "Reynolds equation",
    "brandt1990": "multilevel integration",
    "venner2000": "multigrid",
}
