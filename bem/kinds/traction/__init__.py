"""Kind of scene `traction`.

Traction of a smooth rolling and sliding line contact, with the heat in its film.
"""

TASK = "oil films (EHL)"
PLACE = 1
ALSO: tuple[str, ...] = (
    "ehl-line",
    "line-contact",
    "thermal-traction",
    "thermal-ehl",
    "traction-curve",
)
CITES = {
    "reynolds1886": "Reynolds equation",
    "dowson1966": "elastohydrodynamic line contact",
}
