"""Machine elements as front ends that make scenes: from a catalogue's geometry and load to contacts between bodies.

`rolling_bearing`, `gear_pair`, `cam_follower`, `piston_ring` and `plain_bush` each turn a table with units into
`contact`s: load, radii, speeds of every place; `element` knows them by name, reads their files and makes scenes and
tables of contacts, `cases` many of one from a table, `running` has kind traction solve the films of all places.
`answer` sums up on one screen: `rating_life` and `reference_life` are of bearings, `scuffing` of gears, `bush_answer`
of bushes, `element_wear` of the others. Where half-space and line film do not hold (conforming bodies, ends of a path,
speeds that turn round) is said in notes; journal bearings with their oil wedge are not here.

Sees scenes and closed forms. Verified in tests/elements: tabulated load integrals, involutes and cams made point by
point, a slider crank, Reynolds' equation, closed forms of a pin in a hole.
"""
