"""Kind of scene `tribofilm`.

A tribofilm that grows under stress and heat, wears, and takes substrate with it.
"""

TASK = "tribofilms"
PLACE = 1
ALSO: tuple[str, ...] = (
    "zddp",
    "antiwear",
)
