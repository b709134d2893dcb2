"""Tables of scenes by subject: what a scene of one kind or another may say, with its bounds and rules between keys.

What every kind shares is in `bem.scenes.common`, of wear in `bem.scenes.wearing`, of oil films in
`bem.scenes.lubrication`. Tables hold numbers in SI units and do no work; a kind states which of them make its scene.

Knows units and what laws and solvers are called; no result. Verified in tests/scenes, each kind with its tables.
"""
