"""Kinds of scene: a folder here is a kind, `running-in` in `running_in`, and nothing else has to know of it.

A kind is one case. `kind.py` puts its parts together: `scene` (keys and axes), `record` (results), `plan` (what a case
costs), `run` (solver calls), `errors` (error bars), `checks` (contacts that checks examine), `figures` (pictures,
loaded when something is drawn). `basic.toml` is what `bem new` starts from, `examples` has the built-in scenes,
`guide.md` is the page of the documentation. A kind knows the solvers, `bem.scenes` and its context, and no other kind.
Loops over loads, variants, repetitions and whatever `[over]` names, workers, resuming, statistics, dataset and summary
are the business of `bem.campaigns`, which reads them from `axes` and from the record (`bem.scenes.records`).

How to write one, in the package or in a file of your own that ends in `bem.register(KIND)`, is in the documentation
(reports/docs/develop/extending.md), part by part, with a small one as a whole. Tables of several kinds stand in
`bem.scenes.tables`, `bem.scenes.common`, `wearing` and `lubrication`; grids, bodies and heights in `bem.scenes.build`;
steps of plans in `bem.scenes.plans`; the class `Kind` in `bem.scenes.kind`.

Verified in tests/scenes (each kind), tests/gallery (every built-in scene), tests/campaigns (cases, resuming).
"""
