"""Kind of scene `friction`.

Load sharing between oil film and rough contact over speed: the Stribeck curve.
"""
