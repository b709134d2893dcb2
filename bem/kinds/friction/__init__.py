"""Kind of scene `friction`.

Load sharing between oil film and rough contact over speed: the Stribeck curve.
"""

TASK = "mixed lubrication"
PLACE = 1
ALSO: tuple[str, ...] = (
    "stribeck",
    "stribeck-curve",
    "mixed",
    "mixed-lubrication",
    "boundary",
)
CITES = {
    "johnson1972": "load sharing of film and asperities",
    "reynolds1886": "Reynolds equation",
    "polonsky1999": "conjugate gradients of the contact",
    "kalker1977": "contact as a quadratic program",
    "love1929": "influence functions of the half-space",
    "johnson1985": "half-space and Hertz contact",
    "akchurin2017": "balance of the oil volume",
}
