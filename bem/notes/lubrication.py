"""Notes on oils and lubricating films, with and without heat."""

from bem.notes.note import Level, Reason, define

OUTSIDE_MODEL, CAUTION, INFO = Level.OUTSIDE_MODEL, Level.CAUTION, Level.INFO

# The oil at its temperature
OIL_DATA_SHORT = define(
    "oil-data-short",
    INFO,
    "The oil's measured data do not cover this state.",
    reasons={
        "viscosity": (
            "Its viscosity is extrapolated to {temperature:.4g} degC; measured is {low:.4g} to {high:.4g} degC."
        ),
        "hot": (
            "{oil} is more than {beyond:g} K above {highest:.6g} degC in the contact; its viscosity is extrapolated."
        ),
        "pressure-viscosity": Reason(
            'The correlation "{correlation}" of its pressure-viscosity coefficient was made from {thin:g} to {thick:g}'
            " {unit}{at}.",
            "Give pressure_viscosity if it is known.",
        ),
        "expansion": Reason(
            "Its thermal expansion is not known: compression does not heat the oil, and its density does not fall with"
            " temperature.",
            "Take an oil of the catalogue.",
        ),
    },
)
OIL_TOO_THICK = define(
    "oil-too-thick",
    CAUTION,
    "The oil is too thick to flow to a contact.",
    "Its viscosity is {viscosity:.3g beside limit} Pa s; gears starve above {limit:g} Pa s (SAE J306).",
    "Take a thinner oil or a higher temperature.",
)
OIL_TOO_HOT = define(
    "oil-too-hot",
    CAUTION,
    "The liquid is hotter than it can stand.",
    "",
    "Lower temperature, load, speed or sliding.",
    reasons={
        "flash-point": Reason(
            "The oil is above its flash point, {limit:.4g} degC.",
            "Lower the temperature.",
            headline="The oil is hotter than its flash point.",
        ),
        "service": Reason("Above {limit:.4g} degC its water evaporates.", "Lower the temperature."),
        "cracks": Reason(
            "Oil or surfaces exceed {limit:.4g} degC, where oils crack; viscosities there are extrapolated.",
            headline="The oil is hotter than it can stand.",
        ),
        "boils": Reason(
            "In the contact it has {hottest:.0f} degC.",
            headline="The {oil} boils ({limit:.4g} degC at ambient pressure).",
        ),
    },
)

