"""Notes of checks on scenes, before a run and after it."""

from bem.notes.note import Level, Reason, define

OUTSIDE_MODEL, CAUTION, INFO = Level.OUTSIDE_MODEL, Level.CAUTION, Level.INFO

# Materials
VISCOELASTIC = define(
    "material-viscoelastic",
    CAUTION,
    "The material may creep; the calculation is purely elastic.",
    "Its modulus is {modulus:si Pa}.",
    "Take the modulus at the rate and temperature of the contact, and run a second one to compare.",
)
FATIGUE_CONSTANTS = define(
    "fatigue-constants-of-steel",
    CAUTION,
    "Fatigue constants of steel are used for {material}, which is no steel.",
    "wear.criterion low_cycle_fatigue wears {material}, E = {modulus:si Pa}; the constants are those of unalloyed and "
    "low-alloy steels.",
    "Give the material its own ductility and exponent.",
)
LAYER_INCOMPRESSIBLE = define(
    "layer-incompressible",
    CAUTION,
    "The layer is nearly incompressible; Poisson's ratio decides its stiffness.",
    "Poisson's ratio {ratio:g} makes the bonded layer {stiffer:.0f} times as stiff in compression as its modulus.",
    "Measure Poisson's ratio, or bracket it with two runs.",
)
HARDNESS_UNLIKELY = define(
    "hardness-unlikely",
    CAUTION,
    "The hardness does not fit Young's modulus or yield stress.",
    "",
    "Check hardness and youngs_modulus, and their units.",
    reasons={
        "low": "{hardness:si Pa} is {share:.2g} of Young's modulus, below that of annealed metals (5e-4 to 0.2).",
        "high": "{hardness:si Pa} is {share:.2g} of Young's modulus, above that of a perfect solid (5e-4 to 0.2).",
        "yield": Reason(
            "The yield stress {stress:si Pa} is hardness / {ratio:.2g}; metals have hardness / 2.6 to / 3, brittle"
            " solids down to / 1.5.",
            "Leave yield_stress out (hardness / 2.8 is taken), or check both.",
        ),
    },
)
CAP_NOT_OF_SOFTER = define(
    "cap-not-of-softer",
    CAUTION,
    "The pressure cap is not the hardness of the softer body.",
    "",
    "Give {material} a hardness of its own.",
    reasons={
        "stiffer": Reason(
            "{material} has neither hardness nor yield stress, and is softer than {stiff}.",
            headline="The pressure limit is that of the harder body: {cap:si Pa}.",
        ),
        "tensile": (
            "wear.criterion maximum_tension takes the yield stress of {material}, {stress:si Pa}, as its tensile "
            "strength; without a hardness the cap is 2.8 times that, {cap:si Pa}."
        ),
    },
)

# Operation
GROWTH_WITHOUT_BARRIER = define(
    "growth-without-barrier",
    CAUTION,
    "The tribofilm grows at its largest rate, whatever the temperature.",
    "Shear stress {stress:si Pa} x activation volume is {lowered:.2g} eV, above the barrier of {barrier:.2g} eV.",
    "Check activation_volume and its unit.",
)

