"""How far each figure may move: rules by group, case and figure, the first that fits.

The tolerance of a figure is what its solver promises of it: the accuracy of the discrete solution, not of the
discretisation, which stays. `python -m reports.golden --spread` measures how far figures follow a change of the inputs
in the last digits, and solvers of a tenth of the tolerance; it names each figure that uses up more than a third of its
own tolerance.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from fnmatch import fnmatchcase

from reports.golden.record import Figure


@dataclass(frozen=True)
class Rule:
    """Allowed change of the figures that fit a pattern GROUP/CASE/FIGURE: relative x |stored| + absolute."""

    pattern: str
    relative: float
    absolute: float
    reason: str


PUNCH = "along the edge of a flat punch gap and pressure vanish together: rounding says which cells touch"
RULES: tuple[Rule, ...] = (
    Rule("*/notes", 0.0, 0.0, "a number of notes"),
    Rule("*/outside_model", 0.0, 0.0, "a number of notes"),
    Rule("*/*imbalance*", 0.0, 1e-4, "zero within the tolerance of the balance; the status says so"),
    Rule("*/*residual*", 0.0, 1e-4, "zero within the tolerance of the solver; the status says so"),
    Rule("*/*load_missed*", 0.0, 1e-4, "zero within the tolerance of the solver; the status says so"),
    Rule("*/accuracy.*errors.*", 0.05, 1e-6, "differences of nearly equal figures"),
    Rule("surfaces/*Ssk", 1e-6, 1e-9, "zero for heights without skewness"),
    Rule("surfaces/*", 1e-6, 0.0, "moments met to 1e-6, else transforms to rounding"),
    Rule("contacts/contact-01/contact_*", 5e-3, 0.0, PUNCH),
    Rule("contacts/contact-20/*_area", 2e-2, 0.0, PUNCH),
    Rule("contacts/contact-20/contact_perimeter", 5e-3, 0.0, PUNCH),
    Rule(
        "contacts/contact-24/plastic_area", 5e-2, 0.0, "a few cells only are at the hardness, at the looser tolerance"
    ),
    Rule("contacts/*_perimeter", 1e-4, 0.0, "the edge of the contact is interpolated inside cells"),
    Rule("contacts/*", 1e-5, 1e-9, "residual 1e-8 or 1e-6 of the roughness; lengths and moduli are of order one"),
    Rule("films/point*/shear_force_y", 1e-4, 1e-7, "zero by symmetry within the residual"),
    Rule("films/line*", 1e-4, 0.0, "residual 1e-8; the mesh follows the solution, to 1e-5 of a figure"),
    Rule("films/point*", 1e-4, 0.0, "residual 1e-8 on a fixed mesh"),
    Rule("heat/*", 1e-6, 1e-9, "both surfaces agree to 1e-8 of the largest rise"),
    Rule("tribofilms/local/*", 1e-4, 0.0, "steps follow an estimated error"),
    Rule("tribofilms/mean-*/worn*", 3e-5, 1e-14, "zero until the first lag has passed, within the integration"),
    Rule("tribofilms/mean-*", 3e-5, 0.0, "time integration to 1e-6, contacts that it tabulates to 1e-8"),
    Rule("tribofilms/evolved-*/worn*", 1e-5, 1e-14, "zero until the first lag has passed, within the integration"),
    Rule("tribofilms/*", 1e-5, 0.0, "time integration to 1e-8 or 1e-6, contacts to a residual of 1e-8"),
    Rule("points/*", 1e-3, 0.0, "the load is balanced to 1e-4, and friction follows the share of the load"),
    Rule("loops/*", 1e-3, 0.0, "pieces end on voxels, whose edges follow interpolated stresses"),
    Rule("scenes/hot-film/*sliding_traction*", 1e-3, 1e-9, "zero in pure rolling"),
    Rule("scenes/micropitting-rig/*jump_error*", 1e-3, 1e-12, "a difference of nearly equal figures"),
    Rule("scenes/*", 1e-3, 0.0, "of summaries with solvers at the tolerances of their kinds"),
)

ERROR_BAR = 0.05
"""Relative change allowed of an error bar, besides that of its figure: it is a difference of nearly equal figures."""
MEAN_COUNT = 0.03
"""Relative change allowed of a count's mean over a group."""
EACH_COUNT, FEW = 0.25, 3.0
"""Allowed change of a single count: relative, and absolute."""
MEMORY = 0.15
"""Relative change allowed of a peak of memory."""


def rule_of(group: str, case: str, figure: str) -> Rule:
    """The first rule that fits."""
    path = f"{group}/{case}/{figure}"
    return next(rule for rule in RULES if fnmatchcase(path, rule.pattern))


def allowed(group: str, case: str, figure: str, figures: dict[str, Figure]) -> float:
    """Largest change of a figure of a case, beside the other figures of which it may be the error bar."""
    value, rule = figures[figure], rule_of(group, case, figure)
    if not isinstance(value, float):
        return 0.0
    change = rule.relative * abs(value) + rule.absolute
    bar = re.search(r"_error\w*", figure)
    if bar is None:
        return change
    base = figures.get(figure[: bar.start()] + figure[bar.end() :])
    return max(change, ERROR_BAR * abs(value) + (rule.relative * abs(base) if isinstance(base, float) else 0.0))


def rounded(value: float, change: float) -> float:
    """The value to a tenth of an allowed change."""
    if not value or not change:
        return value
    digits = math.ceil(math.log10(abs(value) / change)) + 2
    return float(f"{value:.{min(max(digits, 1), 17) - 1}e}") if digits > 0 else 0.0
