"""Run time, memory and work against error, and the tables of results that are made again by a command.

`cases` lists what is measured, a curve each; `measure` times one point, `run` all of them, `history` keeps runs and
compares two, `show` prints and draws, `floor` and `peers` measure what the machine and other codes do. `line_film`
makes the committed table of line-contact films.

Sees every solver, closed forms to judge them by, and no command line. Verified in tests/benchmarks: cases run at their
smallest size, errors fall with the mesh, counters leave no trace; reports show the last stored run.
"""