# Surfaces
SLOPES_LARGE = define(
    "slopes-large",
    CAUTION,
    "The contact is wide for the radius of its bodies.",
    reasons={
        "roughness": Reason(
            "Its rms slope is {slope:.2g}; half-spaces stand for slopes well below one, and pressures grow with them.",
            "Filter the surface (low_pass, cutoff_wavelength), or read the result as a trend.",
            headline="The roughness is too steep for small-slope (half-space) theory.",
        ),
        "hertz": Reason(
            "The contact radius is {ratio:.2g} of the body's radius: half-spaces and small strains hold below about"
            " 0.2; strains are of order {strain:%}.",
            "Expect errors of several per cent, or use finite elements with large deformations.",
        ),
        "element": Reason(
            "It reaches over {limit:g} of a body's radius at {first}{others}: the gap of conforming bodies is 7 %"
            " or more over the parabola of Hertz and of scenes.",
            "Take the pressures there as estimates.",
        ),
        "worn": Reason(
            "The bodies are worn {depth:si m} deep at a radius of {radius:si m}{of}: the scar's edge has a slope of"
            " {slope:.2g beside limit}, where half-spaces hold below about {limit:g}, and pressure, depth and"
            " width are not those of such bodies.",
            "Take less wear (a shorter wear.criterion.distance, fewer cycles.count), or the volume by load and distance"
            " alone.",
        ),
    },
)
SURFACE_IS_FORM = define(
    "surface-is-form",
    CAUTION,
    "Roughness is too high for this patch: form, or a wrong unit.",
    "Sq {height:si m} is {share:%} of the patch's side.",
    "Check height_unit and rms_height, or remove form.",
)
MAP_COARSE = define(
    "map-coarse",
    CAUTION,
    "The map has too few measured points for this grid.",
    reasons={
        "points": Reason(
            "The whole grid lies on {points} measured points {apart} apart: roughness in the contact is interpolated.",
            "Take a larger grid, or a finer map.",
        ),
        "cells": Reason(
            "Cells are {finer:.2g} times finer than the points ({apart}): contact area and pressures are those of a"
            " smoothed surface.",
            "Take larger cells, or a finer map.",
        ),
        "interpolated": Reason(
            "Cells are {finer:.2g} times finer than the points ({apart}): the roughness between the points is "
            "interpolated.",
            "Finer cells show no finer roughness; measure with a finer spacing for that.",
            INFO,
        ),
    },
)

# The contact as a whole
ABOVE_HARDNESS = define(
    "above-hardness",
    CAUTION,
    "Elastic pressures exceed the softer body's hardness; real surfaces would yield.",
    reasons={
        "hertz": Reason(
            "Hertz' pressure {pressure:si Pa} is {ratio:.2g} times the softer hardness.",
            "To stay below the hardness, {action}.",
            foreseen=True,
        ),
        "layer": Reason(
            "The pressure on the layer, {pressure:si Pa}, is {ratio:.2g} times the softer hardness.",
            "To stay below the hardness, {action}.",
            foreseen=True,
        ),
        "solved": Reason(
            "Pressures reach {pressure:si Pa}, {ratio:.2g} times the softer hardness, and {share:%} of the load is"
            " carried above it.",
            "To stay below the hardness, {action}.",
        ),
    },
)
YIELDS = define(
    "yields",
    CAUTION,
    "The softer body yields below its surface.",
    "",
    "Lower the load, take a harder material, or expect residual stresses.",
    reasons={
        "hertz": (
            "Hertz' pressure {pressure:si Pa} is {ratio:.3g} times that at which it begins to yield, {onset:si Pa}: "
            "elastic stresses there are too high, and the first loadings leave residual stresses."
        ),
        "hertz of one material": Reason(
            "Hertz' pressure {pressure:si Pa} is {ratio:.3g} times that at which it begins to yield, {onset:si Pa}: "
            "elastic stresses there are too high, and the first loadings leave residual stresses.",
            headline="The material yields below its surface.",
        ),
        "element": Reason(
            "It does at {places} of {all} places: Hertz' pressure is {ratio:.3g} times that at which yield begins, "
            "{onset:si Pa}, at {place}; contacts here and in scenes are elastic.",
            headline="The softer body yields below its surface at {place}.",
        ),
        "element of one material": Reason(
            "It does at {places} of {all} places: Hertz' pressure is {ratio:.3g} times that at which yield begins, "
            "{onset:si Pa}, at {place}; contacts here and in scenes are elastic.",
            headline="The material yields below its surface at {place}.",
        ),
        "solved": "Elastic von Mises stresses reach {stress:si Pa} and are too high in {volume:.3g} um^3.",
        "layers": Reason(
            "The highest von Mises stress over the yield stress is {ratios}. The material yields where it is above 1; "
            "elastic stresses there are too high.",
            "Lower load or friction, or take another layer.",
            headline="{first} yields first.",
        ),
    },
)
PERIODIC_GRID = define(
    "periodic-grid",
    CAUTION,
    "The shape does not suit the periodic grid.",
    reasons={
        "body": Reason(
            "The grid is periodic along {axis}, so the {shape} repeats every {length}{near}.",
            "Set grid.periodic = {single} for a single {shape}.",
            headline="The curved body repeats with the periodic grid.",
        ),
        "wave": Reason(
            "{waves:.4g} waves lie on a periodic grid of {length:si m}.",
            "Take a whole number of waves.",
            headline="The wave has a kink at the grid's seam.",
        ),
    },
)
PATCH_SINKS = define(
    "patch-sinks",
    INFO,
    "The load at a given separation changes with patch size.",
    "The half-space sinks in by up to {sunk:si m} under the mean pressure of the patch, {length:si m} long.",
)
CYLINDER_NARROW = define(
    "cylinder-narrow",
    CAUTION,
    "The contact is short for a line contact, which has no ends.",
    "Its length is {ratio:.2g} times its width 2a; a line contact needs five.",
    "Take the film as an upper bound, as oil leaves at both ends of a roller or bush; a longer one "
    "reduces the error, and so does less load of a roller.",
)

