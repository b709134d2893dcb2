"""Notes on wear loops, lives and tribofilms."""

from bem.notes.note import Level, Reason, define

OUTSIDE_MODEL, CAUTION, INFO = Level.OUTSIDE_MODEL, Level.CAUTION, Level.INFO

FILM_OF_OTHER_SHAPE = define(
    "film-of-other-shape",
    CAUTION,
    "The oil film does not follow the worn shape.",
    reasons={
        "unworn": Reason(
            "{film} keeps the unworn shape of the standing body: the worn depth is {behind:%} of the film's gap, and"
            " counts as roughness alone.",
            "Take fewer cycles, or a flooded film of a cylinder.",
        ),
        "end": Reason(
            "The worn shape reaches the ends of the patch, where it is {depth:si m} deep, and the film takes it as"
            " going on beyond them.",
            "Make the grid longer along x.",
        ),
        "earlier": Reason(
            "In {kept} of {cycles} cycles the worn shape had no film, and an earlier shape was taken; at the end the"
            " worn depth is off the film's gap by {behind:%}.",
            'Compare sharing.film_shape = "unworn".',
            OUTSIDE_MODEL,
        ),
        "other-load": Reason(
            "In {clamped} of {cycles} cycles no film of the worn shape was found at its own load, and the change of the"
            " film at another load was taken.",
            'Compare sharing.film_shape = "unworn".',
            OUTSIDE_MODEL,
        ),
    },
)
THIRD_BODIES_MANY = define(
    "third-bodies-many",
    CAUTION,
    "Third bodies cover the surfaces or bear most of the load.",
    "",
    "Let fewer particles stay (shed), let more leave, or take smaller ones.",
    reasons={
        "area": "In {full} of {cycles} cycles they cover the whole area, and no more are counted.",
        "load": (
            "They bear {share:%} of it: little of the surfaces touches, wear is mostly what particles cut, and each "
            "particle is pressed in by itself, without bending the bodies."
        ),
    },
)
LOOP_ALL_SLIPS = define(
    "loop-all-slips",
    CAUTION,
    "Every cell slips although the force is below the friction limit.",
    "The stick zone is narrower than a cell, and the sliding distance follows the cells.",
    "Take a smaller wear.traction.share, or smaller cells.",
)
PARTIAL_SLIP_IN_OIL = define(
    "partial-slip-in-oil",
    OUTSIDE_MODEL,
    "Stresses are those of partial slip, friction and film of gross sliding.",
    "In the last cycle {stick:%} of the contact sticks in the loop of wear.traction, but the friction coefficient and"
    " the film take the surfaces to slide everywhere at the given speeds.",
    'Take wear.traction = "gross_sliding", or kind wear for a contact that oscillates without a film.',
)
LIFE_DISTANCE_DIFFERS = define(
    "life-distance-differs",
    CAUTION,
    "wear.law.distance does not fit the speeds.",
    "It is {given:si m}; at these speeds a place of the lower surface slides {slid:si m} while it passes the "
    "{length:si m} of the patch, one of the upper surface {ratio:.3g} times as far.",
    "Set wear.law.distance to {slid:si m} and wear.law.upper_over_lower to {ratio:.3g} (times the passes of an upper "
    "place in a pass of a lower one).",
)
LIFE_BARS_WIDE = define(
    "life-bars-wide",
    CAUTION,
    "Error bars of the life are as large as its figures or nearly so.",
    "That of {figure} is {share:.0%} of it: means over {positions} positions of two rough surfaces scatter.",
    "Set wear.positions = {more}, or take a larger patch.",
)
PIECES_IN_SOME_STEPS = define(
    "pieces-in-some-steps",
    INFO,
    "Particles leave out what wore where no piece was found.",
    "Steps of the life in which the criterion {law} finds no piece wear {share:%} of the volume of the lower body; the "
    "number of particles is that of the rest.",
    "Take the number for the rest of the volume, or a criterion that finds pieces in all steps.",
)
MICROPITS_EARLY = define(
    "micropits-early",
    OUTSIDE_MODEL,
    "Only the micropitted share is invalid: micropits form too early.",
    "{share:%} of the surface fails within {cycles:.2g beside limit} cycles, by stresses that deform it plastically "
    "and so fall in later passes; the criterion holds above about {limit:g} cycles, and the built-in scene "
    "micropitting-rig gives more than 30 % where 1 % was measured (Morales-Espejel and Brizmer 2011).",
    "Compare surfaces and loads, not shares; take measured surfaces, and hardness from their material.",
)
