"""Notes of checks on scenes, before a run and after it."""

from bem.notes.note import Level, define

OUTSIDE_MODEL, CAUTION, INFO = Level.OUTSIDE_MODEL, Level.CAUTION, Level.INFO

# Materials
VISCOELASTIC = define(
    "material-viscoelastic",
    CAUTION,
    "A polymer or rubber creeps, and solids here have no time dependence.",
    "Its modulus is {modulus:si Pa}.",
    "Take the modulus at the rate and temperature of the contact, and run a second one to compare.",
)
FATIGUE_CONSTANTS = define(
    "fatigue-constants-of-steel",
    CAUTION,
    "The fatigue constants are those of unalloyed and low-alloy steels.",
    "wear.criterion low_cycle_fatigue wears {material}, E = {modulus:si Pa}, which is none.",
    "Give the material its own ductility and exponent.",
)
LAYER_INCOMPRESSIBLE = define(
    "layer-incompressible",
    CAUTION,
    "The layer's stiffness hangs on the last digit of Poisson's ratio.",
    "Poisson's ratio {ratio:g} makes the bonded layer {stiffer:.0f} times as stiff in compression as its modulus.",
    "Measure Poisson's ratio, or bracket it with two runs.",
)
HARDNESS_UNLIKELY = define(
    "hardness-unlikely",
    CAUTION,
    "The hardness does not fit Young's modulus.",
    reasons={
        "low": (
            "{hardness:si Pa} is {share:.2g} of Young's modulus, below that of annealed metals (5e-4 to 0.2): "
            "check both units."
        ),
        "high": (
            "{hardness:si Pa} is {share:.2g} of Young's modulus, above that of a perfect solid (5e-4 to 0.2): "
            "check both units."
        ),
    },
)
CAP_OF_STIFFER = define(
    "cap-of-stiffer",
    CAUTION,
    "The contact is capped at the hardness of the stiffer body.",
    "{material} has neither hardness nor yield stress, so that pressures are capped at the {cap:si Pa} of {stiff}.",
    "Give {material} a hardness of its own.",
)
YIELD_UNLIKELY = define(
    "yield-stress-unlikely",
    CAUTION,
    "The yield stress does not fit the hardness.",
    "{stress:si Pa} is hardness / {ratio:.2g}; metals have hardness / 2.6 to / 3, brittle solids down to / 1.5.",
    "Leave yield_stress out (hardness / 2.8 is taken), or check both.",
)
TENSILE_CAP = define(
    "tensile-strength-as-cap",
    CAUTION,
    "The pressure is capped at 2.8 times a tensile strength.",
    "wear.criterion maximum_tension takes the yield stress of {material}, {stress:si Pa}, as its tensile "
    "strength; without a hardness the pressure is capped at 2.8 times that, {cap:si Pa}.",
    "Give {material} a hardness.",
)

# Operation
GROWTH_WITHOUT_BARRIER = define(
    "growth-without-barrier",
    CAUTION,
    "The tribofilm grows at its prefactor, whatever the temperature.",
    "Shear stress {stress:si Pa} x activation volume is {lowered:.2g} eV, above the barrier of {barrier:.2g} eV.",
    "Check activation_volume and its unit.",
)