# The mesh
_ROUGHNESS_OF_BODY = "The cells do not resolve the roughness of the {body} body; pressures follow the mesh."
ROUGHNESS_UNRESOLVED = define(
    "roughness-unresolved",
    CAUTION,
    "The cells do not resolve the roughness; pressures follow the mesh.",
    reasons={
        "cutoff": Reason(
            "Without cutoff_wavelength the waves go down to two cells, {wave:si m}.",
            "Set cutoff_wavelength to 8 cells, {cutoff:si m}, or more; 4 cells suffice for averages.",
        ),
        "cutoff-finer": Reason(
            "Without cutoff_wavelength the waves go down to two cells, {wave:si m}; 8 cells leave little of the waves"
            " below the roll-off, {rolloff:si m}.",
            "Take a spacing of {spacing:si m} or less and set cutoff_wavelength to {cutoff:si m}: 8 cells to the"
            " shortest wave; 4 suffice for averages.",
        ),
        "wave": Reason(
            "There are {cells:.2g} cells to its shortest wave ({wave:si m}): contact spots come down to single cells.",
            "Take a spacing of {spacing:si m}, or {average:si m} for averages.",
            headline=_ROUGHNESS_OF_BODY,
        ),
        "correlation": Reason(
            "Its correlation length, {length:si m}, is {cells:.2g} cells.",
            "Take a spacing of {spacing:si m} or less.",
            headline=_ROUGHNESS_OF_BODY,
        ),
        "film": Reason(
            "Heights in the film change from cell to cell by {change:.1f} of their rms, as waves of {cells:.2g} cells"
            " do.",
            "Take {fewest:g} cells of the film to a wave, or filter the surface.",
        ),
        "film-wave": Reason(
            "The film has about {cells:.2g} cells to the surface's shortest wave; load shares in contact change by"
            " tens of per cent below {fewest:g}.",
            "Set more film.cells.",
        ),
    },
)
PATCH_SHORT = define(
    "patch-short",
    CAUTION,
    "The patch is short; a few summits decide its figures.",
    "",
    "Take a larger patch or several repetitions (of measured surfaces other maps), or remove form with detrend or "
    "high_pass.",
    reasons={
        "unknown": "The autocorrelation of the {body} surface does not fall to 1/e within half of the patch.",
        "few": "The patch is {lengths:.2g} correlation lengths of the {body} surface long{along}.",
    },
)
LAYER_MESH = define(
    "layer-mesh",
    CAUTION,
    "The layer's thickness does not suit the grid.",
    reasons={
        "thin": Reason(
            "It is {thickness:si m} thick on cells of {cell:si m}: the layer's softness is right, its bending stresses"
            " are not.",
            "Take cells no larger than the layer's thickness where its stresses matter.",
            headline="The outermost layer, {layer}, is thinner than half a cell.",
        ),
        "thick": Reason(
            "It is {thickness:si m} thick over a grid of {length:si m}, and the substrate is hardly felt.",
            "Make the layer the body's material, which is faster.",
            headline="The layer is thick compared with the grid.",
        ),
    },
)
DEPTHS_MISS_STRESS = define(
    "depths-miss-stress",
    CAUTION,
    "outputs.depths may miss the largest stress.",
    reasons={
        "hertz": Reason(
            "The largest von Mises stress lies {at:si m} below the surface; the nearest depth is {nearest:si m}.",
            "Take depths every {step:si m} around {at:si m}.",
        ),
        "layers": Reason(
            "{found} of the {body} body.",
            "Set {fewest} or more in every layer, and one just above and just below every interface.",
        ),
        "deepest": Reason(
            "The largest von Mises stress lies in the deepest depth, {depth:si m}, and may grow further down.",
            "Take deeper outputs.depths.",
        ),
    },
)
TRIBOFILM_ON_COATING = define(
    "tribofilm-on-coating",
    CAUTION,
    "The tribofilm grows on a coating.",
    reasons={
        "growth": Reason(
            "On {material} a film may grow slower, stay thinner or not form at all.",
            "Calibrate them on films that grew on it (`bem calibrate`), or take the result as a limit.",
            headline="Growth constants come from steel; the film grows on a coating.",
        ),
        "hardness": Reason(
            "film.hardness is {film:si Pa} at zero thickness; the coating, {material}, has {hardness:si Pa}.",
            "Set {key} so that it is {hardness:si Pa} at zero thickness.",
            headline="The hardness of a thin film is not that of the coating.",
        ),
        "heat": Reason(
            "Flash temperatures are those of the bodies without coatings of {thickness:si m}.",
            "Expect up to heat flux x thickness / conductivity more on coatings that conduct heat badly, such as DLC;"
            " kind surface-temperature computes it.",
            headline="Heat flows as if the coating were not there.",
        ),
        "worn": Reason(
            "{worn:si m} have worn; the outermost coating, {material}, is {thickness:si m} thick.",
            "Rub for a shorter time, or begin again on what lies below.",
            headline="The film has taken the whole coating with it.",
        ),
    },
)
RESIDUAL_STRESS = define(
    "residual-stress",
    INFO,
    "Stresses below the surface include residual stresses of layers.",
    reasons={
        "stresses": "The {body} body has {found}, which von Mises stress, tension and yielded volume include, and "
        "the stresses that wear criteria compare. The contact pressure does not depend on it: it causes no traction "
        "across the surface or an interface.",
        "pressure": Reason(
            "The {body} body has {found}: it causes no traction across the surface or an interface.",
            headline="The residual stress of a layer changes no result of this kind.",
        ),
    },
)
LAYER_THICKNESS_UNUSUAL = define(
    "layer-thickness-unusual",
    CAUTION,
    "The thickness of a layer is not a usual one of this coating.",
    "layers[{number}] ({material}) is {thickness:si m} thick; usual are {low:si m} to {high:si m}.",
    "Check thickness and its unit.",
)
RESIDUAL_STRESS_UNUSUAL = define(
    "residual-stress-unusual",
    CAUTION,
    "The residual stress is not a usual one of this coating.",
    "layers[{number}] ({material}) has {stress:si Pa}; usual are {low:si Pa} to {high:si Pa}, negative in compression.",
    "Check the {check} of residual_stress, and the source of the value.",
)
PARTICLES_OF_MESH = define(
    "particles-of-mesh",
    CAUTION,
    "Sizes and numbers of particles follow the mesh.",
    reasons={
        "criterion": Reason(
            "The length of wear.{key} {law}, {length:si m}, is {cells:.2g} cells{along}; {fewest:.2g} are needed.",
            "Take cells of {cell:si m} or less{along}{longer}.",
        ),
        "depths": Reason(
            "Depths are {ratio:.2g} cells apart.", "Take depths.spacing = the cell, {cell:si m}, or less."
        ),
        "layer": Reason(
            "depths.spacing {step:si m} is more than the {body} layer's thickness, {thickness:si m}.",
            "Take a third of the thickness.",
        ),
        "mean": Reason(
            "The mean by number is smaller than two cells of {cell:si m} in {few} of {all} runs"
            " ({least}radius {radius:si m}): most are one cell.",
            "Take a finer grid, or the mean by volume.",
        ),
        "one-cell": Reason(
            "{share:%} of the particles, with {volume:%} of their volume, are one cell wide ({cell}).",
            "Take a finer grid, or means by volume where their share is small.",
        ),
    },
)
WEAR_SHIFT = define(
    "wear-shift",
    CAUTION,
    "The distance that the surfaces slide in a cycle is unsuitable.",
    reasons={
        "zero": Reason(
            "With wear.shift = 0 the surfaces do not slide on.",
            "Set wear.shift to 1 or more.",
            headline="The surfaces do not slide; every cycle meets the same asperities.",
        ),
        "differs": Reason(
            "They slide {shortest} to {longest} in a cycle.",
            "Keep wear.shift times the cell size the same.",
            headline="Variants slide different distances per cycle; they cannot be compared.",
        ),
    },
)

