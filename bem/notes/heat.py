"""Notes on the temperatures of rubbing surfaces."""

from bem.notes.note import Level, Reason, define

SURFACE_HOT = define(
    "surface-hot",
    Level.CAUTION,
    "The surface is too hot for the given material constants.",
    reasons={
        "rise": Reason(
            "The temperature rises by {rise:.0f} K: steel transforms at 727 °C, and neither light metals nor polymers"
            " stand it.",
            "Lower load, speed or friction, or check the conductivities.",
            headline="The surface becomes {rise:.0f} K hotter than its body: no material stands that.",
        ),
        "bulk": Reason(
            "The bulk temperature of {bulk:.0f beside limit} °C is above {limit:.0f} °C: oils and hardened bearing"
            " steels do not stand it, and the catalogue's thermal constants are those near room temperature.",
            "Lower the bulk temperature, or give thermal constants at that temperature.",
            headline="The bulk temperature, {bulk:.0f beside limit} °C, is above {limit:.0f} °C.",
        ),
        "transforms": Reason(
            "Aluminium melts at 660 °C and polymers below, so hardness, friction and heat will differ from those"
            " given.",
            "Lower load, speed or friction.",
            headline="The surface reaches {temperature:.0f} °C: steel transforms at 727 °C.",
        ),
        "softens": Reason(
            "Hardened steels of gears, bearings and rings are tempered at 150 to 200 °C"
            " and soften above that temperature; most polymers melt below 330 °C.",
            "Check the hardness of the bodies at that temperature.",
            headline="The surface reaches {temperature:.0f} °C: hardened steel may soften above 150 °C.",
        ),
    },
)