# Surfaces
SURFACE_STEEP = define(
    "surface-steep",
    CAUTION,
    "The roughness is too steep for half-spaces.",
    "Its rms slope is {slope:.2g}; half-spaces stand for slopes well below one, and pressures grow with them.",
    "Filter the surface (low_pass, cutoff_wavelength), or read the result as a trend.",
)
SURFACE_IS_FORM = define(
    "surface-is-form",
    CAUTION,
    "The heights are form, or in a wrong unit.",
    "Sq {height:si m} is {share:%} of the patch's side.",
    "Check height_unit and rms_height, or remove form.",
)
MAP_MUCH_FILLED = define(
    "map-much-filled",
    CAUTION,
    "Many points of the map were missing.",
    "{share:%} are filled smoothly; instruments lose the steep ones, so the real surface is rougher.",
    "Crop to a whole part, or measure again.",
)
MAP_FEW_POINTS = define(
    "map-few-points",
    CAUTION,
    "What touches is interpolated, not measured.",
    "the grid lies on {points} measured points {apart} apart.",
    "Take a larger grid, or a finer map.",
)
MAP_COARSE = define(
    "map-coarse",
    CAUTION,
    "The cells are finer than the measured points.",
    "Cells are {finer:.2g} times finer than the points ({apart}): contact area and pressures are those of a"
    " smoothed surface.",
    "Take larger cells, or a finer map.",
)
MAP_SCALED = define(
    "map-scaled",
    CAUTION,
    "Measured heights are scaled out of proportion.",
    "They are multiplied by {factor:.2g} to have Sq {height:si m}, and slopes with them.",
    "Leave rms_height out, or use a map of such a surface.",
)

# The contact as a whole
CONTACT_WIDE = define(
    "contact-wide",
    CAUTION,
    "The contact is wide for the radius of its bodies.",
    "contact radius {ratio:.2g} of the body's: half-spaces and small strains hold below about 0.2; strains "
    "are of order {strain:%}.",
    "Expect errors of several per cent, or use finite elements with large deformations.",
)
PRESSURE_ABOVE_HARDNESS = define(
    "pressure-above-hardness",
    CAUTION,
    "The elastic contact exceeds the hardness; a real one would flow.",
    "Hertz pressure {pressure:si Pa} is {ratio:.2g} times the softer hardness.",
    "To stay below the hardness, {action}.",
)
YIELD_BELOW_SURFACE = define(
    "yield-below-surface",
    CAUTION,
    "The softer body begins to yield below its surface.",
    "Hertz pressure {pressure:si Pa} is {ratio:.3g} times that at which it begins to yield, {onset:si Pa}: "
    "elastic stresses there are too high, and the first loadings leave residual stresses.",
    "Lower the load, or expect residual stresses.",
)
LOAD_NEAR_HARDNESS = define(
    "load-near-hardness",
    CAUTION,
    "Most of the patch would be at the hardness.",
    "The load is {ratio:.2g} of hardness x area of the grid.",
    "Take a smaller load or a larger grid.",
)
GRID_SMALLER_THAN_HERTZ = define(
    "grid-smaller-than-hertz",
    CAUTION,
    "The contact would reach the grid's edge and end there.",
    "The grid is {length:si m} along {axis} for a Hertz contact of {size:si m}.",
    "Take {wanted:si m} or more.",
)
PATCH_IS_PUNCH = define(
    "patch-is-punch",
    CAUTION,
    "The flat patch is a punch with pressure peaks along its edges.",
    "It is nominally flat and free along {axes}.",
    "Set grid.periodic = true to make it part of a larger contact.",
)
BODY_REPEATS = define(
    "body-repeats",
    CAUTION,
    "The curved body repeats with the periodic grid.",
    "It is periodic along {axis}, so the {shape} repeats every {length:si m}{near}.",
    "For one body make that axis free.",
)
PATCH_SINKS = define(
    "patch-sinks",
    INFO,
    "Loads at a given separation depend on the patch's length.",
    "The half-space sinks in by up to {sunk:si m} under the mean pressure of the patch, {length:si m} long.",
)
WAVE_DOES_NOT_FIT = define(
    "wave-does-not-fit",
    CAUTION,
    "The wave has a kink at the grid's seam.",
    "{waves:.4g} waves lie on a periodic grid of {length:si m}.",
    "Take a whole number of waves.",
)
CYLINDER_NARROW = define(
    "cylinder-narrow",
    CAUTION,
    "The cylinder is too narrow for a line contact.",
    "It is {ratio:.2g} times as wide as its contact is long; plane strain is no model of it below about five.",
    "Check width, or take an ellipsoid in kind contact.",
)

