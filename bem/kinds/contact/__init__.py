"""Kind of scene `contact`.

Two rough, possibly coated bodies pressed together: pressure, contact area, approach, stresses below.
"""