# Any film
FILM_NOT_FOUND = define(
    "film-not-found",
    CAUTION,
    "No film was found; the figures are of the last iterate.",
    reasons={
        "rigid-spike": (
            "Between rigid bodies an oil that pressure thickens carries any load at some gap, in a spike that "
            'gets narrower with every cell: give contact_modulus, or viscosity_law = "isoviscous".'
        ),
        "glass": (
            "Under Hertz' pressure, {hertz:si Pa}, the viscosity law gives more than {glass:g} Pa s, a glass: "
            "check pressure_viscosity and load; more cells do not help."
        ),
        "line": "Pressure or film is too steep for the mesh: take more points.",
        "elongated": (
            "The {nx} x {ny} cells are {longer:.2g} times as long along {far} as along {near}: about square "
            "ones, {first} x {second}, may find it."
        ),
        "narrow": (
            "On {nx} x {ny} cells the constriction of a heavy load of thin oil, or of an ellipse narrow along "
            "the flow, is a few cells wide: take twice as many cells."
        ),
        "rough": (
            "The roughness is solved with the film, to a residual of {residual:.1g}: take more cells a wavelength, a "
            "higher speed or a lower surface."
        ),
    },
)
WAVES_TOO_HIGH = define(
    "waves-too-high",
    CAUTION,
    "The roughness is too high for linear waves.",
    "The film is {ratio:.2g} times the rms heights, and waves would meet over {share:.1%} of the contact. Marches of "
    "surfaces down to a ratio of 0.5 kept a film of 15 to 35 % of the central one everywhere; below a ratio of one "
    "film ripples of sliding surfaces stand elsewhere than the waves say.",
    "Read the minimum as a lower limit; take kind point-film-time for the film itself.",
)
FILM_THICK = define(
    "film-thick",
    OUTSIDE_MODEL,
    "The film is thicker than {limit:%} of the radius.",
    "Reynolds' equation needs small slopes.",
    "Check viscosity, speed and load, and their units.",
)
FILM_MOLECULAR = define(
    "film-molecular",
    CAUTION,
    "The film is only a few molecules thick.",
    "Below {limit:si m} Reynolds' equation does not hold.",
    "Take the contact as one in boundary lubrication.",
)
SHEAR_BEYOND_MEASURED = define(
    "shear-beyond-measured",
    CAUTION,
    "The oil's shear stress exceeds any that was measured.",
    'With shear_law "{law}" it exceeds {strength:si Pa} + {slope:g} p, p the local pressure, so the friction is too '
    "high.",
    'Take shear_law = "limited".',
)
_MUCH_AT_LIMIT = "in much of the contact; limiting shear stress over pressure of oils is 0.03 to 0.12."
SHEAR_LIMITED = define(
    "shear-limited",
    INFO,
    "The oil's limiting shear stress sets the friction.",
    reasons={
        "friction": f"The oil is at that limit, {{strength:si Pa}} + {{slope:.3g}} p, {_MUCH_AT_LIMIT}",
        "friction-warm": (
            "The oil is at that limit, {strength:si Pa} + {slope:.3g} p at the {celsius:.0f} degC of the film, "
            + _MUCH_AT_LIMIT
        ),
        "friction-own-law": f"The oil is at that limit {_MUCH_AT_LIMIT}",
        "film": Reason(
            "The oil is at its limiting shear stress in much of the contact, at a slide-to-roll ratio above 1: the "
            "thickness is uncertain by a tenth to a third.",
            "Take the film thickness as an estimate, or lower the slide-to-roll ratio below 1.",
            CAUTION,
            headline="The film thickness depends on the wall at which the oil slips.",
        ),
    },
)
VISCOSITY_EXTRAPOLATED = define(
    "viscosity-extrapolated",
    INFO,
    "The viscosity law does not hold at the pressures in the contact.",
    reasons={
        "elastic": (
            'They exceed {limit:si Pa}, up to which viscosity_law "{law}" describes oils. The film thickness does not '
            "suffer, since the film forms in the inlet, at lower pressures. Sliding friction is uncertain where the "
            "oil stays below its limiting stress{factors}."
        ),
        "rigid": Reason(
            'They exceed {limit:si Pa}, up to which viscosity_law "{law}" describes oils; between rigid bodies the '
            "film forms there, under pressures that flatten real bodies.",
            "Give contact_modulus.",
            CAUTION,
        ),
        "glass": Reason(
            'viscosity_law "{law}" gives more than {glass:g} Pa s, a glass, where liquids flow by their limiting shear '
            "stress alone.",
            "Check pressure_viscosity: oils have 5 to 40 1/GPa.",
            CAUTION,
        ),
    },
)
FILM_SPIKE = define(
    "film-spike",
    CAUTION,
    "The mesh does not resolve the pressure spike.",
    "Its height follows the mesh; film thickness and load do not.",
    "Disregard the highest pressure{remedy}.",
)
SET_THERMAL = 'Set thermal = "lumped".'
"""What to do about heat that is left out where the kind has it."""
HEAT_LEFT_OUT = define(
    "heat-left-out",
    CAUTION,
    "Heat matters here, but the film is solved without.",
    "",
    "{remedy}",
    reasons={
        "inlet": (
            "Heat of the inlet would make the film over 10 % thinner: it is too thick by a factor of about "
            "{factor:.2g} (Gupta et al. 1992, for a mineral oil)."
        ),
        "sliding": (
            "Sliding would heat the oil by more than {limit:g} K, and friction is too high: the estimate is "
            "{rise:.2g} K between steel bodies in mineral oil."
        ),
    },
)
FLOW_FACTORS_LIMIT = define(
    "flow-factors-limit",
    CAUTION,
    "The flow factors do not cover such small separations.",
    reasons={
        "extrapolated": Reason(
            "The film is {thinnest:si m} at its thinnest; the factors begin at {least:si m} and are extrapolated"
            " below.",
            "Compute factors at smaller separations.",
            headline="The film is thinner than the flow factors' smallest separation.",
        ),
        "table": Reason(
            "At separations of {separations} the pressure flow factor along x is zero.",
            "Take larger separations, or a smoother patch.",
            headline="The oil finds no path through the touching surfaces.",
        ),
        "film": Reason(
            "The film's thinnest place, {thinnest:si m}, does not carry this load between these walls; the thickness"
            " is that of a least flow factor, {least:g}.",
            "Raise the speed or lower the load.",
            headline="The oil finds no path through the touching surfaces.",
        ),
    },
)
FIRST_FILM = define(
    "first-film",
    INFO,
    "The transient film does not begin in equilibrium.",
    reasons={
        "load": "The first film is {origin} and carries {missed:.2g} % {direction} than the load asked for.",
        "surfaces": "Rough surfaces in the contact are not yet deformed in its first film.",
    },
)