# The mesh
CELLS_ACROSS_CONTACT = define(
    "cells-across-contact",
    CAUTION,
    "The grid has few cells across the Hertz contact.",
    "There are {across:.2g} cells; {fewest} give the pressure within 1.5 % and the area within 13 %, and 40 give maps.",
    "Take {fewest} or more: spacing {spacing:si m} gives 20.",
)
WAVES_OF_TWO_CELLS = define(
    "waves-of-two-cells",
    CAUTION,
    "Slope, contact area and pressures change with every mesh.",
    "Without cutoff_wavelength the waves go down to two cells, {wave:si m}.",
    "Give cutoff_wavelength, 4 to 8 cells or more.",
)
CELLS_PER_WAVE = define(
    "cells-per-wave",
    CAUTION,
    "The grid has few cells to the shortest wave.",
    "There are {cells:.2g} cells to the shortest wave of the {body} surface ({wave:si m}): contact spots "
    "come down to single cells.",
    "Take a spacing of {spacing:si m}, or {average:si m} for averages.",
)
CELLS_PER_CORRELATION_LENGTH = define(
    "cells-per-correlation-length",
    CAUTION,
    "The grid hardly resolves the asperities.",
    "The correlation length of the {body} surface, {length:si m}, is {cells:.2g} cells.",
    "Take a spacing of {spacing:si m} or less.",
)
PATCH_SHORT = define(
    "patch-short",
    CAUTION,
    "The patch is short, and a handful of summits decides.",
    reasons={
        "unknown": (
            "The autocorrelation of the {body} surface does not fall to 1/e within half of the patch: take a "
            "larger patch or several repetitions, or remove form with detrend or high_pass."
        ),
        "few": (
            "The patch is {lengths:.2g} correlation lengths of the {body} surface long: take a larger patch or "
            "several repetitions, or remove form with detrend or high_pass."
        ),
    },
)
LAYER_THIN = define(
    "layer-thin",
    CAUTION,
    "The cells do not resolve the layer's bending and stresses.",
    "It is {thickness:si m} thick on cells of {cell:si m}: only its compliance is found.",
    "Take cells of its thickness, or leave it out.",
)
LAYER_THICK = define(
    "layer-thick",
    CAUTION,
    "The layer is so thick that the substrate is hardly felt.",
    "It is {thickness:si m} thick over a grid of {length:si m}.",
    "Make the layer the body's material, which is faster.",
)
DEPTHS_MISS_STRESS = define(
    "depths-miss-stress",
    CAUTION,
    "outputs.depths miss the largest von Mises stress.",
    "It lies {at:si m} below the surface; the nearest depth is {nearest:si m}.",
    "Take depths every {step:si m} around {at:si m}.",
)
DEPTHS_IN_LAYER_FEW = define(
    "depths-in-layer-few",
    CAUTION,
    "outputs.depths may miss the largest stresses of a layered body.",
    "{found} of the {body} body.",
    "Set {fewest} or more in every layer, and one just above and just below every interface.",
)
DEPTHS_COARSER_THAN_CELLS = define(
    "depths-coarser-than-cells",
    CAUTION,
    "The thickness of particles follows depths.spacing.",
    "It is {ratio:.2g} cells.",
    "Take the cell, {cell:si m}, or less.",
)
CRITERION_UNRESOLVED = define(
    "criterion-unresolved",
    CAUTION,
    "Particle sizes follow the mesh.",
    "The length of wear.criterion {law}, {length:si m}, is {cells:.2g} cells.",
    "Take cells of {cell:si m} or less.",
)
LAYER_OF_ONE_DEPTH = define(
    "layer-of-one-depth",
    CAUTION,
    "Particles of the layer are one depth thick.",
    "depths.spacing {step:si m} is more than the {body} layer's thickness, {thickness:si m}.",
    "Take a third of the thickness.",
)
NOTHING_SLIDES = define(
    "nothing-slides",
    CAUTION,
    "Every cycle meets the same asperities.",
    "wear.shift = 0: the surfaces do not slide on.",
    "Take 1 or more.",
)
SLIDES_DIFFER = define(
    "slides-differ",
    CAUTION,
    "Meshes are compared at different sliding.",
    "Variants slide {shortest} to {longest} in a cycle.",
    "Take shifts in proportion to the cells.",
)

