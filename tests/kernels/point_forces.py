"""Oracle of the kernel tests: point-force solutions as printed in Johnson (1985), integrated by mpmath.

Boussinesq eq. 3.18-3.19, Cerruti eq. 3.75-3.76. xy under pressure
is xx - yy turned by 45 degrees, which has a factor 2 that copies of eq. 3.19 lose. It shares no formula with the
kernels: no potential, no corner.
"""

import itertools

import mpmath as mp
import numpy as np

from bem.kernels.loads import Load


def stress(x, y, z, nu, tangential, number=mp.mpf):
    """2 pi times the six stresses of a unit point force, order xx yy zz yz xz xy."""
    sqrt = mp.sqrt if number is mp.mpf else np.sqrt
    p = sqrt(x * x + y * y + z * z)
    k = 1 - 2 * nu
    s = p + z
    if tangential:
        return (
            -3 * x**3 / p**5 + k * x * (1 / p**3 - 3 / (p * s**2) + x * x / (p**3 * s**2) + 2 * x * x / (p**2 * s**3)),
            -3 * x * y * y / p**5
            + k * x * (1 / p**3 - 1 / (p * s**2) + y * y * (1 / (p**3 * s**2) + 2 / (p**2 * s**3))),
            -3 * x * z * z / p**5,
            -3 * x * y * z / p**5,
            -3 * x * x * z / p**5,
            -3 * x * x * y / p**5 - k * y * (1 / (p * s**2) - x * x * (1 / (p**3 * s**2) + 2 / (p**2 * s**3))),
        )
    # (1 - z/p)/r^2 = 1/(p (p + z))
    near = 1 / (p * s)
    r2 = x * x + y * y
    if r2 == 0:
        direct = -k / (2 * p * p)
        return (direct, direct, -3 / p**2, 0 * x, 0 * x, 0 * x)
    return (
        k / r2 * (near * (x * x - y * y) + z * y * y / p**3) - 3 * z * x * x / p**5,
        k / r2 * (near * (y * y - x * x) + z * x * x / p**3) - 3 * z * y * y / p**5,
        -3 * z**3 / p**5,
        -3 * y * z * z / p**5,
        -3 * x * z * z / p**5,
        k * x * y / r2 * (2 * near - z / p**3) - 3 * x * y * z / p**5,
    )


def displacement(x, y, z, nu, tangential):
    """4 pi G times the displacement (ux, uy, uz) of a unit point force."""
    p = mp.sqrt(x * x + y * y + z * z)
    k = 1 - 2 * nu
    s = p + z
    if tangential:
        return (
            1 / p + x * x / p**3 + k * (1 / s - x * x / (p * s**2)),
            x * y / p**3 - k * x * y / (p * s**2),
            x * z / p**3 + k * x / (p * s),
        )
    return (x * z / p**3 - k * x / (p * s), y * z / p**3 - k * y / (p * s), z * z / p**3 + 2 * (1 - nu) / p)


def panels(low, high, near, distance):
    """Panel ends that shrink geometrically towards `near`, to `distance`."""
    ends = {low, high}
    step = distance
    while step < high - low:
        ends.update(e for e in (near - step, near + step) if low < e < high)
        step *= 3
    if low < near < high:
        ends.add(near)
    return sorted(ends)


def integrate(kernel, x, y, z, a, b, parts, order=12):
    """`kernel(x - x', y - y', z)` (a tuple of `parts`) integrated over |x'| < a, |y'| < b by panelled Gauss rules."""
    nodes, weights = gauss(order)
    distance = mp.sqrt(z * z + max(abs(x) - a, 0) ** 2 + max(abs(y) - b, 0) ** 2)
    total = [mp.mpf(0)] * parts
    xs = panels(-a, a, x, distance)
    ys = panels(-b, b, y, distance)
    for x0, x1 in itertools.pairwise(xs):
        for y0, y1 in itertools.pairwise(ys):
            for s, ws in zip(nodes, weights, strict=True):
                px = x - ((x0 + x1) + s * (x1 - x0)) / 2
                for t, wt in zip(nodes, weights, strict=True):
                    py = y - ((y0 + y1) + t * (y1 - y0)) / 2
                    w = ws * wt * (x1 - x0) * (y1 - y0) / 4
                    for c, value in enumerate(kernel(px, py, z)):
                        total[c] += w * value
    return total


_RULES = {}


def gauss(order):
    """Gauss-Legendre rule on (-1, 1) in the working precision."""
    key = (order, mp.mp.prec)
    if key not in _RULES:
        nodes, weights = [], []
        for start in np.polynomial.legendre.leggauss(order)[0]:
            root = mp.mpf(float(start))
            for _ in range(4):  # Newton: 16 digits become 128 and more
                previous, value = mp.mpf(1), root
                for k in range(2, order + 1):
                    previous, value = value, ((2 * k - 1) * root * value - (k - 1) * previous) / k
                slope = order * (root * value - previous) / (root * root - 1)
                root -= value / slope
            nodes.append(root)
            weights.append(2 / ((1 - root * root) * slope**2))
        _RULES[key] = (nodes, weights)
    return _RULES[key]


def over_rectangle(solution, x, y, z, sides, load, nu, order):
    """Integral of a point-force solution over |x| < a, |y| < b in 25 digits, `sides` (a, b); as floats, over pi."""
    mp.mp.dps = 25
    x, y, z, a, b, nu = (mp.mpf(float(v)) for v in (x, y, z, *sides, nu))
    tangential = load is Load.TANGENTIAL
    count = 3 if solution is displacement else 6
    values = integrate(lambda p, q, r: solution(p, q, r, nu, tangential), x, y, z, a, b, count, order)
    return np.array([float(v / mp.pi) for v in values])


def relative(got, want):
    """Largest error over the largest component."""
    return np.abs(got - want).max() / np.abs(want).max()
