"""Notes on wear loops, lives and tribofilms."""

from bem.notes.note import Level, define

OUTSIDE_MODEL, CAUTION, INFO = Level.OUTSIDE_MODEL, Level.CAUTION, Level.INFO

OIL_WITH_PARTICLES_UNKNOWN = define(
    "oil-with-particles-unknown",
    INFO,
    "How far the load sharing depends on the counted oil is unknown.",
    "Particles bear load, and the balance with the oil counted where the film carries is one without particles.",
    'Compare sharing.oil_volume = "loaded".',
)
FILM_KEEPS_SHAPE = define(
    "film-keeps-unworn-shape",
    CAUTION,
    "The film keeps the unworn shape of the standing body.",
    "{film} does not follow wear: the worn depth is {behind:%} of the film's gap, and counts as roughness alone.",
    "Take fewer cycles, or a flooded film of a cylinder.",
)
FILM_HAS_WORN_SHAPE = define(
    "film-has-worn-shape",
    INFO,
    "The film has the worn shape of the standing body.",
    'The shape is {depth:si m} deep (sharing.film_shape = "worn"), and films were solved for {shapes} shapes.',
)
WORN_SHAPE_WITHOUT_HEAT = define(
    "worn-shape-without-heat",
    INFO,
    "The worn shape changes the film as it changes an isothermal film.",
)
WORN_SHAPE_REACHES_END = define(
    "worn-shape-reaches-end",
    CAUTION,
    "The worn shape reaches the ends of the patch.",
    "It is {depth:si m} deep there, and the film takes it as going on beyond them.",
    "Make the grid longer along x.",
)
WORN_FILM_NOT_FOUND = define(
    "worn-film-not-found",
    OUTSIDE_MODEL,
    "In {kept} of {cycles} cycles the worn shape had no film.",
    "The film kept an earlier shape; at the end the worn depth is off the film's gap by {behind:%}.",
    'Compare sharing.film_shape = "unworn".',
)
WORN_FILM_AT_OTHER_LOAD = define(
    "worn-film-at-other-load",
    OUTSIDE_MODEL,
    "In {clamped} of {cycles} cycles wear changed the film inaccurately.",
    "No film of the worn shape was found at its own load, and the change at another film load was taken.",
    'Compare sharing.film_shape = "unworn".',
)
THIRD_BODIES_FULL = define(
    "third-bodies-full",
    CAUTION,
    "Third bodies cover the whole area.",
    "They do so in {full} of {cycles} cycles, and no more are counted.",
    "Let fewer stay (shed) or more leave.",
)
LOOP_PRESSED_AT_ONCE = define(
    "loop-pressed-at-once",
    INFO,
    "The bodies differ in elasticity, and each cycle's pressure comes at once.",
    "Pressure alone then makes surfaces slip, so the stick area of the loop is less certain than of like "
    "bodies; tractions change no pressure.",
)
LOOP_ALL_SLIPS = define(
    "loop-all-slips",
    CAUTION,
    "Every cell slips although the force is below the friction limit.",
    "The stick zone is narrower than a cell, and the sliding distance follows the cells.",
    "Take a smaller share, or smaller cells.",
)
LIFE_WITHOUT_PIECES = define(
    "life-without-pieces",
    INFO,
    "Particles: the criterion finds no piece in any pass.",
)
MICROPITTING_ASSUMPTIONS = define(
    "micropitting-assumptions",
    INFO,
    "Micropitting: pits stay in the surface, and cracks do not grow.",
    "Each pass counts one stress cycle, sampled in the positions; the residual stress is {residual:si Pa} "
    "as given, not that of the first passes. The bounds at most and at least cover cycle jumps and "
    "positions, not cells.",
)
LIFE_FRAME = define(
    "life-frame",
    INFO,
    'wear.passes = "{passes}" chooses the frame of the contact.',
    "Here {frame}.",
)
LIFE_MEANS = define(
    "life-means",
    INFO,
    "Figures over a life are means over {positions} positions.",
    "The positions pair each other's roughness; error bars hold {hold}.",
)
LIFE_DISTANCE_DIFFERS = define(
    "life-distance-differs",
    CAUTION,
    "wear.law.distance does not fit the speeds.",
    "It is {given:si m}; at these speeds a place slides {slid:si m} while the {length:si m} of the patch pass.",
    "Set wear.law.distance to {slid:si m}.",
)
