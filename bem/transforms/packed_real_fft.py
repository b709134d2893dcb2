"""Convolution with an even kernel by packed real transforms: real rows as complex rows of half the length.

Two consecutive numbers of a real row are one complex number. With Z the spectrum of this complex field, m waves along y
where the real one has 2 m, and K the kernel's real and even multiplier, the spectrum of the result, packed likewise,
is, with s, d = (K[k, l] +- K[m - k, l]) / 2 and t = pi k / m,

    Z'[k, l] = (s - d sin t) Z[k, l] + i d cos t conj(Z[m - k, -l]).

The real field's spectrum is X[k] = E + O, conj(X[m - k]) = E - O with Z[k] = E + i exp(i t) O. Unpacking, product and
packing are one step. FFTW has vector instructions for complex rows only, so packed rows are faster than real ones.

Knows a plan and scratch (`loops`). Verified in tests/test_transforms.py against transforms of real rows.
"""

from __future__ import annotations

from bem.compiled import compiled
from bem.transforms.addresses import pointer_to
from bem.transforms.plans import execute


@compiled
def packed_columns_through(plan, scratch, kernel, first, last):
    """Transform the pairs of columns k and m - k (first <= k < last) along x, multiply, and transform back."""
    waves, row_spectra, whole, nx, length = (
        plan.spectra,
        plan.row_spectra,
        plan.unpadded_columns,
        plan.nx,
        plan.lengths[0],
    )
    sines, cosines, scale = plan.twiddles[0], plan.twiddles[1], plan.scales[0]
    forward, backward = (plan.executors[1], plan.column_plans[0, 0]), (plan.executors[1], plan.column_plans[1, 0])
    columns, columns_out = scratch.columns, scratch.columns_out
    begin, line, rows, row = row_spectra.ctypes.data, row_spectra.strides[0], kernel.ctypes.data, kernel.strides[0]
    spectra, results = columns_out.ctypes.data, columns.ctypes.data
    for k in range(first, last):
        other = waves - k if k > 0 else 0
        number = 1 if other == k else 2
        for place in range(number):
            column = other if place else k
            source = begin + column * line
            if not whole:
                for j in range(nx):
                    columns[place, j] = row_spectra[column, j]
                for j in range(nx, length):
                    columns[place, j] = 0
                source = results + place * columns.strides[0]
            execute(forward[0], forward[1], source, spectra + place * columns_out.strides[0])
        partner = (number - 1) * columns_out.strides[0], (number - 1) * columns.strides[0]
        own, beside = (spectra, results), (spectra + partner[0], results + partner[1])
        pair = rows + k * row, rows + (waves - k) * row
        _multiply_pair(pair, own, beside, length, (sines[k], cosines[k]), scale)
        for place in range(number):
            column, source = other if place else k, results + place * columns.strides[0]
            if whole:
                execute(backward[0], backward[1], source, begin + column * line)
                continue
            execute(backward[0], backward[1], source, spectra + place * columns_out.strides[0])
            for j in range(nx):
                row_spectra[column, j] = columns_out[place, j]


@compiled
def _multiply_pair(rows, here, there, length, turn, scale):
    """Multiply columns k and m - k by the kernel.

    Parameters
    ----------
    rows : addresses of the kernel's rows k and m - k.
    here, there : (address of the column, address of its result) for k and for m - k; equal if a column is its own
        partner.
    length : length of the columns.
    turn : (sin t, cos t).
    scale : half the scale of the inverse transform.
    """
    first, second = pointer_to(rows[0], scale), pointer_to(rows[1], scale)
    one, other = pointer_to(here[0], scale), pointer_to(there[0], scale)
    own, partner = pointer_to(here[1], scale), pointer_to(there[1], scale)
    arrays, turned = (one, other, own, partner), (turn[0], turn[1], scale)
    _multiply_at(first[0], second[0], arrays, 0, 0, turned)
    half = length // 2 + 1
    for j in range(1, half):
        _multiply_at(first[j], second[j], arrays, j, length - j, turned)
    for j in range(half, length):
        _multiply_at(first[length - j], second[length - j], arrays, j, length - j, turned)


@compiled
def _multiply_at(first, second, arrays, j, i, turn):
    """Multiply wave j of column k and its partner i of column m - k by the kernel's values at both."""
    (one, other, own, partner), (sine, cosine, scale) = arrays, turn
    s, d = (first + second) * scale, (first - second) * scale
    p, q, r = s - d * sine, s + d * sine, d * cosine
    x, y, u, v = one[2 * j], one[2 * j + 1], other[2 * i], other[2 * i + 1]
    own[2 * j], own[2 * j + 1] = p * x + r * v, p * y + r * u
    partner[2 * i], partner[2 * i + 1] = q * u + r * y, q * v + r * x
