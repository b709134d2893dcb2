"""Kind of scene `flow-factors`.

Flow factors of rough surfaces over separation, as deformed in their contact.
"""

TASK = "oil films (EHL)"
PLACE = 5
ALSO: tuple[str, ...] = (
    "flow-factor",
    "patir-cheng",
)
