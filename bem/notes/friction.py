"""Notes on mixed lubrication: the balance of film and rough contact, and what follows from it."""

from bem.notes.note import Level, Reason, define

OUTSIDE_MODEL, CAUTION, INFO = Level.OUTSIDE_MODEL, Level.CAUTION, Level.INFO

FRICTION_UNPHYSICAL = define(
    "friction-unphysical",
    OUTSIDE_MODEL,
    "Friction {friction:.3g beside limit} is above any physical bound, about {limit:g}.",
    reasons={
        "shear": "The oil carries more shear stress than pressure: give it a shear law with a limit.",
        "drag": "So small a load does not hold surfaces together against the drag of the oil: raise the load.",
    },
)
FILM_MODEL_ENDS = define(
    "film-model-ends",
    CAUTION,
    "The film model does not reach the load of this contact.",
    reasons={
        "balance": Reason(
            "It ends at {load:si N}, where the film is thicker than the surfaces leave open under the rest: film and"
            " surfaces do not balance.",
            "Raise speed or viscosity, or lower the load.",
        ),
    },
)
LAMBDA_UNCERTAIN = define(
    "lambda-uncertain",
    CAUTION,
    "The lambda ratio is uncertain; friction and load shares are not affected.",
    "",
    "Do not rely on lambda_ratio.",
    reasons={
        "model-ends": Reason(
            "The film's model ends at {load:si N} at this speed and viscosity: lambda_ratio, of a film under the whole"
            " load, is an upper bound.",
            level=INFO,
        ),
        "no-film": "The film under the whole load, which lambda_ratio is taken from, did not converge.",
        "no-heat": "The heat of the film under the whole load, which lambda_ratio is taken from, was not found.",
    },
)
FLATTENED_TOO_HIGH = define(
    "flattened-too-high",
    OUTSIDE_MODEL,
    "The film is too thin for the asperity load share by waves.",
    "",
    "Take the contact as one in boundary lubrication, or kind point-film with one rough body at rest.",
    reasons={
        "ratio": "The central film is {ratio:.2g} times the rms heights; rough films to compare with reach down to"
        " {least:g}.",
        "molecular": "The central film under the whole load is {film:si m}, less than {least:si m}: so little oil"
        " flattens nothing, and the load is shared with undeformed roughness.",
    },
)
_THICK_LAYER = "A layer as thick as the contact is wide is left out of the film."
_THICK = (
    "Film, half-width and patch are those of the bodies below the layers, whose modulus is {stiffer:.2g} times that of "
    "a layer {ratio:.2g} half-widths thick."
)
FILM_WITHOUT_LAYERS = define(
    "film-without-layers",
    INFO,
    "The film is that between uncoated bodies.",
    reasons={
        "thin": "Only the rough contact feels the layers, which are {ratio:.2g} of the contact's half-width thick.",
        "thick": Reason(
            _THICK,
            "Give the layer's material as that of the body.",
            level=OUTSIDE_MODEL,
            headline=_THICK_LAYER,
        ),
        "thick-repeats": Reason(
            _THICK,
            'Set sharing.film_modulus = "{modulus:si Pa}": with it the film is of a contact as wide as on the layer.',
            level=OUTSIDE_MODEL,
            headline=_THICK_LAYER,
        ),
        "thick-held": Reason(
            _THICK,
            "In kind friction leave out [grid], so that the rough patch repeats, and set sharing.film_modulus = "
            '"{modulus:si Pa}": with it the film is of a contact as wide as on the layer.',
            level=OUTSIDE_MODEL,
            headline=_THICK_LAYER,
        ),
    },
)
OIL_ON_CONTACT = define(
    "oil-on-contact",
    INFO,
    "The shear stress of the oil between touching surfaces is not counted.",
    reasons={
        "more": "With that of the film there friction would be {with_oil:.3g}, here {friction:.3g}{most}.",
        "less": (
            "With that of the film there friction would be {with_oil:.3g}, here {friction:.3g}{most}: with so little"
            " sliding the fall of pressure drives that oil forward, against the resistance of the rest."
        ),
    },
)
OIL_COUNTED = define(
    "oil-counted",
    INFO,
    "Load share depends on whether oil beside the contact is counted.",
    "",
    'Compare oil_volume = "loaded".',
    reasons={
        "patch": (
            "{share:%} of the oil in the mean film thickness lies beside Hertz' contact: the surfaces have "
            "{contact_share:%} of the load at a friction of {friction:.3g}, and {loaded_contact_share:%} at "
            "{loaded_friction:.3g} with the oil counted where the film carries{most}."
        ),
        "hertz": (
            "Counted over the nominal Hertz contact the surfaces have {contact_share:%} of the load at a friction "
            "of {friction:.3g}; with oil_volume loaded they have {loaded_contact_share:%} at "
            "{loaded_friction:.3g}{most}."
        ),
        "unknown": (
            "By how much is unknown: {count} balances, or those with the oil counted where the film carries, failed."
        ),
        "particles": (
            "By how much is unknown: particles bear load, and the balance with the oil counted where the film carries "
            "is one without particles."
        ),
    },
)
"""Outside the model where the oil, not film and roughness, shares the load (`bem.friction.oil_sensitivity`)."""
PURE_ROLLING = define(
    "pure-rolling",
    CAUTION,
    "Pure rolling: asperities carry load but do not rub.",
    reasons={
        "curve": Reason(
            "The slide-to-roll ratio is {ratio:.2g}; friction is that of the film alone.",
            "For a Stribeck curve set speeds.slide_roll_ratio, such as 0.02.",
        ),
        "wear": Reason(
            "The slide-to-roll ratio is {ratio:.2g}: friction takes nothing off, in any number of cycles.",
            "For running-in set speeds.slide_roll_ratio, such as 0.02.",
        ),
    },
)
BOUNDARY_LUBRICATION = define(
    "boundary-lubrication",
    INFO,
    "Boundary lubrication: the surfaces carry the load.",
    reasons={
        "load": "The film is left with less than {share:.1g} of the load.",
        "thin": (
            "A film below {limit:si m} is taken to carry no load; friction may jump at the speed from which thicker "
            "films are found."
        ),
    },
)
POINT_FILM_SCALED = define(
    "point-film-scaled",
    CAUTION,
    "The film under this load is extrapolated from a smaller load, not solved.",
    reasons={
        "thin": Reason(
            "It is thinner than the cells of its mesh can show. It is scaled from the largest load whose film was "
            "solved, by Hertz' pressure and the fit of Nijenbanning, Venner and Moes: 12 % too thick at 2.5 times that "
            "load, up to 40 % at 6 times; its minimum is not to be used, up to 20 times too large or a third of the "
            "solved one{factors}.",
            "Set more film.cells: a finer mesh solves films under larger loads.",
            headline="The film is extrapolated from a smaller load; minimum and lambda are unknown.",
        ),
        "layer": Reason(
            "No film of a thin layer of oil was found under so light a load; pressure goes on as Hertz', and the film"
            " is as thick as the layer leaves it{factors}.",
            level=INFO,
        ),
    },
)
NO_SUMMITS = define(
    "no-summits",
    CAUTION,
    "The rough surface has no summits, which uncoupled asperities need.",
    "A summit is higher than its eight neighbours; a ridge along a periodic axis has none.",
    'Take the contact model "coupled".',
)
REPEATED_PATCH = define(
    "repeated-patch",
    CAUTION,
    "The repeated patch does not suit this contact.",
    reasons={
        "long": Reason(
            "It goes {across:.2g} times into the contact's half-axis; {fewest:g} times or more are needed.",
            "Take a shorter patch, or one that holds the contact.",
            headline="The repeated patch is too long for this contact.",
        ),
        "waves": Reason(
            "Its correlation length along the sliding direction, {length:si m}, goes {across:.2g} times into the"
            " half-width of the contact; with fewer than {fewest:g} the patch is not the same everywhere.",
            "Take a patch that holds the contact: grid.periodic = [false, true] and {side:si m} of grid.lengths along"
            " x, twice Hertz' width. A measured map must be as long.",
            headline="The roughness is too long for a patch that repeats.",
        ),
        "flash": Reason(
            "Heat enters at the mean rate of each place of the repeated patch; a hot asperity alone is warmer.",
            "For temperatures of asperities take a patch that holds the contact.",
            level=INFO,
            headline="Contact temperatures leave out flashes of single asperities.",
        ),
        "edge": Reason(
            "Rough surfaces still touch {length:si m} from the middle, {across:.2g} half-widths of the smooth contact.",
            "Take a patch that holds the contact: grid.periodic = [false, true], with shape and lengths.",
            headline="The contact is wider than the film that is solved.",
        ),
        "pressure": Reason(
            "The mean pressure is {pressure:si Pa beside limit} at most; patches were solved up to {limit:si Pa}.",
            "Lower the load.",
            headline="The mean pressure exceeds the tabulated pressures of the repeated patch.",
        ),
    },
)
