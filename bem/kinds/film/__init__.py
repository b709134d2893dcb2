"""Kind of scene `film`.

Film of a smooth line contact in time: start and stop, reciprocating, changing load.
"""

TASK = "oil films (EHL)"
PLACE = 2
ALSO: tuple[str, ...] = (
    "ehl",
    "lubrication",
    "oil-film",
)
CITES = {
    "reynolds1886": "Reynolds equation",
    "dowson1966": "elastohydrodynamic line contact",
    "elrod1974": "mass-conserving cavitation",
}