# Films of point contacts, on their cells
BODIES_NOT_RIGID = define(
    "bodies-not-rigid",
    CAUTION,
    "Bodies are not rigid under this pressure.",
    "Under {pressure:si Pa} bodies of steel (E* {modulus:si Pa}, Moes' M {moes_load:.2g} and L "
    "{moes_material:.2g}) would flatten by {flattened:.2g beside limit} film thicknesses; the rigid regime ends at "
    "{limit:g}.",
    "Give contact_modulus.",
)
INLET_TOO_SHORT = define(
    "inlet-too-short",
    CAUTION,
    "The grid begins too close to the contact.",
    "It begins where the gap is less than {limit:g} central films; upstream the pressure of rigid bodies is taken.",
    "Take a larger extent upstream.",
)
FILM_CELLS_FEW = define(
    "film-cells-few",
    CAUTION,
    "The cells are too large for this film; its thickness is uncertain.",
    "",
    "Take more cells.",
    reasons={
        "contact": Reason(
            "Cells of {cell} m cover the contact and the film around it, {size} m from the centre.",
            "Give a smaller extent, or take more cells.",
        ),
        "constriction": (
            "Beside the lowest cell the film is more than {limit:g} times as thick, its minimum may be off by tens of"
            " per cent."
        ),
        "error": "Its error is more than {limit:%}: see those of the central and of the minimum thickness.",
        "rim": Reason(
            "Surfaces touch in a rim beside which the gap opens within {cells:.2g} cells: films there are too thin, and"
            " the surfaces' load share is an upper bound.",
            "Take {wanted} cells or more.",
        ),
    },
)
INLET_FRICTION = define(
    "inlet-friction",
    INFO,
    "Friction leaves out the shear of oil in the outer inlet.",
    "",
    "Add it by hand where the inlet is filled that far; no key of a scene adds it.",
    reasons={
        "film": (
            "The friction coefficient, {friction:.3g}, is the sliding part of the oil's shear on the film's grid,"
            " without rolling resistance; oil that fills the inlet up to twice the distance of the grid's edges adds"
            " {added:.2g}."
        ),
        "mixed": (
            "The friction coefficient, {friction:.3g}, counts asperities and the sliding part of the oil's shear on the"
            " film's grid, without rolling resistance; oil that fills the inlet up to twice the distance of the grid's"
            " edges adds {added:.2g}."
        ),
    },
)
OIL_CREATED = define(
    "oil-created",
    CAUTION,
    "Oil is not conserved where the film forms again behind cavities.",
    "Oil that appears there is {created:.2g} times the flow through the contact, and the oil carries too much load.",
    "Take waves that are longer or lower.",
)

# Heat
HEAT_NOT_FOUND = define(
    "heat-not-found",
    CAUTION,
    "No temperatures were found that balance the frictional heat.",
    reasons={
        "lumped": Reason(
            "The film is shown without temperatures, friction and heat.",
            "Give the oil a shear law with a limiting stress.",
        ),
        "full": Reason(
            "The last film that was found is shown without its temperatures, friction and heat.",
            "{remedy}",
        ),
        "boundary": Reason(
            "Boundary friction rises with temperature faster than the bodies conduct its heat away.",
            "Lower load or sliding speed, or give a law that falls at such temperatures.",
        ),
    },
)
_LOADING = (
    "The thermal loading of the inlet, mu0 beta u^2/k, is {loading:.2g beside limit} (mu0 viscosity at ambient "
    "pressure, beta its relative fall per kelvin, u entrainment speed, k thermal conductivity of the oil)"
)
LUMPED_HEAT_LIMIT = define(
    "lumped-heat-limit",
    CAUTION,
    "The quick heat model (lumped) is outside its validated range.",
    "",
    "{remedy}",
    reasons={
        "formula": "Gupta et al. (1992) did not cover so much load and speed: the film thickness is an estimate.",
        "fast": Reason(
            f"{_LOADING}; it should be below {{limit:g}}. At this loading (1.4 at most was compared) and a "
            "slide-to-roll ratio of {nearest:g}, the nearest compared, film thickness was {film:+.0f} % off full heat "
            "and friction {friction:+.0f} %, over light and heavy loads.",
            headline="Quick heat (lumped) errs: film thickness {film:+.0f} %, friction {friction:+.0f} %.",
        ),
        "fast-slides": Reason(
            f"{_LOADING}, and the slide-to-roll ratio {{slide:.2g}}. At loadings above {{limit:g}} films were up to a "
            "third too thin at a ratio of 1, a quarter too thin to a quarter too thick at 1.25 to 1.5, and 1.3 to 2.7 "
            "times as thick at 2, where the slower surface warms the inlet; friction was 16 % too low to 60 % too "
            "high.",
            headline="Quick heat (lumped) errs here: films too thin or too thick.",
        ),
        "slides": Reason(
            "The slower surface warms the inlet: at a slide-to-roll ratio of 2 flooded films were 1.2 to 2.8 times as "
            "thick as with full heat, at 1 up to 1.17 times. Under light loads (Moes' M up to 1.5) and a thermal "
            "loading of the inlet above 0.2 they were at a ratio of 2 from a half too thin to a tenth too thick.",
            headline="Quick heat (lumped) gives too thick a film at a slide-to-roll ratio of {slide:.2g}.",
        ),
        "spreads": Reason(
            "Heat that spreads across the flow is left out: the temperature rise was a tenth to a quarter too large "
            "under balls, and two thirds under an ellipse 4.5 times as long along the flow as across.",
            "Take the temperature rise as an upper bound.",
            INFO,
        ),
    },
)
