"""Kind of scene `tribofilm`.

A tribofilm that grows under stress and heat, wears, and takes substrate with it.
"""

TASK = "tribofilms"
PLACE = 1
ALSO: tuple[str, ...] = (
    "zddp",
    "antiwear",
)
CITES = {
    "gosvami2015": "growth of tribofilms",
    "akchurin2017": "tribofilms of rough contacts",
    "polonsky1999": "conjugate gradients of the contact",
    "kalker1977": "contact as a quadratic program",
    "love1929": "influence functions of the half-space",
    "johnson1985": "half-space and Hertz contact",
}
