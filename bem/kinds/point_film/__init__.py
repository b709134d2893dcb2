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
