"""Films of line contacts: steady, starved, between rough or worn walls, and in time."""
