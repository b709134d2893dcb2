"""Response of a stack of bonded layers on a half-space."""
