"""Notes on dry contacts, on partial slip and on flow factors."""

from collections.abc import Iterable

from bem.notes.note import Level, Note, Reason, define

OUTSIDE_MODEL, CAUTION, INFO = Level.OUTSIDE_MODEL, Level.CAUTION, Level.INFO

CONTACT_AT_EDGE = define(
    "contact-at-edge",
    CAUTION,
    "The contact reaches a free edge of the grid and ends there.",
    reasons={
        "grid": Reason(
            "The grid is {length:si m} along {axis} for a Hertz contact of {size:si m}.",
            "Set {key} to {wanted:si m} or more.",
            foreseen=True,
        ),
        "punch": Reason(
            "The flat patch is free along {axes}: it is a punch with pressure peaks along its edges.",
            "Set grid.periodic = true to make it part of a larger contact.",
            foreseen=True,
        ),
        "pressed": Reason(
            "Cells at the ends of {axes} carry pressure: the bodies are solved as if they ended there.",
            "Take a larger grid, or a periodic one for a part of a larger contact; of a long cylinder, a slice that is"
            " periodic along y only (grid.periodic = [false, true]).",
        ),
        "cut-off": Reason(
            "It reaches the ends of {axes}, whose outermost cells carry {share:%} of the load: the bodies are solved"
            " as if they ended there.",
            "{action}",
            OUTSIDE_MODEL,
        ),
        "share": Reason(
            "It reaches the ends of {axes}, whose outermost cells carry {share:%} of the load: the bodies are solved"
            " as if they ended there.",
            "Take a larger grid, or a periodic one for a part of a larger contact; of a long cylinder, a slice that is"
            " periodic along y only (grid.periodic = [false, true]).",
        ),
    },
)


def edge_notes_as_one(notes: Iterable[Note]) -> list[Note]:
    """Return notes in which a contact that the edge cuts off is said once, by its most severe note.

    Notes on other contacts of a scene stay where the severe ones do not hold for all of it.
    """
    given = list(notes)
    edge = [note for note in given if note.code == CONTACT_AT_EDGE.code]
    beyond = [note for note in edge if note.level is OUTSIDE_MODEL]
    if not beyond:
        return given
    everywhere = [note for note in beyond if not note.where][:1]
    kept = everywhere or [note for note in edge if note.values.get("reason") != "grid"]
    return [note for note in given if note.code != CONTACT_AT_EDGE.code or any(note is one for one in kept)]


