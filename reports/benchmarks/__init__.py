"""Benchmarks for developers: history of runs, goals, and other codes beside bem.

`bem.benchmarks` has the cases of `bem bench` and measures them. Here `history` keeps runs and compares two, `goals` has
the wanted run times, `peers` runs other codes (single contacts; `peer_curves`, `peer_stresses` and `peer_figures` have
the rest), `run` puts both into one record, and `tables` prints it. `line_film` computes the committed table of
line-contact films. The command line is `python -m reports.benchmarks`.
"""
