"""Notes on dry contacts, on partial slip and on flow factors."""

from bem.notes.note import Level, Reason, define

OUTSIDE_MODEL, CAUTION, INFO = Level.OUTSIDE_MODEL, Level.CAUTION, Level.INFO

CONTACT_AT_EDGE = define(
    "contact-at-edge",
    CAUTION,
    "The contact reaches a free edge of the grid and ends there.",
    reasons={
        "grid": Reason(
            "The grid is {length:si m} along {axis} for a Hertz contact of {size:si m}.",
            "Take {wanted:si m} or more.",
            foreseen=True,
        ),
        "punch": Reason(
            "The flat patch is free along {axes}: it is a punch with pressure peaks along its edges.",
            "Set grid.periodic = true to make it part of a larger contact.",
            foreseen=True,
        ),
        "pressed": Reason(
            "Cells at the ends of {axes} carry pressure: the bodies are solved as if they ended there.",
            "Take a larger grid, or a periodic one for a part of a larger contact.",
        ),
        "share": Reason(
            "It reaches the ends of {axes}, whose outermost cells carry {share:%} of the load: the bodies are solved"
            " as if they ended there.",
            "Take a larger grid, or a periodic one for a part of a larger contact.",
        ),
    },
)
SPOTS_SMALL = define(
    "spots-small",
    CAUTION,
    "Contact spots are one or two cells wide; their area is uncertain.",
    "The area lies between the least that carries the load at the hardness and that of the cells in contact{of},"
    " {times:.2f} times as large.",
    "Take a finer grid.",
)
MEAN_GAP_NOT_MET = define(
    "mean-gap-not-met",
    CAUTION,
    "No contact with a mean gap of {asked:.4g} m was found.",
    "",
    "Ask for a larger mean gap, or give a load.",
    reasons={
        "impossible": "The bodies cannot be pressed flat, and {least:.4g} m is a lower bound on every mean gap.",
        "not-found": "It is not proved not to exist; this contact has {found}.",
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
    "Unlike bodies slip while pressed; what sticks depends on the loading.",
    reasons={
        "at-once": Reason(
            "The whole pressure came at once: a ball's stick radius comes out half as large (Spence 1968).",
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
    "Unlike bodies: the effect of friction on the pressure is approximate.",
    reasons={
        "left-out": "The pressure is that of the contact without friction.",
        "other-friction": (
            "Normal displacements feel a boundary friction of {used:.3g}, its value at the pressure of a rough contact"
            " by itself; the mean of this contact is {found:.3g}."
        ),
    },
)
FLOW_BARRED = define(
    "flow-barred",
    CAUTION,
    "The surfaces in contact bar all pressure flow of the oil.",
    reasons={
        "table": Reason(
            "At separations of {separations} the pressure flow factor along x is zero.",
            "Take larger separations, or a smoother patch.",
        ),
        "film": Reason(
            "The film's thinnest place, {thinnest:si m}, does not carry this load between these walls; the thickness"
            " is that of a least flow factor, {least:g}.",
            "Raise the speed or lower the load.",
        ),
    },
)
