"""Kind of scene `point-film`.

Film of a ball or barrel on a flat: elastohydrodynamic point contact in steady motion.
"""
