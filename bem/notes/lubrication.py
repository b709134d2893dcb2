"""Notes on oils and lubricating films, with and without heat."""

from bem.notes.note import Level, define

OUTSIDE_MODEL, CAUTION, INFO = Level.OUTSIDE_MODEL, Level.CAUTION, Level.INFO

# The oil at its temperature
OIL_VISCOSITY_EXTRAPOLATED = define(
    "oil-viscosity-extrapolated",
    INFO,
    "The oil's viscosity is extrapolated in temperature.",
    "At {temperature:.4g} degC; its viscosity was measured from {low:.4g} to {high:.4g} degC.",
)
OIL_TOO_THICK = define(
    "oil-too-thick",
    CAUTION,
    "The oil is too thick to flow to a contact.",
    "Its viscosity is {viscosity:.3g} Pa s; gears starve above {limit:g} Pa s (SAE J306).",
    "Take a thinner oil or a higher temperature.",
)
OIL_ABOVE_FLASH_POINT = define(
    "oil-above-flash-point",
    CAUTION,
    "The oil is above its flash point, {flash_point:.4g} degC.",
    "",
    "Lower the temperature.",
)
OIL_ABOVE_SERVICE_LIMIT = define(
    "oil-above-service-limit",
    CAUTION,
    "The fluid does not last above {limit:.4g} degC.",
    "Its water evaporates.",
    "Lower the temperature.",
)
OIL_ALPHA_EXTRAPOLATED = define(
    "oil-pressure-viscosity-extrapolated",
    INFO,
    "The oil's pressure-viscosity coefficient is extrapolated.",
    'The correlation "{correlation}" was made from {thin:g} to {thick:g} {unit}{at}.',
    "Give pressure_viscosity if it is known.",
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
    },
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
    'With shear_law "{law}" it exceeds {strength:si Pa} + {slope:g} p, so the friction is too high.',
    'Take shear_law = "limited".',
)
SHEAR_LIMITED = define(
    "shear-limited",
    INFO,
    "The film's friction rests on the limiting shear stress.",
    "The oil is at that limit{limit} in much of the contact; coefficients of oils are 0.04 to 0.12.",
)
FILM_SLIPS = define(
    "film-slips",
    CAUTION,
    "The film thickness depends on the wall at which the oil slips.",
    "The oil is at its limiting shear stress in much of the contact, at a slide-to-roll ratio above 1: the "
    "thickness is uncertain by a tenth to a third.",
)
VISCOSITY_EXTRAPOLATED = define(
    "viscosity-extrapolated",
    INFO,
    "Viscosities in the middle of the contact are extrapolated.",
    reasons={
        "elastic": (
            'The pressure exceeds {limit:si Pa}, up to which viscosity_law "{law}" describes oils; the film '
            "forms in the inlet, where pressures are lower."
        ),
        "rigid": (
            'The pressure exceeds {limit:si Pa}, up to which viscosity_law "{law}" describes oils; between '
            "rigid bodies the film forms there, under pressures that flatten real bodies."
        ),
    },
)
VISCOSITY_GLASS = define(
    "viscosity-glass",
    CAUTION,
    "The viscosity law makes the oil a glass in the contact.",
    'viscosity_law "{law}" gives more than {glass:g} Pa s, where liquids flow by their limiting shear stress alone.',
    "Check pressure_viscosity: oils have 5 to 40 1/GPa.",
)
FILM_SPIKE = define(
    "film-spike",
    CAUTION,
    "The mesh does not resolve the pressure spike.",
    "Its height follows the mesh; film thickness and load do not.",
    "Do not use the highest pressure{remedy}.",
)
INLET_HEATING = define(
    "inlet-heating",
    CAUTION,
    "Inlet heat would make the film over 10 % thinner.",
    "This isothermal film is too thick by a factor of about {factor:.2g} (Gupta et al. 1992, for a mineral oil).",
    'Set thermal = "lumped".',
)
FILM_HEATING = define(
    "film-heating",
    CAUTION,
    "Sliding would heat the oil by more than {limit:g} K.",
    "This isothermal film has too much friction: the estimate is {rise:.2g} K between steel bodies in mineral oil.",
    'Set thermal = "lumped".',
)
FACTORS_CONTACT = define(
    "flow-factors-closed",
    CAUTION,
    "The flow factors bar all pressure flow where the film is thinnest.",
    "At {thinnest:si m} a film does not carry this load between these walls; the thickness is that of a "
    "least flow factor, {least:g}.",
    "Raise the speed or lower the load.",
)
FACTORS_EXTRAPOLATED = define(
    "flow-factors-extrapolated",
    CAUTION,
    "The film is thinner than the flow factors' smallest separation.",
    "It is {thinnest:si m} at its thinnest; the factors begin at {least:si m} and are extrapolated below.",
    "Compute factors at smaller separations.",
)
FIRST_FILM_LOAD = define(
    "first-film-load",
    INFO,
    "The first film misses the load.",
    "It is {origin} and carries the load {missed:+.2g} %.",
)
FIRST_SURFACES_UNDEFORMED = define(
    "first-surfaces-undeformed",
    INFO,
    "Surfaces in the contact at first lie undeformed in its film.",
)

