"""Notes of no part in particular: values outside their usual range, and side tasks that failed."""

from bem.notes.note import Level, define

VALUE_UNUSUAL = define(
    "value-unusual",
    Level.CAUTION,
    "The {quantity}, {value}, is outside its usual range.",
    "Usual are {usual}.",
    "{check}.",
)
SIDE_TASK_FAILED = define(
    "side-task-failed",
    Level.CAUTION,
    "{task} failed; the results are complete.",
    "It ended with {error}.",
    "Report this message.",
)
