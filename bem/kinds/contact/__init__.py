"""Kind of scene `contact`.

Two rough, possibly coated bodies pressed together: pressure, contact area, approach, stresses below.
"""

TASK = "dry contact"
PLACE = 1
ALSO: tuple[str, ...] = (
    "hertz",
    "dry-contact",
    "coating",
    "dry",
    "rough",
    "rough-contact",
    "stress",
)
CITES = {
    "kalker1977": "contact as a quadratic program",
    "polonsky1999": "conjugate gradients of the contact",
    "love1929": "influence functions and stresses",
    "johnson1985": "half-space and Hertz contact",
}
