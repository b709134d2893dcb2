"""Notes on scenes: what was done to surfaces, and what a kind of scene assumes."""

from bem.notes.note import Level, Reason, define

OUTSIDE_MODEL, CAUTION, INFO = Level.OUTSIDE_MODEL, Level.CAUTION, Level.INFO

MEMORY_SHORT = define(
    "memory-short",
    CAUTION,
    "The scene needs more memory than is free.",
    "It needs {needed}; a run now would be refused.",
    "Close other programs, or take fewer cells.",
)
FILM_THINNER_THAN_ROUGHNESS = define(
    "film-thinner-than-roughness",
    CAUTION,
    "The film is thinner than the roughness (lambda below 1).",
    "Surfaces touch{where}, which this smooth film leaves out.",
    "Use kind friction, which shares the load between film and surfaces.",
)
BODIES_APART = define(
    "bodies-apart",
    CAUTION,
    "The bodies do not touch.",
    "They stand {apart:si m} off; they touch at a mean gap of {touching:si m}.",
    "Take a larger approach, a smaller mean gap or a load.",
)
PATCH_SMALLER_THAN_HERTZ = define(
    "patch-smaller-than-hertz",
    CAUTION,
    "The patch does not cover Hertz' contact.",
    "The roughness fades out over {fading:%} of the side, and around it the body is smooth.",
    "Take a longer patch.",
)
LEAST_FILM_DECIDES = define(
    "least-film-decides",
    CAUTION,
    "contact.least_film and not the oil sets the contact's load share.",
    "Between smooth bodies the film would be thinner than that length.",
    "Take a smaller contact.least_film, or kind friction.",
)
WAVE_STEPS_FEW = define(
    "wave-steps-few",
    CAUTION,
    "The time steps damp the waves.",
    "There are {steps:.0f} steps per wavelength. With 20 steps per wavelength a wave loses 5 % over a wavelength, with "
    "32 1 %.",
    "Raise march.steps to {fewest} per wavelength or more.",
)
JOINT_CLOSED = define(
    "joint-closed",
    INFO,
    "The contact is full; the joint has no stiffness of its own.",
    "Every cell carries load on a doubly periodic grid: no gap is left to give way, and the bodies' own "
    "elasticity is not part of the joint.",
)
OILS_AT_ONE_TEMPERATURE = define(
    "oils-at-one-temperature",
    INFO,
    "All oils are at the flank temperature of the first, {celsius:.4g} degC.",
    "Each oil warms the flanks of gears differently; oil.temperature is one for all.",
    "Compare oils of a machine element by bem element --cases, which finds the temperature of each.",
)
PART_UNSOLVED = define(
    "part-unsolved",
    CAUTION,
    "The {part} did not converge.",
    "{message}; the residual is {residual:.2g}.",
    "{action}.",
)
MAP_SYNTHETIC = define(
    "map-synthetic",
    INFO,
    "The height map is synthetic.",
    "It has the sizes of the source's figures built in and confirms no model.",
)

# What was done to a measured surface
_FILLED = "Points of the map were filled smoothly from their neighbours."
_MUCH_FILLED = "{share:%} of the map was filled smoothly from neighbouring points."
_MAY_BE_ROUGHER = "Instruments lose steep points first, so the real surface may be rougher."
_OUTLIERS = "The measured map has outliers."
_SEAMS = "Making the map periodic changed its heights by {share:% beside limit} of Sq."
MAP_ALTERED = define(
    "map-altered",
    INFO,
    "The measured map was altered.",
    reasons={
        "missing": Reason("The file has no height for {points:count point}.", headline=_FILLED),
        "spikes": Reason(
            "Despiking took out {points:count point} and filled the gaps smoothly from the neighbours.",
            headline="Spikes of the map were removed.",
        ),
        "no-spikes": Reason(
            "No point stands out from its neighbours by {threshold:g} standard deviations.",
            headline="Despiking found no spikes in the map.",
        ),
        "much": Reason(
            _MAY_BE_ROUGHER,
            "Measure again if its peaks and slopes decide the result.",
            CAUTION,
            headline=_MUCH_FILLED,
        ),
        "gaps": Reason(
            _MAY_BE_ROUGHER,
            "Most of the missing points lie side by side in gaps: crop to a part without them, or measure again.",
            CAUTION,
            headline=_MUCH_FILLED,
        ),
        "outliers": Reason(
            "It has {points:count point} more than 6 standard deviations off their neighbours and a kurtosis Sku of "
            "{kurtosis:.3g}: single points carry much of the load.",
            "Set despike = 6 in its surface, if they are spikes of the instrument.",
            CAUTION,
            headline=_OUTLIERS,
        ),
        "outliers-left": Reason(
            "After despiking, {points:count point} still stand out from their neighbours, and the kurtosis Sku is "
            "{kurtosis:.3g}: single points carry much of the load.",
            "Look at the map (bem surface plot), and crop it to a part without them if they are not of the surface.",
            CAUTION,
            headline=_OUTLIERS,
        ),
        "mirror": Reason(
            "It is mirrored, and symmetric about its seams: the patch holds {part} {copies} times, and load, area and "
            "number of contact spots are those of all of them.",
            headline="The measured surface was made periodic.",
        ),
        "mirror-cut": Reason(
            "The grid would hold the whole map; mirrored, it holds {part} {copies} times.",
            "Take a grid of twice the size along {along}: {size} hold the whole map.",
            CAUTION,
            headline="Mirroring on a grid as large as the map cuts it.",
        ),
        "seams": Reason(
            "The step where its ends meet along {along} is spread out (Moisan 2011): {change:si m} rms; up to "
            "{limit:%} of Sq the map counts as the same surface.",
            headline=_SEAMS,
        ),
        "seams-large": Reason(
            "The step where its ends meet is spread out (Moisan 2011): {change:si m} rms, beyond {limit:%} of "
            "its Sq, which is then {height:si m}.",
            "{action}",
            CAUTION,
            headline=_SEAMS,
        ),
        "scaled": Reason(
            "They are multiplied by {factor:.2g} to have Sq {height:si m}, and slopes with them.",
            "Leave rms_height out, or use a map of such a surface.",
            CAUTION,
            headline="Measured heights are scaled, and their slopes with them.",
        ),
    },
)
HEIGHT_UNIT_DOUBTFUL = define(
    "height-unit-doubtful",
    CAUTION,
    "The heights of the map are unusual: is the height unit right?",
    reasons={
        "steep": (
            "Its rms slope Sdq is {slope:.3g beside limit} and its Sq {height:si m}; real surfaces stay below "
            "{limit:g}."
        ),
        "smooth": "Its rms height Sq is {nanometres:.2g} nm; an atom is 0.2 nm wide, and 0.5 nm and more are usual.",
    },
    action="Check the unit: height_unit in a scene, --height-unit of the commands.",
)
MAP_SPACING_GIVEN = define(
    "map-spacing-given",
    CAUTION,
    "The given spacing of points contradicts the file.",
    "Points are taken as {own} apart; the file says {other}. A wrong spacing spoils every slope.",
    "Check spacing.",
)
