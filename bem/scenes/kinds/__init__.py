"""Kinds of scene: one file here is one kind, `running-in` in `running_in.py`, and nothing else has to know of it.

A kind is one case: tables (a pydantic model), what it will cost (`plan`), the solver call (`run`), a typed record of
what comes out. Knows the solvers, `bem.scenes` and its context; no file format, no figure, no other kind. Loops
over loads, variants, repetitions and whatever `[over]` names, workers, resuming, statistics, dataset, summary are the
business of `bem.campaigns`, which reads them from `axes` and from the record (`bem.scenes.records`).

How to write one, in the package or in a file of your own that ends in `bem.register(KIND)`, is in the guide
(reports/prose/kinds.toml), part by part; tests/extension/test_kinds_and_readers_from_outside.py holds a whole one,
small. Tables stand by subject in `bem.scenes.tables`, those of many kinds in `bem.scenes.common`, `wearing`,
`lubrication`; grids, bodies and heights in `bem.scenes.build`; steps of plans in `bem.scenes.plans`; what a kind is in
`bem.scenes.kind`, whose names stand here too.

Verified in tests/scenes (each kind), tests/gallery (every built-in scene), tests/campaigns (cases, resuming).
"""

from bem.scenes.kind import Kind, get_kind, kind_names

__all__ = ["Kind", "get_kind", "kind_names"]
