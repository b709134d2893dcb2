"""Notes on mixed lubrication: the balance of film and rough contact, and what follows from it."""

from bem.notes.note import Level, Reason, define

OUTSIDE_MODEL, CAUTION, INFO = Level.OUTSIDE_MODEL, Level.CAUTION, Level.INFO

FRICTION_UNPHYSICAL = define(
    "friction-unphysical",
    OUTSIDE_MODEL,
    "Friction {friction:.3g} is above any physical bound, about {limit:g}.",
    reasons={
        "shear": "The oil carries more shear stress than pressure: give it a shear law with a limit.",
        "drag": "So small a load does not hold surfaces together against the drag of the oil: raise the load.",
    },
)
FILM_MODEL_ENDS = define(
    "film-model-ends",
    CAUTION,
    "The film's model ends at a smaller load than this one.",
    reasons={
        "balance": Reason(
            "It ends at {load:si N}, where the film is thicker than the surfaces leave open under the rest: film and"
            " surfaces do not balance.",
            "Raise speed or viscosity, or lower the load.",
        ),
        "whole-load": Reason(
            "It ends at {load:si N} at this speed and viscosity: lambda_ratio, of a film under the whole load, is an"
            " upper bound.",
            "Take friction and load shares, which do not rest on lambda_ratio.",
            INFO,
        ),
    },
)
FILM_WITHOUT_LAYERS = define(
    "film-without-layers",
    INFO,
    "The film is that between uncoated bodies.",
    "Only the rough contact feels the layers, which are {ratio:.2g} of the contact's half-width thick.",
)
OIL_ON_CONTACT = define(
    "oil-on-contact",
    INFO,
    "Friction of the oil between touching surfaces is left out.",
    "With the film's shear stress on them friction would be {with_oil:.3g}, here {friction:.3g}{most}.",
)
OIL_COUNTED = define(
    "oil-counted",
    INFO,
    "Load share and friction depend on the area where oil is counted.",
    "",
    'Compare oil_volume = "loaded".',
    reasons={
        "patch": (
            "{share:%} of the oil lies beside Hertz' contact: the surfaces have {contact_share:%} of the load at a "
            "friction of {friction:.3g}, and {loaded_contact_share:%} at {loaded_friction:.3g} with the oil counted "
            "where the film carries{most}."
        ),
        "hertz": (
            "Counted over the nominal Hertz contact the surfaces have {contact_share:%} of the load at a friction "
            "of {friction:.3g}; with oil_volume loaded they have {loaded_contact_share:%} at "
            "{loaded_friction:.3g}{most}."
        ),
        "unknown": "By how much is unknown: {count} balances with oil counted where the film carries failed.",
        "particles": (
            "By how much is unknown: particles bear load, and the balance with the oil counted where the film carries "
            "is one without particles."
        ),
    },
)
"""Outside the model where the oil, not film and roughness, shares the load (`bem.friction.oil_sensitivity`)."""
BOUNDARY_LUBRICATION = define(
    "boundary-lubrication",
    INFO,
    "Boundary lubrication: the surfaces carry the load.",
    reasons={
        "load": "The film is left with less than {share:.1g} of the load.",
        "thin": (
            "At the end of the film's range it is thinner than {limit:si m}, and yet thicker than the surfaces leave "
            "open; it is taken for none, so friction jumps at the speed from which such films are found."
        ),
    },
)
POINT_FILM_SCALED = define(
    "point-film-scaled",
    CAUTION,
    "The film is scaled from that under another load, not solved.",
    reasons={
        "thin": Reason(
            "It is thinner than its cells can show and scaled from a smaller load by Hertz' pressure and the fit of"
            " Nijenbanning, Venner and Moes: 12 % too thick at 2.5 times that load, up to 40 % at 6 times; its minimum"
            " is not to be used{factors}.",
            "Take more cells of the film.",
        ),
        "layer": Reason(
            "No film of a thin layer of oil was found under so light a load; pressure goes on as Hertz', and the film"
            " is as thick as the layer leaves it{factors}.",
            level=INFO,
        ),
    },
)
CELL_LONG = define(
    "repeated-cell-long",
    CAUTION,
    "The repeated cell is not short against the contact.",
    "It goes {across:.2g} times into the contact's half-axis; {fewest:g} times or more are needed.",
    "Take a shorter cell, or a patch that holds the contact.",
)
CELL_BEYOND_TABLE = define(
    "repeated-cell-beyond-table",
    CAUTION,
    "The mean pressure exceeds the tabulated pressures of the repeated cell.",
    "It is {pressure:si Pa} at most; cells were solved up to {limit:si Pa}.",
    "Lower the load.",
)
