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
