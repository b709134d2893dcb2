"""Notes of no part in particular: values outside their usual range, pictures, and checks that failed."""

from bem.notes.note import Level, define

VALUE_UNUSUAL = define(
    "value-unusual",
    Level.CAUTION,
    "{quantity} {value} is outside its usual range.",
    "Usual are {usual}.",
    "{check}.",
)
VALUE_UNUSUAL_TYPICAL = define(
    "value-unusual-typical",
    Level.CAUTION,
    "{quantity} {value} is outside its usual range.",
    "Usual are {usual}: {typical}.",
    "{check}.",
)
CHECK_FAILED = define(
    "check-failed",
    Level.CAUTION,
    "The check {check} could not be made.",
    "It ended with {error}.",
    "Report this message; the results do not depend on it.",
)
FIGURE_MISSING = define(
    "figure-missing",
    Level.CAUTION,
    "Figure {figure} could not be drawn.",
    "It ended with {error}.",
    "Report this message; the results are complete without it.",
)
