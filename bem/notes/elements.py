"""Notes on machine elements."""

from bem.notes.note import Level, Reason, define

CAUTION, INFO = Level.CAUTION, Level.INFO

NO_HEAT = define(
    "element-without-heat",
    INFO,
    "Heat of the film cannot be computed: thermal constants are missing.",
    reasons={
        "bodies": Reason(
            "{bodies} without thermal_conductivity, heat_capacity and density.",
            "Give these constants to have the film's heat.",
        ),
        "oil": Reason(
            "The oil lacks temperature, density, heat_capacity, thermal_conductivity or temperature_viscosity.",
            "Give these constants, or a grade of the catalogue, to have the film's heat.",
        ),
    },
)
SPEED_WITHOUT_UNIT = define(
    "speed-without-unit",
    CAUTION,
    "speed = {speed:g} without a unit is in rad/s: {rpm:.6g} rpm.",
    "",
    'Write the unit, such as "1500 rpm" if revolutions per minute are meant.',
)
SPEED_IN_TURNS = define(
    "speed-in-turns",
    INFO,
    'speed = "{given}" is read as revolutions per minute.',
    "",
    'Write "{rpm:.6g} rpm".',
)
BODIES_COLDER = define(
    "bodies-colder-than-oil",
    CAUTION,
    "The bodies, at {bulk:.3g} °C, are colder than the oil, at {oil:.3g} °C.",
    "Oil comes into the contacts as cold as the bodies: films are thicker and safeties larger than with bodies that "
    "friction warms above the oil.",
    "Check bulk_temperature, or leave it out.",
)
KAPPA_ABOVE_FILM = define(
    "kappa-above-film",
    CAUTION,
    "These surfaces are rougher than the viscosity ratio kappa assumes: the modified life is shorter.",
    reasons={
        "shorter": Reason(
            "kappa = {kappa:.3g} is the viscosity over the one that bearings of usual finish need. These surfaces have "
            "lambda = {ratio:.3g}, which stands for kappa = {film:.3g} (ISO 281: kappa is about lambda to the power "
            "1.3).",
            "The modified lives given first (in tables of cases the only ones) have the kappa of lambda, {film:.3g}.",
        ),
        "not defined": Reason(
            "kappa = {kappa:.3g} is the viscosity over the one that bearings of usual finish need. These surfaces have "
            "lambda = {ratio:.3g}, which stands for kappa = {film:.3g} (ISO 281: kappa is about lambda to the power "
            "1.3); below 0.1 ISO 281 gives no modified life.",
            "Take a thicker oil or a finer finish.",
            headline="The film is too thin for a modified life: kappa of lambda is {film:.2g}, below 0.1.",
        ),
    },
)
BALANCE_BELOW_USUAL = define(
    "balance-below-usual",
    CAUTION,
    "The heat balance has only the friction of the balls' films: with the usual friction moment of such bearings it "
    "gives {celsius:.0f} °C.",
    "0.0015 x P x bore / 2, P the equivalent load, is {usual:.3g} W where the films have {films:.3g} W; cage, churning "
    "and seals are missing.",
    "Take film and lives as upper bounds, or give bulk_temperature.",
)
RATING_NOT_OF_GEOMETRY = define(
    "rating-not-of-geometry",
    CAUTION,
    "The rating of {given:si N} does not fit the bearing's dimensions, which have {own:si N} by ISO 281 and ISO 76.",
    "Catalogues differ from these by up to some 40 %.",
    "Check diameter, length and count of the rolling elements, bore and outside.",
)
LOAD_ABOVE_LIFE_FORMULA = define(
    "load-above-life-formula",
    CAUTION,
    "The load is above half the dynamic rating.",
    "P / C = {ratio:.2g}; ISO 281 says that its life formulas hold up to 0.5, above which local plastic deformation "
    "shortens lives.",
    "Take the lives as upper bounds.",
)
STATIC_LOAD_ABOVE_RATING = define(
    "static-load-above-rating",
    CAUTION,
    "The load is above the static rating: static safety C0 / P0 is {safety:.2g}, below 1.",
    "Below 1 rolling elements and raceways keep a permanent deformation of more than about 1/10000 of the element's "
    "diameter, which the static rating of ISO 76 allows.",
    "Lower the load, or take a larger bearing.",
)
SURFACES_TOUCH = define(
    "element-surfaces-touch",
    CAUTION,
    "Surfaces touch: the film is thinner than the roughness (lambda below 1).",
    "",
    "Mixed friction of one contact: `bem element FILE --scene mixed.toml --kind friction` writes its scene.",
    reasons={
        "slides": "That is so at {touching} of {places} places. The answer estimates what asperities carry and rub; "
        "the films themselves are smooth.",
        "rolls": Reason(
            "That is so at {touching} of {places} places. The answer estimates what asperities carry, which "
            "hardly rub in rolling; the films themselves are smooth.",
            "Mixed friction of one contact: `bem element FILE --scene mixed.toml --kind friction` writes its scene; "
            "set speeds.slide_roll_ratio there, as asperities do not rub in pure rolling.",
        ),
    },
)
CONTACT_LOST = define(
    "contact-lost",
    CAUTION,
    "The bodies separate during part of the turn.",
    reasons={
        "ring": Reason(
            "At {lost} of {all} angles the pressure below the ring exceeds that above by more than tension holds; those"
            " are left out.",
            "Raise the tension.",
        ),
        "follower": Reason(
            "At {lost} of {all} angles spring and preload do not hold the follower at this speed; those are left out.",
            "Take a stiffer spring or a lower speed.",
        ),
    },
)
RING_AT_EDGE = define(
    "ring-at-edge",
    CAUTION,
    "Contact or film reach an edge of the ring's face.",
    "",
    "Take a face that is wider (axially) or more crowned.",
    reasons={
        "contact": (
            "Hertz' contact does at {places} of {all} angles, such as {first}: neither it nor a film of it is that "
            "of a parabola there."
        ),
        "film": (
            "At {places} of {all} angles, such as {first}, a rigid film ends behind the trailing edge: with that edge "
            "it carries less and is thinner than given."
        ),
    },
)
FILM_BY_SQUEEZE = define(
    "film-by-squeeze",
    INFO,
    "Where the speed reverses, squeeze keeps a film.",
    "",
    "Follow it in time with kind film.",
    reasons={
        "ring": (
            "At {places} of {all} angles, such as {first}, the speed changes faster than the film sinks under its "
            "load. It is thicker than the steady one while the speed falls, and after the reversal until it has sunk "
            "to the steady one, which grows; only from there it is thinner."
        ),
        "follower": "Entrainment turns round at {angles}; steady scenes have no squeeze.",
    },
)
FOLLOWER_PASSED_OFTEN = define(
    "follower-passed-often",
    INFO,
    "The contact passes places of the follower more than once a turn.",
    "The contact wanders to and fro, slowly where it turns round: depths per pass have no limit there, and "
    "wear per hour is not known.",
)
BUSH_CONFORMS = define(
    "bush-conforms",
    CAUTION,
    "The contact wraps around the shaft; film and scenes are of a flat one.",
    "The contact reaches {angle:.0f} degrees to either side. The contact of a cylinder on a flat, of which films and "
    "scenes are, deviates from it by {pressure:+.0%} in peak pressure and {width:+.0%} in width.",
    "Take films, lambda ratio and scenes as estimates; peak pressure and wear here are those of the wrapped contact.",
)
BUSH_SWINGS = define(
    "bush-swings",
    CAUTION,
    "The film is that of steady sliding at the mean speed.",
    "Where the shaft turns round there is no entrainment, and surfaces touch.",
    "Take the film as an upper bound.",
)
BUSH_OVER_LIMIT = define(
    "bush-over-limit",
    CAUTION,
    "The bush exceeds a limit.",
    reasons={
        "pv": Reason(
            "p v is {value:.3g beside limit} MPa m/s, {ratio:.2g beside 1} times the limit of {limit:.3g} MPa m/s.",
            "Lower load or speed, take a larger bush or another material.",
            headline="Pressure times velocity (p v) exceeds its limit.",
        ),
        "temperature": Reason(
            "It would reach {value:.4g beside limit} °C, above {limit:.4g} °C; wear and life do not hold.",
            "Lower friction, load or speed, or lead off more heat (heat_balance).",
            headline="The bush becomes too hot: it would soften or melt.",
        ),
        "given": Reason(
            "It would reach {value:.4g beside limit} °C, above {limit:.4g} °C; wear and life do not hold.",
            "Lower friction, load or speed, or lead off more heat (heat_balance).",
            headline="The bush becomes too hot: above maximum_temperature.",
        ),
        "yield": Reason(
            "The peak pressure is {value:.3g beside limit} MPa, the yield stress of the bush {limit:.3g} MPa. "
            "Polymers creep far below.",
            "Lower the load, or take a longer or wider bush.",
            headline="The pressure exceeds the yield stress of the bush.",
        ),
    },
)
BUSH_SWELLS = define(
    "bush-swells",
    CAUTION,
    "Thermal expansion, which is left out, may close the clearance.",
    "At {bush:.0f} °C a linear expansion coefficient of {closing:.1e} 1/K closes the radial clearance of "
    "{clearance:si m}, with the wall held in a housing that does not expand; polymers have {low:.0e} to {high:.1e} "
    "1/K.",
    "Give the clearance of the warm bush, or take a larger clearance, a thinner wall or less heat.",
)
VISCOSITY_FIXED = define(
    "viscosity-fixed",
    CAUTION,
    "The viscosity does not follow the heat balance.",
    "The bodies have {bulk:.0f} °C; films have the viscosity that is given for {oil:.0f} °C.",
    "Give oil.temperature_viscosity, or oil.grade.",
)
OIL_FOLLOWS_BALANCE = define(
    "oil-follows-balance",
    CAUTION,
    "The oil is as warm as the bodies, not at oil.temperature.",
    "With an ambient the heat balance gives the temperature of bodies and oil, {bulk:.4g} °C; oil.temperature, "
    "{oil:.4g} °C, is not used.",
    "If the oil comes at {oil:.4g} °C, as from a cooler or a sump, leave out heat_balance.ambient: the heat then goes "
    "to this oil. Otherwise check the conductance, and leave out oil.temperature.",
)
_STILL_AIR = (
    "Cooling by still air is assumed. In flowing liquid give bulk_temperature, or heat_balance with its conductance "
    "and without ambient; film and friction do not hold."
)
"""Action where the bush's temperature hangs on the usual conductance."""
BUSH_LIQUID_LOST = define(
    "bush-liquid-lost",
    CAUTION,
    "The liquid does not stay in the bush.",
    "",
    "Lead off more heat (heat_balance), lower friction, load or speed, or keep the liquid under pressure; film and "
    "friction do not hold.",
    reasons={
        "boils": Reason(
            "The bush has {bush:.0f} °C, its surface {rise:.2g} K more; at ambient pressure the liquid boils at "
            "{limit:.0f} °C.",
            headline="The liquid boils in the bush.",
        ),
        "boils in still air": Reason(
            "The bush has {bush:.0f} °C, its surface {rise:.2g} K more; at ambient pressure the liquid boils at "
            "{limit:.0f} °C.",
            _STILL_AIR,
            headline="The liquid boils in the bush.",
        ),
        "evaporates in still air": Reason(
            "The bush has {bush:.0f} °C, its surface {rise:.2g} K more; the liquid should stay below {limit:.0f} °C.",
            _STILL_AIR,
            headline="The water of the liquid evaporates.",
        ),
        "evaporates": Reason(
            "The bush has {bush:.0f} °C, its surface {rise:.2g} K more; the liquid should stay below {limit:.0f} °C.",
            headline="The water of the liquid evaporates.",
        ),
        "freezes": Reason(
            "The bush has {bush:.0f beside limit} °C, the liquid freezes at {limit:.0f} °C.",
            "Take a liquid with more glycol, or a warmer bush.",
            headline="The liquid freezes in the bush.",
        ),
    },
)
BUSH_TOUCHES = define(
    "bush-touches",
    CAUTION,
    "Surfaces touch: the film is thinner than the roughness (lambda below 1).",
    "",
    "For your measured surfaces run the scene that `bem element FILE --scene mixed.toml --kind friction` writes.",
    reasons={
        "solved": "Asperities carry {share:.0%} of the load, for a random ground shaft with the roughness given.",
        "estimated": "By an estimate asperities carry {share:.0%} of the load.",
        "unknown": Reason(
            "The asperities' share of the load is not known: the film is an estimate as a rigid journal bearing.",
            "Film and friction do not hold; take a smoother shaft, more clearance or less load.",
        ),
        "clearance": Reason(
            "The radial clearance is {clearance:si m}, the rms roughness of both surfaces {roughness:si m}; the "
            "asperities' share of the load is not known.",
            "Check the unit of clearance; film, friction and temperature do not hold.",
            headline="The radial clearance is smaller than the roughness, and surfaces touch.",
        ),
    },
)
BUSH_FLOATS = define(
    "bush-floats",
    Level.OUTSIDE_MODEL,
    "The oil carries the shaft as in a journal bearing, which is not modelled.",
    reasons={
        "thick": Reason(
            "The film is {share:.0%} of the radial clearance. Of an endless cylinder on a flat it is {film:si m} thick "
            "with a friction coefficient of {friction:.2g}; by an estimate as a journal bearing of this length, all of "
            "it filled, it is {journal:si m} thick with {turning:.2g}.",
            "The film is {thicker:.2g} times that of the journal estimate, the friction {lower:.2g} times; take both "
            "from a program for journal bearings.",
        ),
        "thick, touching": Reason(
            "The film is {share:.0%} of the radial clearance. Of an endless cylinder on a flat it is {film:si m} thick "
            "with a friction coefficient of film and asperities of {friction:.2g}; by an estimate as a journal bearing "
            "of this length, all of it filled and without asperities, it is {journal:si m} thick with {turning:.2g}.",
            "Asperities cause {rubbing:.0%} of the friction; the film is {thicker:.2g} times that of the journal "
            "estimate. Take film and load share from a program for journal bearings with mixed lubrication.",
        ),
        "beyond": Reason(
            "Of an endless cylinder on a flat the film would be {film:si m} thick, more than the radial clearance of "
            "{clearance:si m}. By an estimate as a journal bearing of this length, all of it filled, it is "
            "{journal:si m} thick with a friction coefficient of {turning:.2g}.",
            "Film, lambda ratio and friction are estimates as a rigid journal bearing; take them from a program for "
            "journal bearings.",
        ),
        "beyond-scene": Reason(
            "The film of an endless cylinder on a flat, {film:si m}, is thicker than the radial clearance of "
            "{clearance:si m}, which is impossible. By an estimate as a journal bearing of this length, all of it "
            "filled, it is {journal:si m} thick with a friction coefficient of {turning:.2g}.",
            "Film, lambda ratio and friction do not hold; take them from a program for journal bearings.",
        ),
    },
)
_BOUNDS = (
    "The film is {{share:.0%}} of the radial clearance, and its pressure reaches far around the shaft. It is at most "
    "{{film:si m}} thick, as of an endless cylinder on a flat, from whose ends nothing leaks (friction coefficient{of} "
    "{{friction:.2g}}), and by an estimate at least {{journal:si m}}, as of a rigid journal bearing of this length, "
    "which does not flatten (friction coefficient of its film {{turning:.2g}})."
)
"""Sentence on the two bounds; `of` says of what the friction is."""
BUSH_BOUNDS = define(
    "bush-film-bounds",
    CAUTION,
    "The film of this bush is known only between two bounds.",
    "",
    "Judge touching by the lower bound, {journal:si m}, or solve it with a program for elastic journal bearings.",
    reasons={
        "film": _BOUNDS.format(of=""),
        "touching": _BOUNDS.format(of=" of film and asperities") + " Asperities cause {rubbing:.0%} of the friction.",
    },
)
BUSH_WARMER_THAN_OIL = define(
    "bush-warmer-than-oil",
    CAUTION,
    "The bush is warmer than the liquid that its film was solved with.",
    "The bush has {bush:.0f} °C by the heat balance; its film and friction are those of the liquid at {oil:.0f} °C.",
    "Give the conductance of your housing and of the liquid that flows through (heat_balance), or a warmer liquid.",
)
BUSH_WEARS_IN_FILM = define(
    "bush-wears-in-film",
    CAUTION,
    "Wear and life are those of rubbing surfaces, but a film carries the load.",
    "",
    "Take the specific wear rate of starts and stops, or of a test in this lubricant at this lambda ratio.",
    reasons={
        "turns": "Asperities have {share:.1%} of the load.",
        "swings": Reason(
            "At the mean speed asperities have {share:.1%} of the load; wear arises at the turning points.",
            "Take the specific wear rate of an oscillating test in this lubricant.",
            headline="At the mean speed a film carries the load; the turning points wear.",
        ),
        "bounds": Reason(
            "Asperities have {share:.1%} of the load at the upper bound of the film. At its lower bound, a lambda "
            "ratio of {ratio:.2g}, surfaces touch more, and friction is larger than that of the film.",
            "Take the specific wear rate of a test in this lubricant at these lambda ratios.",
            headline="Wear and life are those of rubbing surfaces, but a film may carry the load.",
        ),
    },
)
BUSH_ROUGHNESS_MISSING = define(
    "bush-roughness-missing",
    CAUTION,
    "Without rms_roughness it is not known whether shaft and bush touch.",
    reasons={
        "friction": Reason(
            "",
            "Friction and temperature hold only if a film carries the whole load; give rms_roughness of both together.",
        ),
        "friction and wear": Reason(
            "",
            "Friction, temperature and wear hold only if a film carries the whole load; give rms_roughness of both "
            "together.",
        ),
        "wear": Reason(
            "", "Take a specific wear rate measured in this lubricant, and give rms_roughness of both together."
        ),
    },
)
GLYCOL_ASSUMED = define(
    "glycol-assumed",
    CAUTION,
    "The pressure-viscosity coefficient of water-glycol is 3 1/GPa, not measured.",
    "",
    "Give oil.pressure_viscosity if you know it.",
    reasons={
        "bush": "3 to 6 1/GPa are usual; the peak pressure raises the viscosity by {change:.1%}.",
        "rolling": "It gives films of a third of a mineral oil's, as measured (Wan, Kenny and Spikes 1984, abstract); "
        "3 to 6 1/GPa are usual, and films are up to 45 % thicker with 6 1/GPa.",
    },
)
BUSH_LEAKS = define(
    "bush-leaks",
    CAUTION,
    "Liquid leaves this short bush at its ends, which the film leaves out.",
    "The bush is only {ratio:.2g} times as long as the contact is wide.",
    "Take film and lambda ratio as upper bounds.",
)
