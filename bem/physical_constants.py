"""Physical constants, and typical values that several parts of `bem` take where nothing else is known."""

ZERO_CELSIUS = 273.15
"""Absolute temperature of 0 degrees Celsius [K], exact by definition."""
ROOM_TEMPERATURE = 293.15
"""Temperature of bodies and surroundings where none is given [K]: 20 degrees Celsius."""
ATOM = 2e-10
"""Distance of neighbouring atoms in a metal [m]."""
BOLTZMANN = 1.380649e-23
"""Boltzmann's constant [J/K], exact by definition of the SI."""
ELECTRON_VOLT = 1.602176634e-19
"""One electron volt [J], exact by definition of the SI."""