# Films of point contacts, on their cells
BODIES_NOT_RIGID = define(
    "bodies-not-rigid",
    CAUTION,
    "Bodies are not rigid under this pressure.",
    "Under {pressure:si Pa} bodies of steel (E* {modulus:si Pa}, Moes' M {moes_load:.2g} and L "
    "{moes_material:.2g}) would flatten by {flattened:.2g} film thicknesses; the rigid regime ends at "
    "{limit:g}.",
    "Give contact_modulus.",
)
INLET_TOO_SHORT = define(
    "inlet-too-short",
    CAUTION,
    "The grid does not reach the inlet of the film.",
    "It begins where the gap is less than {limit:g} central films; upstream the pressure of rigid bodies is taken.",
    "Take a larger extent upstream.",
)
CELLS_LARGE_FOR_FILM = define(
    "cells-large-for-film",
    CAUTION,
    "The cells are too large for the contact and its film.",
    "Cells of {cell} m cover the contact and the film around it, {size} m from the centre.",
    "Give a smaller extent, or take more cells.",
)
CONSTRICTION_NARROW = define(
    "constriction-narrow",
    CAUTION,
    "The constriction is narrower than the cells.",
    "Beside the lowest cell the film is more than {limit:g} times as thick, so the minimum may be off by tenths.",
    "Take twice as many cells.",
)
INLET_FRICTION = define(
    "inlet-friction",
    INFO,
    "Friction depends on how far the inlet is filled with oil.",
    "Oil up to twice the distance would add {added:.2g} to the friction coefficient of {friction:.2g}.",
)
FILM_UNCERTAIN = define(
    "film-uncertain",
    CAUTION,
    "The film thickness is uncertain by more than {limit:%}.",
    "See the errors of the central and of the minimum thickness.",
    "Take more cells.",
)
FILM_ERROR_UNKNOWN = define(
    "film-error-unknown",
    INFO,
    "The error of the film thickness is unknown.",
    reasons={
        "no-film": "On half as many cells there is no film to compare with: take twice as many cells to see it.",
        "few-cells": "Half as many cells are too few to compare with: take {nx} x {ny} cells to see it.",
    },
)
HEIGHTS_COARSE = define(
    "heights-coarse",
    CAUTION,
    "The cells do not resolve the roughness in the film.",
    "Heights change from cell to cell by {change:.1f} of their rms, as waves of {cells:.2g} cells do.",
    "Take {fewest:g} cells to a wave, or filter the surface.",
)
ROUGH_FILM_NOT_FOUND = define(
    "rough-film-not-found",
    CAUTION,
    "No film was found; the figures are of the best iterate.",
    "Its residual is {residual:.1g}.",
    "Take more cells a wavelength, a higher speed or a lower surface.",
)
OIL_CREATED = define(
    "oil-created",
    CAUTION,
    "Oil is not conserved where ruptured films form again.",
    "Oil that appears there is {created:.2g} times the flow through the contact, and the oil carries too much load.",
    "Take waves that are longer or lower.",
)
CONTACT_SHARE_ERROR_UNKNOWN = define(
    "contact-share-error-unknown",
    INFO,
    "The error of the contact's load share is unknown.",
    "On half as many cells there is no film.",
)

# Heat
HEAT_NOT_FOUND = define(
    "heat-not-found",
    CAUTION,
    "No temperatures were found that fit the friction heat.",
    "The film is shown without temperatures, friction and heat.",
    "Give the oil a shear law with a limiting stress.",
)
FULL_HEAT_NOT_FOUND = define(
    "full-heat-not-found",
    CAUTION,
    "No film was found that carries the load with its heat.",
    "The last film that was found is shown without its temperatures, friction and heat.",
    "{remedy}",
)
INLET_FORMULA_EXTRAPOLATED = define(
    "inlet-formula-extrapolated",
    CAUTION,
    "The formula of inlet heating is extrapolated.",
    "Gupta et al. (1992) did not cover so much load and speed: the film thickness is an estimate.",
    'Set thermal = "full" on a line contact.',
)
INLET_FAST = define(
    "inlet-fast",
    CAUTION,
    "The inlet heats the oil beyond what lumped heat describes.",
    "The thermal loading mu0 beta u^2/k is {loading:.2g}; above {limit:g} films were up to a third too "
    "thin, and friction was 10 to 60 % off.",
    'Set thermal = "full" on a line contact.',
)
SLOW_SURFACE_WARMS = define(
    "slow-surface-warms-inlet",
    CAUTION,
    "Lumped heat leaves out that the slower surface warms the inlet.",
    "At a slide-to-roll ratio of 2 flooded films were 1.2 to 2.8 times as thick as with full heat.",
    'Set thermal = "full" on a line contact.',
)
HEAT_SPREADS = define(
    "heat-spreads-across",
    INFO,
    "Heat that spreads across the flow is left out.",
    "The temperature rise was a tenth to a quarter too large under balls, and two thirds under an ellipse "
    "4.5 times as long along the flow as across.",
)
OIL_CRACKS = define(
    "oil-cracks",
    CAUTION,
    "Oil or surfaces exceed {limit:.4g} degC, where oils crack.",
    "Viscosities there are extrapolated.",
    "Lower load, speed or sliding.",
)
OIL_BOILS = define(
    "oil-boils",
    CAUTION,
    "The fluid is above its boiling point in the contact.",
    "{oil} is taken as a liquid there.",
    "Lower load, speed or sliding.",
)
OIL_HOT_EXTRAPOLATED = define(
    "oil-hot-extrapolated",
    INFO,
    "The oil is hotter in the contact than its viscosity is known.",
    "{oil} is more than {beyond:g} K above {highest:.6g} degC, and its viscosity is extrapolated.",
)
BODY_AT_REST = define(
    "body-at-rest-cooled",
    INFO,
    "A body at rest is taken as cool at a distance.",
    "The distance is {distance}.",
)
EXPANSION_UNKNOWN = define(
    "oil-expansion-unknown",
    INFO,
    "The oil's thermal expansion is not known.",
    "Compression does not heat the oil, and its density does not fall with temperature.",
    "Take an oil of the catalogue.",
)
