"""Kind of scene `wear`.

Wear particles and running-in of a cylinder on a flat in boundary lubrication.
"""
