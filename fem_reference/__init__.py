"""The finite-element reference: dolfinx problems with known loads or contact, solved independently of the production
code.

Nothing here imports or copies from `bem`: a kernel that is wrong there cannot be wrong here in the same way. It runs in
its own interpreter (Debian's, with dolfinx; see
``setup.sh``) and hands over small result files, whose format `results.py` documents.

    python -m fem_reference --list
    python -m fem_reference disc --nu 0.3 --layer 0.1 0.3 0.5 --out mine.json
    python -m fem_reference all --out bem/verification/fem_results

A problem is a module with a ``PROBLEMS`` tuple of `fem_reference.problem.Problem`; the command line finds it by that.
dolfinx is imported through `compat.py` only, which holds
all differences between its versions.
"""