# Results of a contact
PRESSURE_AT_SEAM = define(
    "pressure-at-seam",
    CAUTION,
    "The highest pressure lies on a seam of a mirrored surface.",
    reasons={
        "highest": "The ridge there is the mirror's (along {axes}), and so are the stress and the particles below it.",
        "load": Reason(
            "{load:%} of the load lies within {width:si m} of one seam (along {axes}), on {area:%} of the area: the "
            "ridge there is the mirror's, and so are the contact, the stress and the particles below it.",
            headline="A seam of a mirrored surface carries more than its part of the load.",
        ),
    },
    action="{action}",
)
STRAIN_LARGE = define(
    "strain-large",
    CAUTION,
    "Pressures are too high for linear elasticity.",
    reasons={
        "pressure": Reason(
            "They reach {pressure:si Pa}, {ratio:.2g} times the contact modulus, and {share:%} of the load is "
            "carried above 0.2 of it: strains are of that order, and linear elasticity ends at about 0.1.",
            "Check units, smooth the surface, or cap the pressure at a hardness.",
        ),
        "adhesive": Reason(
            "Pressure less attraction reaches {pressure:si Pa}, {ratio:.2g} times the contact modulus, and {share:%} "
            "of it lies above 0.2 of it: strains are of that order, and linear elasticity ends at about 0.1.",
            "Check units, smooth the surface, or take a longer range of adhesion at the same work.",
            headline="Pressures less attraction are too high for linear elasticity.",
        ),
    },
)
HARDNESS_DECIDES = define(
    "hardness-decides",
    INFO,
    "Pressures are limited by the hardness that was given.",
    reasons={
        "reached": (
            "{cells:%} of the cells in contact, which carry {load:%} of the load, are at the hardness, {cap:si Pa}; "
            "work hardening is left out."
        ),
        "area-is-load": (
            "{cells:%} of the cells in contact, which carry {load:%} of the load, are at the hardness, {cap:si Pa}, "
            "without work hardening. The contact area is then mostly load over hardness and tells little of the "
            "surfaces."
        ),
        "reached-of-area": (
            "{area:%} of the contact area, which carries {load:%} of the load, is at the hardness, {cap:si Pa}; "
            "work hardening is left out. Counted in cells, which are touched in part at edges, these are {cells:%} "
            "with {cells_load:%} of the load."
        ),
        "area-is-load-of-area": (
            "{area:%} of the contact area, which carries {load:%} of the load, is at the hardness, {cap:si Pa}, "
            "without work hardening. The contact area is then mostly load over hardness and tells little of the "
            "surfaces. Counted in cells, which are touched in part at edges, these are {cells:%} with {cells_load:%} "
            "of the load."
        ),
        "within-error": (
            "Nothing is at the hardness here, {cap:si Pa}, but it lies within the error of the highest pressure: on "
            "finer cells a part of the contact may be."
        ),
        "load": Reason(
            "No cell carries more than the hardness (contact.hardness, or that of the softer body), so that at least "
            "this share of the grid touches; valleys of rough surfaces would carry more.",
            "Take a smaller load or a larger grid.",
            CAUTION,
            foreseen=True,
            headline="The mean pressure over the grid is {ratio:.2g} of the hardness.",
        ),
        "area": Reason(
            "{share:%} of the patch is in contact; above about half rough valleys resist, which a cap leaves out.",
            "Take a smaller load or a larger grid.",
            CAUTION,
            headline="Most of the patch has yielded; valleys of a rough surface would resist more.",
        ),
    },
)

