"""Figures, tables and reports from results: nothing here solves anything, or writes into a run but its pages.

A figure is a file in `figures`; `draw` makes those of a run, `report` its page, `pages` both once a run is computed,
`sweep` and `compare` those of many runs; `style` is the look, `pictures` the files. Sees datasets, summaries and scenes
as they are on disk. Verified in tests/plots: figures are drawn from data alone, with units, and show what the dataset
holds.
"""
