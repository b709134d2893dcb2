"""Kind of scene `particles`.

Sizes of the wear particles in an AFM height map.
"""
