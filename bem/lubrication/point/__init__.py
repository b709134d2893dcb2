"""The film of circular and elliptical contacts.

`solve` is the front door: it checks, makes the similarity problem (`setting`, `scales`, with the pressure far away from
`far`), goes from the dry contact through coarse grids to the one asked for (`cascade`), and has the pressure judged by
itself (`kept`). `newton` solves on one grid; the equations of its steps by GMRES with multigrid cycles (`linear`) on
the grids of `levels`. What runs over cells is compiled (`loops`, `lines`). `film` is the result, `validity` says where
it is outside the model's. `rough_film` is the front door of films between rough surfaces that touch where the film
would vanish (`touching_newton`, `touching`).

Knows grids, the displacement operator, dry contact and the laws of oils; no scene. Verified in tests/lubrication/point.
"""
