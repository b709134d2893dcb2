"""Kind of scene `running-in`.

Running-in in mixed lubrication: wear cycles with the load shared between film and contact.
"""

TASK = "wear and running-in"
PLACE = 2
ALSO: tuple[str, ...] = (
    "run-in",
    "runningin",
)
CITES = {
    "johnson1972": "load sharing of film and asperities",
    "akchurin2017": "running-in in mixed lubrication",
    "reynolds1886": "Reynolds equation",
    "polonsky1999": "conjugate gradients of the contact",
    "kalker1977": "contact as a quadratic program",
    "love1929": "influence functions of the half-space",
    "johnson1985": "half-space and Hertz contact",
}
