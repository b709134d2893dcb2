"""Kind of scene `flow-factors`.

Flow factors of rough surfaces over separation, as deformed in their contact.
"""

TASK = "oil films (EHL)"
PLACE = 5
ALSO: tuple[str, ...] = (
    "flow-factor",
    "patir-cheng",
)
CITES = {
    "patir1978": "flow factors",
    "patir1979": "shear flow factors",
    "bayada1989": "homogenisation",
    "almqvist2007": "homogenisation",
}
