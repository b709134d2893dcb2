"""Newton's linear equations of the steady line contact, as they are handed to a solver.

Unknowns are the pressures P_1 .. P_{n-1}, the datum H0 and the exit X_e. Rows 0 .. n-1 are the flow through the cells,

    before_i dH_{i-1} + here_i dH_i + after_i dH_{i+1} + exit_i dH_n + (terms in dP_{i-1}, dP_i, dP_{i+1}) = right_i,

and the last one is the load. Films follow the unknowns through the elastic deflection.
"""

from __future__ import annotations

from dataclasses import dataclass

from bem.grid import FloatArray


@dataclass(frozen=True)
class Equations:
    """Coefficients of the rows (n,) each; `low`, `diagonal`, `high` of P_{i-1}, P_i, P_{i+1} directly.

    load : (n+1,) coefficients of the pressures in the last row; load_exit : of X_e there, inlet pressure included.
    position : abscissae of the nodes. inlet_slope : dP_0/dX_e. units : sizes of P, H0 and X_e.
    right : (n+1,). mismatch : (n+1,) by which the films change besides.
    """

    before: FloatArray
    here: FloatArray
    after: FloatArray
    exit: FloatArray
    low: FloatArray
    diagonal: FloatArray
    high: FloatArray
    load: FloatArray
    load_exit: float
    position: FloatArray
    inlet_slope: float
    units: tuple[float, float, float]
    right: FloatArray
    mismatch: FloatArray


def by_film(e: Equations, film: FloatArray) -> FloatArray:
    """What changes of the films do to the flow through the cells."""
    out: FloatArray = e.here * film[:-1] + e.after * film[1:] + e.exit * film[-1]
    out[1:] += e.before[1:] * film[:-2]
    return out