# Results of a contact
CONTACT_AT_EDGE = define(
    "contact-at-edge",
    CAUTION,
    "The contact ends at the free edge of the grid.",
    "It reaches the edge along {axes}: the outermost cells carry {share:%} of the load.",
    "Take a larger grid, or a periodic one for a part of a larger contact.",
)
PRESSURE_AT_SEAM = define(
    "pressure-at-seam",
    CAUTION,
    "The highest pressure lies on a seam of a mirrored surface.",
    "It is the mirror's (along {axes}), and so are the stress and the particles below it.",
    "Leave mirror out; the seams are then closed without ridges.",
)
ELASTIC_ABOVE_HARDNESS = define(
    "elastic-above-hardness",
    CAUTION,
    "Elastic pressures exceed the softer hardness; real summits would flow.",
    "They reach {pressure:si Pa}, {ratio:.2g} times that hardness, and {share:%} of the load is carried above it.",
    "Take {action}.",
)
STRAIN_LARGE = define(
    "strain-large",
    CAUTION,
    "Pressures exceed the range of linear elasticity.",
    "They reach {pressure:si Pa}, {ratio:.2g} times the contact modulus, and {share:%} of the load is "
    "carried above 0.2 of it: strains are of that order, and linear elasticity ends at about 0.1.",
    "Check units, smooth the surface, or cap the pressure at a hardness.",
)
CONTACT_AT_CAP = define(
    "contact-at-cap",
    INFO,
    "Pressures at the cap are an input, not a result.",
    "{cells} are at the hardness, {cap:si Pa}; nothing hardens there.",
)
CAP_WITHIN_ERROR = define(
    "cap-within-error",
    INFO,
    "On finer cells a part of the contact may be at the hardness.",
    "Nothing is at the hardness here, {cap:si Pa}, but it lies within the error of the highest pressure.",
)
CAPPED_NEARLY_FULL = define(
    "capped-nearly-full",
    CAUTION,
    "The capped contact is nearly full, and valleys would resist.",
    "{share:%} of the patch is in contact; a cap leaves the resistance out above about half.",
    "Take a smaller load or a larger patch.",
)
STRESS_AT_DEEPEST_DEPTH = define(
    "stress-at-deepest-depth",
    CAUTION,
    "The largest von Mises stress lies in the deepest depth.",
    "That depth is {depth:si m}; the stress may grow further down.",
    "Take deeper outputs.depths.",
)
STRESS_ABOVE_YIELD = define(
    "stress-above-yield",
    CAUTION,
    "Elastic von Mises stresses exceed the yield stress.",
    "They reach {stress:si Pa} and are too high in {volume:.3g} um^3.",
    "Lower the load, or read the stresses as a sign of where yield begins.",
)
SPOTS_SMALL = define(
    "spots-small",
    CAUTION,
    "Spots of contact are too small for these cells.",
    "The contact area lies between the least that carries the load at the hardness{of} and the cells in "
    "contact, {times:.2f} times as many in the last cycle.",
    "Take a finer grid.",
)

