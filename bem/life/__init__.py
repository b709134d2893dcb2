"""A life of up to millions of cycles: wear by pressure and distance, a tribofilm and fatigue together, in jumps.

`passes` is a contact of two bodies that pass or stay, dry or lubricated; `surfaces` what a round of them wears and
grows; `march` the jumps with their error. `fatigue` is the damage that passing roughness does below the surface, by the
criteria of `criteria`.

Sees wear, tribofilms, load sharing, contacts and stresses; no scene, no file. Verified in tests/life: volume, closed
forms of wear, cycle by cycle, order in the tolerance, resuming, criteria on closed stress paths.
"""
