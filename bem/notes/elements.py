"""Notes on machine elements."""

from bem.notes.note import Level, define

CAUTION, INFO = Level.CAUTION, Level.INFO

CONFORMING = define(
    "element-conforming",
    CAUTION,
    "Contacts are wide for the radius of their bodies.",
    "At {places} places ({first}, ...) the contact reaches over {limit:g} of a body's radius: the gap of "
    "conforming bodies is up to 7 % and more over the parabola of Hertz and of scenes.",
    "Take the pressures there as estimates.",
)
YIELDS = define(
    "element-yields",
    CAUTION,
    "The softer body yields below its surface.",
    "It does at {places} of {all} places: Hertz' pressure is {ratio:.3g} times that at which yield begins, "
    "{onset:si Pa}, at {place}; contacts here and in scenes are elastic.",
    "Lower the load, or take a harder material.",
)
NO_HEAT = define(
    "element-without-heat",
    INFO,
    "Films have no heat, here or in scenes.",
    "{bodies} without thermal_conductivity, heat_capacity and density.",
)
FILM_THIN = define(
    "element-film-thin",
    CAUTION,
    "The film is thinner than the roughness (rms).",
    "It is at {places} of {all} places: surfaces touch there, which films here and in kind traction leave out.",
    "Take --kind friction, which shares the load between film and surfaces.",
)
BEARING_LOADS = define(
    "bearing-loads",
    INFO,
    "{carrying} of {all} elements carry.",
    "The most loaded one carries {highest:.4g} N, {ratio:.3g} times radial load over number of elements.",
)
CENTRIFUGAL = define(
    "bearing-centrifugal",
    INFO,
    "Centrifugal force presses each element outwards.",
    "Its {force:.3g} N is in the loads of the outer ring, not in how the radial load is shared.",
)
BALLS_ROLL = define(
    "bearing-balls-roll",
    INFO,
    "Spin and differential slip of balls are left out.",
    "Both surfaces roll at one speed; the line film of a scene takes the middle of the ellipse and no oil "
    "that leaves sideways.",
)
ROLLERS_EVEN = define(
    "bearing-rollers-even",
    INFO,
    "Edges of rollers, crowning and skew are left out.",
    "The load is even along the length.",
)
GEAR_PATH = define(
    "gear-path",
    INFO,
    "On the path {marks} from C{helical}.",
    "Contact ratio {ratio:.4g}, working pressure angle {angle:.4g} deg, centre distance {centre:.6g} mm.",
)
GEAR_HELIX = define(
    "gear-helix",
    INFO,
    "Helix {helix:.4g} deg on the base circles, overlap ratio {overlap:.4g}.",
    "The load lies evenly on lines of contact {shortest:.4g} to {longest:.4g} faces long together; a "
    "place's load is the mean over the face, and {above:.2g} more where they are shortest. Stiffer tooth "
    "ends are left out.",
)
GEAR_EDGES = define(
    "gear-edges",
    INFO,
    "At A and E a tip's edge touches.",
    "Its pressure is higher than that of the flanks' curvature; tip relief, bending of teeth and dynamic "
    "load are left out.",
)
GEAR_STEADY = define(
    "gear-steady",
    INFO,
    "A scene takes each place as steady.",
    "Teeth pass the path in {time:.3g} ms.",
)
RING_LIFTED = define(
    "ring-lifted",
    CAUTION,
    "Gas lifts the ring.",
    "At {lost} of {all} angles the pressure below exceeds that above by more than tension holds; those are left out.",
    "Raise the tension.",
)
RING_AT_EDGE = define(
    "ring-at-edge",
    CAUTION,
    "Hertz' contact reaches an edge of the face.",
    "It does at {places} of {all} angles, such as {first}: neither it nor a film of it is that of a parabola there.",
    "Take a higher or more crowned face.",
)
RING_SQUEEZE = define(
    "ring-squeeze",
    INFO,
    "At dead centres the film lives from squeeze.",
    "At {places} of {all} angles, such as {first}, the speed changes faster than the film sinks under its "
    "load: it is thicker than the steady one while the speed falls and thinner while it rises; scenes of "
    "kind film march in time.",
)
RING_EXIT = define(
    "ring-film-exit",
    CAUTION,
    "The film would end behind the trailing edge of the face.",
    "At {places} of {all} angles, such as {first}, a rigid film does: with that edge it carries less and is"
    " thinner than given.",
    "Take a more crowned or higher face.",
)
RING_FULL = define(
    "ring-face-full",
    INFO,
    "The face is full of oil to its leading edge.",
    "Less oil on the liner, gas pressure at the film's ends, the ring's gap, tilt and a bore that is not "
    "round are left out.",
)
FOLLOWER_LEAVES = define(
    "follower-leaves",
    CAUTION,
    "The follower leaves the cam.",
    "At {lost} of {all} angles spring and preload do not hold it at this speed; those are left out.",
    "Take a stiffer spring or a lower speed.",
)
ENTRAINMENT_TURNS = define(
    "entrainment-turns",
    INFO,
    "Entrainment turns round at {angles}.",
    "Nothing is entrained there and the film lives on by squeeze, which steady scenes do not have; kind "
    "film follows a film in time.",
)
FOLLOWER_PASSED_OFTEN = define(
    "follower-passed-often",
    INFO,
    "Places of the follower are passed more than once in a turn.",
    "The contact wanders to and fro, slowly where it turns round: depths per pass have no limit there, and "
    "wear by hour is not known.",
)
FOLLOWER_STILL = define(
    "follower-still",
    INFO,
    "The follower does not turn.",
    "Both bodies are as long as the cam is wide, without edges.",
)
