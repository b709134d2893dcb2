"""Kind of scene `rolling`.

Pressed bodies that roll over each other with creepage and spin: stick and slip, traction, energy of friction.
"""