SECOND_CONTACT = define(
    "second-contact",
    INFO,
    "Wheel and rail come close at a second place.",
    reasons={
        "left-out": Reason(
            "It lies {beside:si m} beside the first one at a contact angle of {angle:.0f} deg. Its gap of {gap:si m} is"
            " less than the {closing:si m} by which the bodies come closer there: it carries a part of the load.",
            "Take a grid that covers both, or a lateral position with one contact.",
            OUTSIDE_MODEL,
            headline="Wheel and rail touch at a second place, which the grid leaves out.",
        ),
        "inclined": Reason(
            "It lies {beside:si m} beside the first one at a contact angle of {angle:.0f} deg, and its gap before"
            " loading is {gap:si m}: its forces have another direction.",
            "Take the part there as an estimate.",
            CAUTION,
            headline="A second contact place is solved on the tangent plane of the first.",
        ),
        "inside": Reason(
            "It lies on the grid, {beside:si m} beside the first one, and is part of the solution; its gap before"
            " loading is {gap:si m}, its contact angle {angle:.0f} deg."
        ),
        "open": Reason(
            "It lies {beside:si m} beside the first one at a contact angle of {angle:.0f} deg and has a gap of"
            " {gap:si m}; the bodies come closer by {closing:si m} there, so that it stays open."
        ),
    },
)
PROFILE_ENDS = define(
    "profile-ends",
    OUTSIDE_MODEL,
    "The contact reaches the end of a profile.",
    "The bodies are solved as if they went on, without touching there.",
    "Give a profile that goes on, or another lateral position.",
)
CONTACT_BENT = define(
    "contact-bent",
    CAUTION,
    "The contact bends with the profiles.",
    reasons={
        "bent": Reason(
            "The normals turn by {angle:.0f} deg across the contact, and it is solved on one plane: pressures in its"
            " outer parts have a wrong direction.",
            "Set shape.conforming = true in kind contact or rolling; elsewhere take the result as an estimate.",
        ),
        "turned": Reason(
            "The normals turn by {angle:.0f} deg across the contact. Half-spaces that are turned with the surface make"
            " the pressure of a shaft in a hole 0.8 % too high at 40 deg, 1.6 % at 60 deg and 3.4 % at 90 deg.",
            "Compare with finite elements where this matters.",
        ),
    },
)
FRICTION_NOT_UNIQUE = define(
    "friction-not-unique",
    CAUTION,
    "Friction falls so steeply with the slip speed that several states may exist.",
    "The bound of a cell falls {times:.1f} times as fast with its slip as the bodies let its traction fall: it may"
    " stick or slip, and which of the two depends on the past.",
    "Take a larger half_speed, a smaller difference of the coefficients, or compare runs on other grids.",
)
CONTACT_UNRESOLVED = define(
    "contact-unresolved",
    CAUTION,
    "The cells do not resolve the contact.",
    reasons={
        "hertz": Reason(
            "There are {across:.2g} cells; {fewest} give the pressure within 1.5 % and the area within 13 %, and 40"
            " give maps.",
            "Set spacing to {spacing:si m} (20 cells across; {fewest} is the least).",
            headline="The grid has few cells across the Hertz contact.",
        ),
        "adhesive": Reason(
            "There are {across:.2g} cells, adhesion by Derjaguin, Muller and Toporov included; {fewest} give the"
            " pressure within 1.5 % and the area within 13 %, and 40 give maps.",
            "Set spacing to {spacing:si m} (20 cells across; {fewest} is the least).",
            headline="The grid has few cells across the contact.",
        ),
        "few-cells": Reason(
            "Area, mean pressure and maximum pressure follow the cells; the mean pressure may even exceed the maximum.",
            "Take a larger load or a finer grid; of a measured surface measure with a finer spacing.",
            headline="The cells do not resolve the contact: only {cells:count cell} in contact.",
        ),
        "spots": Reason(
            "The true area{of} lies between {least:.3g} % of the grid (load over the hardness) and {counted:.3g} % (all"
            " cells in contact, {times:.2f} times as much). The area of the results counts cells at edges in part.",
            "Take a finer grid; of a measured surface measure with a finer spacing, as finer cells only interpolate.",
            headline="Contact spots are one or two cells wide; their area is uncertain.",
        ),
        "edges": Reason(
            "The true area{of} lies between {least:.3g} % of the grid (load over the hardness) and {counted:.3g} % (all"
            " cells in contact, {times:.2f} times as much; {narrow:%} of them in spots of one or two cells). The area"
            " of the results counts cells at edges in part.",
            "Take a finer grid; of a measured surface measure with a finer spacing, as finer cells only interpolate.",
            headline="The cells do not resolve the edges of contact spots; the area is uncertain.",
        ),
    },
)
FEW_SPOTS = define(
    "few-spots",
    INFO,
    "Few contact spots: maps of other places would give other figures.",
    "There are {spots}. Real areas and pressures of other places of the surface scatter by about half of "
    "1/sqrt(spots), {scatter:%}, and by more where a few high summits carry the load; error bars are numerical and "
    "leave this out.",
    "Run maps of several places and compare them, or take a larger map.",
)
_ZONE = "At the edge of a contact it is {zone:si m} wide, for cells of {cell:si m}:"
ADHESIVE_ZONE_UNRESOLVED = define(
    "adhesive-zone-unresolved",
    OUTSIDE_MODEL,
    "The cells do not resolve the zone in which adhesion acts.",
    "",
    "{remedy}",
    reasons={
        "foreseen": Reason(
            f"{_ZONE} the grid will hold the edge back, adhesion and its hysteresis will be wrong, and the run will"
            " take long.",
            foreseen=True,
        ),
        "solved": Reason(f"{_ZONE} the grid holds the edge back, and adhesion and its hysteresis are wrong."),
    },
)
ADHESION_ENDS_APART = define(
    "adhesion-ends-apart",
    CAUTION,
    "The bodies have parted at the end of the path.",
    "Area, pressures, approach and load are those of the parted end. Its load, {load:si N}, is the attraction over the "
    "gap: {beyond}. On the path the contact was up to {area:.3g} m^2 large and the lowest load {lowest:si N}.",
    "Read the lowest load and the figure of the path, or end the path in contact.",
)
PULL_OFF_OF_RANGE = define(
    "pull-off-of-range",
    INFO,
    "The pull-off force depends on the range of adhesion, which its error bar leaves out.",
    "By the range, here {range:si m}, it lies between {jkr:si N} (JKR, short) and {dmt:si N} (DMT, long); the error bar"
    " is numerical.",
    "Run two ranges of adhesion that are likely.",
)
PULL_OFF_NOT_REACHED = define(
    "pull-off-not-reached",
    INFO,
    "The bodies did not part on the path: the pull-off force is larger than its lowest load.",
    "The lowest load of the path is {lowest:si N}{limits}.",
    "For the pull-off force prescribe an approach, with an approach_path that ends with the bodies apart.",
)
ADHESION_JUMPS = define(
    "adhesion-jumps",
    INFO,
    "The adhesive contact jumps on its path.",
    "It does so in {jumps} of {steps} steps, in the first of them to a load of {load:si N}.",
    "Take shorter steps there for the load and the approach of the jump.",
)
HYSTERESIS_UNBALANCED = define(
    "hysteresis-unbalanced",
    CAUTION,
    "Work and energy of the bodies that relax do not balance.",
    reasons={
        "power": Reason(
            "The dissipated power differs from friction force times speed by {share:.0%} of the larger. At this speed"
            " the bodies remember {length:si m} of their way, for cells of {cell:si m}.",
            "Take smaller cells.",
            headline="The dissipated power is not resolved by the cells.",
        ),
        "work": Reason(
            "{share:.0%} of the work is neither stored nor dissipated: the load or the approach changes too fast for"
            " the steps.",
            "Give more times where it changes.",
        ),
    },
)
RELAXATION_EXTRAPOLATED = define(
    "relaxation-extrapolated",
    CAUTION,
    "The relaxation is extrapolated beyond the times of its source.",
    reasons={
        "passing": Reason(
            "A point of {material} is under pressure for {time:si s} at most while it passes the contact; the modulus"
            " is known from {low:si s} to {high:si s} after loading.",
            "Take another speed, or a relaxation that was measured at such times.",
        ),
        "path": Reason(
            "The path takes {time:si s}; the modulus of {material} is known from {low:si s} to {high:si s} after"
            " loading.",
            "Take other times, or a relaxation that was measured at such times.",
        ),
    },
)
ROLLING_UNRESOLVED = define(
    "rolling-unresolved",
    CAUTION,
    "The cells do not resolve the rolling.",
    "",
    reasons={
        "sticks": Reason(
            "The error bar of {figure} is {error:.0f} % of it.",
            "Take smaller cells (grid.shape), or more creepage: where nearly everything sticks little slips.",
        ),
        "slips": Reason(
            "{stick:%} of the contact sticks: spin makes nearly everything slip, and the force is a small difference of"
            " opposite tractions. Its error bar is {error:.0f} % of it.",
            "Take smaller cells (grid.shape).",
            headline="Spin makes the force of the rolling contact uncertain.",
        ),
    },
)
CREEPAGE_LARGE = define(
    "creepage-large",
    CAUTION,
    "The creepage is large: is it given in per cent?",
    "{value:g} is {share:g} %, at which everything slides.",
    "Write {meant:g}, or a text with % at its end, for {value:g} %.",
)
LINE_APPROACH = define(
    "line-approach",
    CAUTION,
    "The approach of a line contact has no absolute zero.",
    reasons={
        "elastic": "It depends on the depth of the bodies, here on the length of the grid; only differences of "
        "approaches at one grid have a meaning.",
        "steady": "It depends on the depth of the bodies, here on the length of the grid. In steady motion that part"
        " changes with the speed, too, so that approaches at two speeds cannot be compared.",
    },
)
MEAN_GAP_NOT_MET = define(
    "mean-gap-not-met",
    CAUTION,
    "No contact with a mean gap of {asked:si m} was found.",
    "",
    "Ask for a larger mean gap, or give a load.",
    reasons={
        "impossible": "The bodies cannot be pressed flat, and {least:si m} is a lower bound on every mean gap.",
        "not-found": "It may exist, but was not found; this contact has {found}.",
    },
)
MEAN_GAP_AMBIGUOUS = define(
    "mean-gap-ambiguous",
    CAUTION,
    "Several contacts have the prescribed mean gap; this is one of them.",
    "The one found carries {load:si N}, and another lies between {first:si N} and {last:si N}, {place}: the"
    " layer stands off beside the contact.",
    "Prescribe a load to choose.",
)
PRESSING_PATH = define(
    "pressing-path",
    CAUTION,
    "Bodies of different elasticity slip while pressed; sticking depends on the loading.",
    reasons={
        "at-once": Reason(
            "The whole pressure came at once: the stick radius of a ball comes out at half its value (Spence 1968).",
            "Give the contact in steps, each with the solution before it as `previous`.",
        ),
        "one-step": Reason(
            "The whole load comes at once, and far too little sticks.",
            "Leave push.pressing_steps out ({usual}), or raise it.",
        ),
        "steps": Reason(
            "The load comes in {steps} steps, and the stick area is known to about 1/{steps}.",
            "Take twice push.pressing_steps to see the difference.",
            INFO,
        ),
        "cycle": Reason("Each cycle's pressure comes at once; the stick area is less certain.", level=INFO),
    },
)
FRICTION_ON_PRESSURE = define(
    "friction-on-pressure",
    INFO,
    "Bodies of different elasticity: the effect of friction on pressure is approximate.",
    reasons={
        "left-out": "The pressure is that of the contact without friction.",
        "other-friction": (
            "Normal displacements feel a boundary friction of {used:.3g}, its value at the pressure of a rough contact"
            " by itself; the mean of this contact is {found:.3g}."
        ),
    },
)
