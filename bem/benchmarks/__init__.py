"""Run time, memory and work against error: the cases of `bem bench`, their measurement and their tables.

`cases` lists what is measured, a curve each; `measure` times one point, `run` all of them; `work_precision` measures
physical figures of kinds. `floor` measures what the machine can do at best, `record` is the record of a run, `show`
prints and draws it. Histories, goals and other codes are in `reports.benchmarks`, outside of the package.

Sees every solver, closed forms to judge them by, and no command line. Verified in tests/benchmarks: cases run at their
smallest size, errors fall with the mesh, counters leave no trace.
"""
