"""Notes on dry contacts, on partial slip and on flow factors."""

from bem.notes.note import Level, define

CAUTION, INFO = Level.CAUTION, Level.INFO

CONTACT_REACHES_EDGE = define(
    "contact-reaches-edge",
    CAUTION,
    "The contact reaches the edge of the grid along {axes}.",
    "For this solver the bodies end there.",
    "If the bodies go on there, make the grid longer or periodic along {axes}.",
)
CONTACT_SPOTS_SMALL = define(
    "contact-spots-small",
    CAUTION,
    "Spots of contact are too small for these cells.",
    "The contact area lies between the least that carries the load at the hardness and the cells in "
    "contact, {times:.2f} times as many.",
    "Take a finer grid.",
)
MEAN_GAP_IMPOSSIBLE = define(
    "mean-gap-impossible",
    CAUTION,
    "No approach gives a mean gap of {asked:.4g} m.",
    "The bodies cannot be pressed flat, and {least:.4g} m is a lower bound on every mean gap.",
    "Ask for a larger mean gap, or give a load.",
)
MEAN_GAP_NOT_FOUND = define(
    "mean-gap-not-found",
    CAUTION,
    "A mean gap of {asked:.4g} m was not found.",
    "It is not proved not to exist; this contact has {found}.",
    "Ask for a larger mean gap, or give a load.",
)
MEAN_GAP_AMBIGUOUS = define(
    "mean-gap-ambiguous",
    CAUTION,
    "The prescribed mean gap has several answers.",
    "The one found carries {load:si N}, and another lies between {first:si N} and {last:si N}, {place}: the"
    " layer stands off beside the contact.",
    "Prescribe a load to choose.",
)
SLIP_PRESSED_AT_ONCE = define(
    "slip-pressed-at-once",
    CAUTION,
    "The bodies differ in elasticity, and their whole pressure came at once.",
    "Surfaces slip while pressure grows, so that the stick area depends on how it grew: a ball's stick radius comes "
    "out half as large (Spence 1968).",
    "Give the contact in steps, each with the solution before it as `previous`.",
)
PATCH_REPEATS = define(
    "flow-patch-repeats",
    INFO,
    "The patch is taken to repeat along both axes.",
    "The grid did not say so, and seams may have steps.",
)
FLOW_BARRED = define(
    "flow-barred",
    CAUTION,
    "Contact bars all flow along x at small separations.",
    "At {separations} the pressure factor is zero.",
    "Take larger separations, or a smoother patch.",
)
