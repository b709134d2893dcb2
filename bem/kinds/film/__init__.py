"""Kind of scene `film`.

Film of a smooth line contact in time: start and stop, reciprocating, changing load.
"""