# Results of wear loops
SURFACE_ROUGHENED = define(
    "surface-roughened",
    OUTSIDE_MODEL,
    "The worn surface grew rough instead of running in.",
    "Sq went from {before:si m} to {after:si m}{of}: pieces{holes} deeper than the roughness, Sq {both:si m} of both "
    "surfaces, leave holes, and friction, film and particles at the end are of these holes{so}.",
    "Compare a finer grid, take fewer cycles, or a criterion that wears by pressure (archard).",
)
NO_WEAR_RATE = define(
    "no-wear-rate",
    CAUTION,
    "The computed wear rate is far above that of any metal.",
    "criterion_wear_rate is up to {rate:.2g} mm3/(N m){of}; metals have 1e-9 to {severe:g}.",
    "Take volumes from a measured rate ([archard], or the criterion archard).",
)
TYPICAL_LENGTHS = define(
    "typical-lengths",
    INFO,
    "The correlation length of the roughness is a typical one, not measured.",
    "{bodies}: {lengths} of process {process}; a longer one leaves the asperities less of the load.",
    "Take measured surfaces (path), or correlation_length of your own.",
)
NO_PARTICLE_SIZES = define(
    "no-particle-sizes",
    INFO,
    "A wear law by pressure gives no wear particles.",
    "wear.criterion = {law} gives depth and volume only.",
    "For sizes and numbers of particles set {shape}{criterion}.",
)
NOT_SETTLED = define(
    "not-settled",
    CAUTION,
    "The wear cycles have not settled.",
    "Means of the last cycles ({window}) differ from those of as many before them: {drifting}; "
    "the figures of the end are those of this number of cycles.",
    "Raise cycles.count, or read the curves over cycles.",
)
SETTLING_UNJUDGED = define(
    "settling-unjudged",
    CAUTION,
    "The cycles are too few to judge whether they have settled.",
    "The roughness of the moving body meets the same roughness again every {turn} cycles, one repeat of its patch, and"
    " the run has {cycles}: within a repeat figures change with its place as they do with wear.",
    "Set cycles.count = {count} (two repeats of the roughness patch) or more{averaged}.",
)
FRICTION_SWINGS = define(
    "friction-swings",
    CAUTION,
    "Friction swings with the place of the moving roughness.",
    "Mean friction is {first:.4g} over the first repeat of the roughness patch, {turn} cycles, and {last:.4g} over the"
    " last; after a repeat the roughness of the moving body is where it was;"
    " friction_initial = {initial:.4g} is that of the first cycle, friction_run_in = {run_in:.4g} the mean of"
    " the last {averaged}{of}.",
    "Compare the means of the first and the last repeat, or set cycles.averaged = {turn}.",
)
LESS_THAN_A_PARTICLE = define(
    "less-than-a-particle",
    CAUTION,
    "The run wears less than one particle.",
    "All cycles together shed {most}{number:.2g} particles of one body{of}: an expected number, worn volume over mean"
    " volume of a particle, and no count. Sizes are those of regions that would come off.",
    "Read numbers of particles as means over many such patches. A count of {wanted} would take about {cycles} cycles,"
    " about {time}, at the rate of {window} cycles, {rate:.2g} a cycle.",
)
WEAR_OUTSIDE_REGION = define(
    "wear-outside-region",
    INFO,
    "Wear reaches beyond the contact region of Sq and worn depth.",
    "{most}{share:%} of the worn volume lies outside it{of}. The region is {region}; rough summits touch beside it.",
    "Read the worn volume and the map of the worn surface for all of it.",
)
CHANGE_WITHIN_ERROR = define(
    "change-within-error",
    INFO,
    "The run does not resolve a change by running-in.",
    "The change of {figure}, from {before:.4g} to {after:.4g}, is less than its error of {error:.2g}{of}.",
    "Take smaller cells, more cycles or more wear to see it.",
)
PARTICLES_OF_BODY = define(
    "particles-of-body",
    INFO,
    "Particles, roughness and volumes refer to different bodies.",
    reasons={
        "unworn": Reason(
            "sizes.particles_of names the {asked} body, and only the {worn} one wears: sizes and numbers of particles,"
            " 0, are no result.",
            "Set sizes.particles_of to the body that wears.",
            CAUTION,
        ),
        "both": "Heights, Sq and worn depth are those of the {first} one, volumes of both{particles}.",
    },
)
WEAR_STEPS_LONG = define(
    "wear-steps-long",
    CAUTION,
    "Each cycle wears too much at once.",
    reasons={
        "overshoot": Reason(
            "One removes {ratio:.2g} times the depth per pressure by which the bodies give way from cell to"
            " cell, where less than 2 is needed; depths, roughness and contact are those of the steps.",
            "Take {share:.2g} times the wear.criterion.distance, and raise cycles.count.",
            OUTSIDE_MODEL,
        ),
        "error": Reason(
            "The deepest place, worn {depth:si m} deep{of}, is uncertain by about {part:%}, beside error bars.",
            "Take a shorter wear.criterion.distance, and raise cycles.count as much.",
        ),
    },
)
NOTHING_CAME_OFF = define(
    "nothing-came-off",
    CAUTION,
    "The wear criterion {law} removed no particle{beside}.",
    reasons={
        "particles": Reason(
            "{takes} Depths, worn volume and roughness are those of wear.criterion, {wears}, and hold.",
            "Raise load, friction or cycles.count, or check yield_stress and the constants of wear.particle_criterion.",
            headline="wear.particle_criterion {law} found no particle{beside}; the worn volume holds.",
        ),
        "weak": Reason(
            "{takes}",
            "Raise load, friction or cycles.count, check yield_stress and the constants of wear.criterion, or wear by "
            "a measured rate with kind running-in-life.",
        ),
        "repeats": Reason(
            "{takes} Without wear every turn of the roughness repeats the one before: more cycles change nothing.",
            "Raise load or friction, check yield_stress and the constants of wear.criterion, or wear by a measured "
            "rate with kind running-in-life.",
        ),
        "rolls": Reason(
            "{takes} The surfaces roll without sliding (slide-to-roll ratio {ratio:.2g}), so that nothing rubs: more "
            "cycles change nothing.",
            "Set speeds.slide_roll_ratio, such as 0.02, or wear by a measured rate with kind running-in-life.",
        ),
    },
)
PARTICLES_CUT = define(
    "particles-cut",
    CAUTION,
    "The largest particles end where grid or depths end.",
    reasons={
        "depths": Reason(
            "{share:%} of the settled particles go on below the deepest depth{unless}; their volume is too small.",
            "Raise depths.count, or depths.spacing.",
        ),
        "grid": Reason(
            "The largest is {largest:si m} long on a grid of {side:si m}.",
            "Take a larger grid, or read the particle as wear of the whole surface.",
        ),
    },
)
