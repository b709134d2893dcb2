"""Kind of scene `running-in`.

Running-in in mixed lubrication: wear cycles with the load shared between film and contact.
"""
