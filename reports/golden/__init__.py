"""Golden net: stored figures of surfaces, contacts, films, mixed points, wear loops and every built-in scene.

    python -m reports.golden [--only GROUP] [--spread]

A case is run through the public functions and scenes alone, from a seed. `tests/golden/*.json` holds its figures,
rounded to the digits that its tolerance leaves, and its counts of work; `tests/golden/test_golden.py` compares. The
command runs the cases, prints what moved by more than its tolerance, and stores that. Other figures keep their stored
values: a change of the files shows a change of the code, and small changes cannot add up unseen. A commit that renews
a file says why its figures moved.

`surfaces`, `contacts`, `films`, `points`, `loops` and `scenes` are the groups of cases; `tolerances` says how far each
figure may move and why; `stored` reads, compares and writes; `memory` measures peaks of memory.
"""