# Results of wear loops
SURFACE_ROUGHENED = define(
    "surface-roughened",
    OUTSIDE_MODEL,
    "The worn surface grew rough instead of running in.",
    "Sq went from {before:si m} to {after:si m}{of}: friction, film and particles at the end are of holes that "
    "the criterion and the cell made. Both surfaces together had {both:si m}, and pieces{holes} deeper than"
    " that leave holes{so}.",
    "Compare a finer grid, take fewer cycles, or a criterion that wears by pressure (archard).",
)
NO_WEAR_RATE = define(
    "no-wear-rate",
    CAUTION,
    "criterion_wear_rate is not the wear rate of a metal.",
    "It is up to {rate:.2g} mm3/(N m){of}; metals have 1e-9 to {severe:g}.",
    "Take volumes from a measured rate ([archard], or the criterion archard).",
)
NOT_SETTLED = define(
    "not-settled",
    CAUTION,
    "The loop has not settled.",
    "Means of the last cycles (25, or half of all) differ from those of as many before them: {drifting}; "
    "the figures of the end are those of this number of cycles.",
    "Take more cycles.count, or read the curves over cycles.",
)
WORN_STEEP = define(
    "worn-steep",
    CAUTION,
    "The worn scar is too steep for half-spaces.",
    "The bodies are worn {depth:si m} deep at a radius of {radius:si m}{of}: the scar's edge has a slope of"
    " {slope:.2g}, where half-spaces hold below about {limit:g}, and pressure, depth and width are not "
    "those of such bodies.",
    "Take less wear (a shorter wear.criterion.distance, fewer cycles.count), or the volume by load and distance alone.",
)
PARTICLES_OF_UNWORN = define(
    "particles-of-unworn",
    CAUTION,
    "Particles are asked for of a body that does not wear.",
    "sizes.particles_of names the {asked} body, and only the {worn} one wears: sizes and numbers, 0, are no result.",
    "Set sizes.particles_of to the body that wears.",
)
BOTH_BODIES_WEAR = define(
    "both-bodies-wear",
    INFO,
    "Heights and sizes are of one body, volumes of both.",
    "Heights, Sq and worn depth are those of the {first} one, volumes of both{particles}.",
)
WEAR_STEPS_OVERSHOOT = define(
    "wear-steps-overshoot",
    OUTSIDE_MODEL,
    "The wear law's steps overshoot.",
    "A cycle takes {give:.3g} m/Pa off, more than twice the {most:.3g} m/Pa by which the bodies give way "
    "from cell to cell: depths, roughness and contact are those of the steps.",
    "Take {share:.2g} times the wear.criterion.distance, in more cycles.count.",
)
WEAR_STEPS_LONG = define(
    "wear-steps-long",
    CAUTION,
    "The wear law's steps are long, which no error bar counts.",
    "They leave up to {step:si m} open of a mean depth of {depth:si m}{of}.",
    "Take a shorter wear.criterion.distance, and as many more cycles.count.",
)
NO_PARTICLES_BY_PRESSURE = define(
    "no-particles-by-pressure",
    INFO,
    "A law that wears by pressure makes no particles.",
    "Their sizes and numbers, 0, are no result.",
)
LOOP_WITHOUT_BARS = define(
    "loop-without-error-bars",
    INFO,
    "A single loop has no error bars.",
    "With cycles.coarser_grid = true it is made once more on the grid of twice the cell, which shows the "
    "error of the cells; repetitions show how figures scatter with the surface.",
)
PARTICLES_SMALL = define(
    "particles-small",
    CAUTION,
    "The mean size of particles is the mesh's.",
    "By number it is smaller than two cells of {cell:si m} in {few} of {all} runs (radius {radius:si m}): "
    "most are one cell.",
    "Take a finer grid, or the mean by volume.",
)
PARTICLES_OF_ONE_CELL = define(
    "particles-of-one-cell",
    CAUTION,
    "Number and mean by number of particles are the mesh's.",
    "{share:%} of the particles, with {volume:%} of their volume, are one cell wide ({cell}).",
    "Take a finer grid, or means by volume where their share is small.",
)
PARTICLES_AS_LARGE_AS_GRID = define(
    "particles-as-large-as-grid",
    CAUTION,
    "The grid decides the size of the largest particle.",
    "It is {largest:si m} long on a grid of {side:si m}.",
    "Take a larger grid, or read the particle as wear of the whole surface.",
)
NOTHING_CAME_OFF = define(
    "nothing-came-off",
    CAUTION,
    "Nothing came off by the criterion {law}.",
    "{takes}",
)
PARTICLES_CUT = define(
    "particles-cut",
    CAUTION,
    "Particles reach the deepest depth, and their volume is too small.",
    "{share:%} of the settled particles go on below it{unless}.",
    "Take more or wider depths.",
)
