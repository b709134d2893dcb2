"""Notes on the temperatures of rubbing surfaces."""

from bem.notes.note import Level, Reason, define

SURFACE_HOT = define(
    "surface-hot",
    Level.CAUTION,
    "The surface is too hot for the given material constants.",
    reasons={
        "rise": Reason(
            "The temperature rises by {rise:.0f} K: steel transforms at 727 degC, and neither light metals nor polymers"
            " stand it.",
            "Lower load, speed or friction, or check the conductivities.",
        ),
        "bulk": Reason(
            "The bulk temperature of {bulk:.0f} degC is above {limit:.0f} degC: oils and hardened bearing steels do not"
            " stand it, and the catalogue's thermal constants are those near room temperature.",
            "Lower the bulk temperature, or give thermal constants at that temperature.",
        ),
        "transforms": Reason(
            "It reaches {temperature:.0f} degC: steel transforms at 727 degC, aluminium melts at 660 degC and polymers"
            " below, so hardness, friction and heat will differ from those given.",
            "Lower load, speed or friction.",
        ),
        "softens": Reason(
            "It reaches {temperature:.0f} degC: hardened bearing steel is tempered at 150 to 200 degC and softens"
            " above; most polymers melt below 330 degC.",
            "Check the hardness of the bodies at that temperature.",
        ),
    },
)
