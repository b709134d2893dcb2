"""Kind of scene `wear`.

Wear particles and running-in of a cylinder on a flat in boundary lubrication.
"""

TASK = "wear and running-in"
PLACE = 1
ALSO: tuple[str, ...] = (
    "wear-volume",
    "wear-scar",
    "wear-particles",
    "debris",
    "archard",
)
CITES = {
    "akchurin2017": "wear particles of yielded regions",
    "polonsky1999": "conjugate gradients of the contact",
    "kalker1977": "contact as a quadratic program",
    "love1929": "influence functions of the half-space",
    "johnson1985": "half-space and Hertz contact",
}
