"""What the test suite catches: chosen one-line slips in the physics, each run against the tests that guard its room.

`python -m tests.mutants` changes one line of a scratch copy of the tree, runs the guarding tests there until the first
failure, and records the mutant as killed (by which test), survived, or gone (its text is no longer in the file).

Why a list of chosen slips and a tool of our own, and not mutmut or cosmic-ray:

- mutmut 3 mutates each function through a trampoline that is chosen when it is called. A loop compiled by numba cannot
  call a trampoline, and decorated functions are left out: all compiled loops, most of the physics, would be.
- cosmic-ray runs the whole test command once for each of some ten thousand changes, in place. Here the whole command
  takes tens of minutes of processor time, and nothing removes the compiled loops of *other* modules into which the
  changed function was compiled: they would go on as they were, and the mutant would survive for no reason.
- Most generated changes are of messages, of argument checks or of constants that decide speed only. A chosen slip is
  one that a person makes (a sign, a factor, an index, a dropped cap) in a line that decides a result, so that each
  survivor is worth reading.

Mutants name code by its text and not by its line (`seeds`), so a rebuild that moves or rewrites a line has to carry
its mutant along: a mutant whose text is gone, or is there twice, fails the run.

- `seeds`: what a mutant is, and the lists of them, one TOML file for each room in `seeds/`.
- `guards`: the tests that guard each room.
- `trees`: the unchanged copy of the tree and the scratch copies, with their caches of compiled loops.
- `order`: the pytest plugin that runs chosen tests in a chosen order and logs them.
- `runs`: one run of pytest in a forked process, watched by its processor time.
- `record`: the stored outcome, and tables of it.
"""
