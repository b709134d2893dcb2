"""Kind of scene `traction`.

Traction of a smooth rolling and sliding line contact, with the heat in its film.
"""
