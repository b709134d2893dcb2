"""Rule by which the steps of a life grow and shrink, and the number of steps that it leads to.

The march follows the rule with the errors that it measures; a plan follows it with the error that is expected. Verified
in tests/life/test_steps.py.
"""

from __future__ import annotations

import math

_DOUBLES_BELOW = 0.4
"""Part of the tolerance below which a step's error lets the next one be twice as long: errors are of first order."""
_OF_ONE_POSITION = 0.18
_BY_POSITIONS = -0.85
"""Relative error of a step over the decay of pressure in it, with one position, and its power in their number. In
eleven lives (generated and measured surfaces, line contacts, Sq of 0.1 to 0.5 um, 2e-8 to 1.2e-7 mm^3/(N m), 93 to
450 N) the ratio was 0.18 to 0.22 with one position, 0.09 to 0.12 with 2, 0.02 to 0.045 with 8, 0.009 to 0.018 with
32."""


def next_trial(asked: float, made: float, error: float, tolerance: float, *, rejected: bool) -> float:
    """Return the trial of the next step [cycles].

    Parameters
    ----------
    asked : trial of this step, before it was cut to the longest allowed or to the end of the life [cycles].
    made : step as it was accepted [cycles].
    error : relative error of the accepted step.
    tolerance : largest relative error allowed.
    rejected : a longer step was tried and its error was too large.
    """
    tried = made if made >= asked or rejected else asked
    return tried * (2.0 if error < _DOUBLES_BELOW * tolerance else 1.0)


def error_per_cycle(compliance: float, contact_modulus: float, wavenumber: float, positions: int) -> float:
    """Return the relative error of a step over its cycles, an estimate for surfaces that were not yet in contact.

    Wear lowers a wave of pressure by E* q / 2 of the depth: the pressure that a place keeps decays at the rate
    compliance x E* q / 2 a cycle, whatever the load, and a step of first order misses a part of it. The more positions
    follow one another, the less of it a single one takes. The factors are measured; our own.

    compliance : depth worn of both bodies by pressure and cycle [m/Pa]. wavenumber : rms slope over rms height [1/m].
    """
    return _OF_ONE_POSITION * positions**_BY_POSITIONS * 0.5 * compliance * contact_modulus * wavenumber


_LEAST_STEP = 1e-12
"""Smallest step that is foreseen, over the cycles of the life."""


def foreseen_steps(cycles: float, first_step: float, longest: float, tolerance: float, error_rate: float) -> int:
    """Return the number of steps of a life whose errors are `error_rate` times their cycles.

    cycles : of the life. first_step, longest : first trial and upper bound of a step [cycles].
    """
    done, asked, count = 0.0, first_step, 0
    while done < cycles:
        step = whole = min(asked, longest, cycles - done)
        while error_rate * step > tolerance and step > _LEAST_STEP * cycles:
            step *= 0.5
        done, count = done + step, count + 1
        trial = next_trial(asked, step, error_rate * step, tolerance, rejected=step < whole)
        if min(trial, longest) <= step:  # settled
            return count + math.ceil(max(cycles - done, 0.0) / step)
        asked = trial
    return count
