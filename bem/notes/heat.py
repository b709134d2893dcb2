"""Notes on the temperatures of rubbing surfaces."""

from bem.notes.note import Level, define

CAUTION = Level.CAUTION

RISE_TRANSFORMS = define(
    "temperature-rise-transforms",
    CAUTION,
    "The temperature rises by {rise:.0f} K, which few materials stand.",
    "Steel transforms at 727 degC, and neither light metals nor polymers stand it: heat, speed or conductivity will "
    "differ from those given.",
    "Lower load, speed or friction, or check the conductivities.",
)
BULK_HOT = define(
    "bulk-temperature-hot",
    CAUTION,
    "The bulk temperature of {bulk:.0f} degC is above {limit:.0f} degC.",
    "Oils and hardened bearing steels do not stand it, and the catalogue's thermal constants are those near room "
    "temperature.",
    "Lower the bulk temperature, or give thermal constants at that temperature.",
)
SURFACE_TRANSFORMS = define(
    "surface-transforms",
    CAUTION,
    "The surface reaches {temperature:.0f} degC, above the transformation of steel.",
    "Steel transforms at 727 degC, aluminium melts at 660 degC and polymers below: hardness, friction and so the heat "
    "will differ from those given.",
    "Lower load, speed or friction.",
)
SURFACE_SOFTENS = define(
    "surface-softens",
    CAUTION,
    "The surface reaches {temperature:.0f} degC, where hardened bearing steel softens.",
    "Usual bearing steel is tempered at 150 to 200 degC and softens above; most polymers melt below 330 degC.",
    "Check the hardness of the bodies at that temperature.",
)
