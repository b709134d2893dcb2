"""Kind of scene `asperities`.

A regular array of spherical asperities against a flat: load per asperity over depth.
"""

TASK = "dry contact"
PLACE = 2
ALSO: tuple[str, ...] = (
    "greenwood-williamson",
    "asperity",
)
CITES = {
    "kalker1977": "contact as a quadratic program",
    "greenwood1966": "uncoupled asperities",
}
