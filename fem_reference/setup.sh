#!/bin/sh
# Make the interpreter of the finite-element side: Debian's dolfinx, plus gmsh and meshio from PyPI in .venv-fem.
# Quick and silent when everything is there. Run from anywhere; PIP_CONSTRAINT and the like are honoured.
set -eu
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd)
venv="$root/.venv-fem"
check='import dolfinx, petsc4py, gmsh, meshio; from petsc4py import PETSc'

if [ -x "$venv/bin/python" ] && "$venv/bin/python" -c "$check" >/dev/null 2>&1; then
    exit 0
fi

# OpenBLAS: MUMPS factors about ten times faster than with the reference BLAS. The X libraries are gmsh's.
packages="python3-dolfinx libopenblas0-pthread python3-venv libgl1 libglu1-mesa libxft2 libxcursor1 libxinerama1"
missing=""
for package in $packages; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q "ok installed" || missing="$missing $package"
done
if [ -n "$missing" ]; then
    as_root=""
    [ "$(id -u)" -eq 0 ] || as_root="sudo"
    $as_root apt-get update -q
    # shellcheck disable=SC2086  # a list of words on purpose
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends $missing
fi

[ -x "$venv/bin/python" ] || /usr/bin/python3 -m venv --system-site-packages "$venv"
# --no-deps: numpy must stay Debian's (petsc4py is compiled against it); meshio's other need, rich, is for its command line.
"$venv/bin/python" -m pip install --quiet --no-deps "gmsh>=4.13" "meshio>=5.3"
"$venv/bin/python" -c "import rich" 2>/dev/null || "$venv/bin/python" -m pip install --quiet --no-deps rich
"$venv/bin/python" -c "$check"
