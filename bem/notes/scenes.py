"""Notes on scenes: what was done to surfaces, and what a kind of scene assumes."""

from bem.notes.note import Level, define

OUTSIDE_MODEL, CAUTION, INFO = Level.OUTSIDE_MODEL, Level.CAUTION, Level.INFO

MEMORY_SHORT = define(
    "memory-short",
    CAUTION,
    "The scene needs more memory than is free.",
    "It needs {needed}; a run now would be refused.",
    "Close other programs, or take fewer cells.",
)
GROSS_SLIDING_ASSUMED = define(
    "gross-sliding-assumed",
    INFO,
    "Friction and film are those of gross sliding.",
    "The bodies slide at the speeds given; partial slip is in the stresses below the surface and in what wears.",
)
FILM_THINNER_THAN_ROUGHNESS = define(
    "film-thinner-than-roughness",
    CAUTION,
    "The film is thinner than the roughness (lambda below 1).",
    "Asperities touch, and this smooth contact leaves them out.",
    "Use kind friction (mixed lubrication).",
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
    "It fades over {fading:%} of its sides, and around it the body is smooth.",
    "Take a longer patch.",
)
FILM_CELLS_PER_WAVE = define(
    "film-cells-per-wave",
    CAUTION,
    "The film has too few cells to the surface's shortest wave.",
    "It has about {cells:.2g}; load shares in contact change by tenths below {fewest:g}.",
    "Take more cells of the film.",
)
LEAST_FILM_DECIDES = define(
    "least-film-decides",
    CAUTION,
    "contact.least_film and not the oil sets the contact's load share.",
    "Between smooth bodies the film would be thinner than that length.",
    "Take a smaller contact.least_film, or kind friction.",
)
RIM_NARROW = define(
    "rim-narrow",
    CAUTION,
    "Surfaces touch in a rim that is narrower than the cells.",
    "Beside it the gap opens within {cells:.2g} cells: films there are too thin, and the surfaces' load "
    "share is an upper bound.",
    "Take {wanted} cells or more.",
)
WAVE_STEPS_FEW = define(
    "wave-steps-few",
    CAUTION,
    "The time steps damp the waves.",
    "There are {steps:.0f} steps a wave; 20 steps damp a wave by 5 % over a wavelength, 32 steps by 1 %.",
    "Take more march.steps.",
)
PRESSING_IN_STEPS = define(
    "pressing-in-steps",
    INFO,
    "Pressure alone makes bodies that differ slip.",
    "The load comes in {steps} steps, and the stick area is known to about 1/{steps}; take twice "
    "push.pressing_steps to see.",
)
PRESSING_AT_ONCE = define(
    "pressing-at-once",
    CAUTION,
    "The whole load comes at once on bodies that differ.",
    "Surfaces slip as the load grows, and far too little sticks.",
    "Leave push.pressing_steps out ({usual}), or raise it.",
)
PRESSURE_WITHOUT_FRICTION = define(
    "pressure-without-friction",
    INFO,
    "The pressure is that of the contact without friction.",
    "The bodies differ in elasticity, so that tractions would change the pressure.",
)
JOINT_CLOSED = define(
    "joint-closed",
    INFO,
    "The contact is full, and the joint has no stiffness of its own.",
    "Every cell carries load on a doubly periodic grid: no gap is left to give way, and the bodies' own "
    "elasticity is not part of the joint.",
)
STIFFNESS_UNSOLVED = define(
    "normal-stiffness-unsolved",
    CAUTION,
    "A contact for the normal stiffness did not converge.",
    "{message}; the residual is {residual:.1e}.",
    "Take a larger tolerance, or more iterations.",
)
THIRD_BODIES_BEAR_LOAD = define(
    "third-bodies-bear-load",
    CAUTION,
    "Third bodies bear most of the load.",
    "They bear {share:%}: little of the surfaces touches, and wear is mostly what particles cut. Each is "
    "pressed in by itself; bodies do not bend under it.",
    "Let fewer stay, or take smaller ones.",
)
MAP_SYNTHETIC = define(
    "map-synthetic",
    INFO,
    "The height map is synthetic.",
    "It has the sizes of the source's figures built in and confirms no model.",
)
FLOW_FACTORS_UNSOLVED = define(
    "flow-factors-unsolved",
    CAUTION,
    "The flow factors did not converge.",
    "{message}; the residual is {residual:.2g}.",
    'Take more cells, or flow_factors = "off".',
)
TRIBOFILM_SHARES_AS_BEFORE = define(
    "tribofilm-shares-as-before",
    INFO,
    "Oil and surfaces share the load as without a tribofilm.",
    "How its thickness and softness change the share is left out.",
)

# What was done to a measured surface
MAP_FILLED = define(
    "map-filled",
    INFO,
    "{missing} missing points are filled from their neighbours.",
)
MAP_SPACING_GIVEN = define(
    "map-spacing-given",
    INFO,
    "Points are taken as {own} apart.",
    "The file says {other}.",
)
MAP_SPIKES = define(
    "map-spikes-removed",
    INFO,
    "{spikes} spikes were removed and filled from their neighbours.",
)
MAP_RESAMPLED = define(
    "map-resampled",
    INFO,
    "{points} points at {spacing} taken as {cells} cells at {cell}.",
)
MAP_MIRRORED = define(
    "map-mirrored",
    INFO,
    "Made periodic by mirroring.",
    "The surface is symmetric about its seams.",
)
MAP_CONTINUED = define(
    "map-continued",
    INFO,
    "Continued periodically along {along}.",
    "The step where its ends meet is spread out (Moisan 2011), which changes the heights by {change:si m} rms.",
)
