"""Kind of scene `running-in-life`.

Running-in over a life: wear and tribofilm over millions of cycles in mixed lubrication, in jumps of known error.
"""

TASK = "wear and running-in"
PLACE = 3
ALSO: tuple[str, ...] = (
    "micropitting",
    "fatigue",
    "life",
    "cycle-jumps",
)
CITES = {
    "johnson1972": "load sharing of film and asperities",
    "reynolds1886": "Reynolds equation",
    "polonsky1999": "conjugate gradients of the contact",
    "kalker1977": "contact as a quadratic program",
    "love1929": "influence functions of the half-space",
    "johnson1985": "half-space and Hertz contact",
}
