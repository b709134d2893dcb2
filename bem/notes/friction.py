"""Notes on mixed lubrication: the balance of film and rough contact, and what follows from it."""

from bem.notes.note import Level, define

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
WHOLE_FILM_BEYOND_MODEL = define(
    "whole-load-film-beyond-model",
    INFO,
    "lambda_ratio is an upper bound.",
    "A film under the whole load is outside the film's model, which ends at {load:si N} at this speed and viscosity.",
)
FILM_WITHOUT_LAYERS = define(
    "film-without-layers",
    INFO,
    "The film is that between uncoated bodies.",
    "Only the rough contact feels the layers, which are {ratio:.2g} of the contact's half-width thick.",
)
COUPLING_DIFFERS = define(
    "boundary-friction-coupling",
    INFO,
    "Normal displacements feel another boundary friction than the contact has.",
    "They feel {used:.3g}, its value at the pressure of a rough contact by itself; the mean of this contact"
    " is {found:.3g}.",
)
OIL_ON_CONTACT = define(
    "oil-on-contact",
    INFO,
    "Oil on cells in contact adds no friction here.",
    "With the film's shear stress on them friction would be {with_oil:.3g}, here {friction:.3g}{most}.",
)
OIL_BESIDE_DECIDES = define(
    "oil-beside-decides",
    OUTSIDE_MODEL,
    "The length of the patch decides the load sharing.",
    "{share:%} of the oil lies beside Hertz' contact: the surfaces have {contact_share:%} of the load at a "
    "friction of {friction:.3g}, but {loaded_contact_share:%} at {loaded_friction:.3g} with the oil counted"
    " where the film carries{most}.",
    'Set oil_volume = "loaded".',
)
OIL_BESIDE_FOLLOWS = define(
    "oil-beside-follows",
    INFO,
    "Load share and friction depend on where oil is counted.",
    "{share:%} of the oil lies beside Hertz' contact: the surfaces have {contact_share:%} of the load at a "
    "friction of {friction:.3g}, and {loaded_contact_share:%} at {loaded_friction:.3g} with the oil counted"
    " where the film carries{most}.",
)
OIL_BESIDE_UNKNOWN = define(
    "oil-beside-unknown",
    INFO,
    "How far results depend on the counted oil is unknown.",
    "{count} of the balances with the oil counted where the film carries was not met.",
)
OIL_IN_HERTZ_DECIDES = define(
    "oil-in-hertz-decides",
    OUTSIDE_MODEL,
    "The area where oil is counted decides the load sharing.",
    "Counted over the nominal Hertz contact the surfaces have {contact_share:%} of the load at a friction "
    "of {friction:.3g}; with oil_volume loaded they have {loaded_contact_share:%} at "
    "{loaded_friction:.3g}{most}.",
    'Compare oil_volume = "loaded".',
)
OIL_IN_HERTZ_FOLLOWS = define(
    "oil-in-hertz-follows",
    INFO,
    "Load share and friction depend on where oil is counted.",
    "Counted over the nominal Hertz contact the surfaces have {contact_share:%} of the load at a friction "
    "of {friction:.3g}; with oil_volume loaded they have {loaded_contact_share:%} at "
    "{loaded_friction:.3g}{most}.",
)
BOUNDARY_LUBRICATION = define(
    "boundary-lubrication",
    INFO,
    "Boundary lubrication: the surfaces carry the load.",
    "The film is left with less than {share:.1g} of the load.",
)
NO_FILM = define(
    "no-film",
    INFO,
    "Boundary lubrication: the film would be too thin for its model.",
    "At the end of the film's range it is thinner than {limit:si m}, and yet thicker than the surfaces "
    "leave open; it is taken for none, so friction jumps at the speed from which such films are found.",
)
FILM_MODEL_ENDS = define(
    "film-model-ends",
    CAUTION,
    "The film's model ends before film and surfaces balance.",
    "It ends at a load of {load:si N}, where the film is thicker than the surfaces leave open under the rest.",
    "Raise speed or viscosity, or lower the load.",
)
POINT_FILM_THIN = define(
    "point-film-thin",
    CAUTION,
    "The film is thinner than its cells can show.",
    "It is scaled from a smaller load by Hertz' pressure and the fit of Nijenbanning, Venner and Moes: 12 %"
    " too thick at 2.5 times that load, up to 40 % at 6 times; its minimum is not to be used{factors}.",
    "Take more cells of the film.",
)
POINT_FILM_LAYER = define(
    "point-film-layer",
    INFO,
    "A thin layer's film is scaled from a larger load.",
    "No film was found under so light a load; pressure goes on as Hertz', and the film is as thick as the "
    "layer leaves it{factors}.",
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
