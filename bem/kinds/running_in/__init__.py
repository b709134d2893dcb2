"""Kind of scene `running-in`.

Running-in in mixed lubrication: wear cycles with the load shared between film and contact.
"""

TASK = "wear and running-in"
PLACE = 2
ALSO: tuple[str, ...] = (
    "run-in",
    "runningin",
)
