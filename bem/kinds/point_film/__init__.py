"""Kind of scene `point-film`.

Film of a ball or barrel on a flat: elastohydrodynamic point contact in steady motion.
"""

TASK = "oil films (EHL)"
PLACE = 3
ALSO: tuple[str, ...] = (
    "ehl-point",
    "point-contact",
    "ball",
    "barrel",
    "ball-on-disc",
    "interferogram",
)
CITES = {
    "reynolds1886": "Reynolds equation",
    "brandt1990": "multilevel integration",
    "venner2000": "multigrid",
    "nijenbanning1994": "start of the film",
}
