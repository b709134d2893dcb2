"""Figures of others beside ours, for the validation page: from the stored results of experiments.

What is accepted stands beside each figure and follows from the source alone: its digits, what it says of itself, the
bounds it lies between; what a plotted curve shows is `READING`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from reports.builder import COLOURS, figure, table, text
from reports.experiments import kept
from reports.validation_values import READING

Rows = list[dict[str, Any]]
RIGID, ELASTIC = 1.42, 1.47
"""Biboulet and Houpert (2010), as quoted: resistance over E' R U^1/2 W^1/2 and over E' R U^3/4."""
MOES = 0.10
"""What Moes (1992) says of his formula."""
SHARES = {"a published case": (1.8, 1.2), "raceway": (2.32, 0.97), "rib": (1.90, 0.99)}
"""B and C of exp(-B Lambda^C): the one quoted of Zhou and Hoeprich (1991), and those of Schwarz et al. (2023)."""
HEADERS = ("figure", "source", "accepted", "ours", "verdict")


def body() -> str:
    """The section's tables with their verdicts."""
    parts = [text("Numbers that nobody here wrote. Each verdict is computed from the stored result of an experiment.")]
    for name, drawn in (
        ("independent_figures", lambda f: _rolling(f["rigid_constant"], f["rolling"])),
        ("film_regimes", _regimes),
        ("load_share_curves", _load_shares),
        ("independent_figures", lambda f: _self_affine(f["self_affine"])),
        ("independent_figures", lambda f: _hard_cases(f["plastic"], f["near_full"])),
    ):
        parts.append(_kept(name, drawn))
    return "".join(parts)


def _kept(name: str, drawn: Callable[[Any], str]) -> str:
    """What is drawn of a stored result, with a word where it is of other code; or how to make it."""
    try:
        found = kept.found(name)
    except FileNotFoundError:
        return text(f"Not run: python -m reports.experiments.{name}")
    return drawn(found) + kept.age(name)


def _verdict(agrees: bool) -> str:
    return "agrees" if agrees else "differs"


def _rolling(constant: float, rows: Rows) -> str:
    rigid = [row for row in rows if row["M"] <= 0.01]
    elastic = [row for row in rows if row["M"] >= 5]
    worst = max(abs(row["over_sqrt_UW"] / constant - 1) for row in rigid)
    mesh = max(row["mesh_error"] for row in rows)
    low, high = (pick(row["over_U34"] for row in elastic) for pick in (min, max))
    at = {m: [row["over_U34"] / ELASTIC - 1 for row in rows if row["M"] == m] for m in (20.0, 200.0)}
    lines = [
        (
            "rigid, M = 0.01",
            f"{constant:.4f} by quadrature of Reynolds' equation; {RIGID} as quoted",
            "0.1 % of the quadrature, which has no error; half the last digit of what is quoted",
            f"{rigid[0]['over_sqrt_UW']:.4f} to {rigid[-1]['over_sqrt_UW']:.4f}",
            f"{_verdict(worst < 1e-3)} with the quadrature to {worst:.1g}; {_verdict(abs(constant - RIGID) < 0.005)} "
            f"with the quoted figure, which is {100 * (1 - RIGID / constant):.1f} % below both",
        ),
        (
            "elastohydrodynamic, M = 5 to 200, L = 4 to 16",
            f"{ELASTIC} as quoted, a constant",
            "5 %, what a plotted curve shows",
            f"{low:.2f} to {high:.2f}",
            _verdict(max(abs(low / ELASTIC - 1), abs(high / ELASTIC - 1)) < READING)
            + ": no constant. Above the quoted one by "
            + "; ".join(f"{100 * min(v):+.0f} to {100 * max(v):+.0f} % at M = {m:g}" for m, v in at.items()),
        ),
    ]
    return table(
        HEADERS,
        lines,
        caption="Resistance to pure rolling per length, over E' R U^1/2 W^1/2 and over E' R U^3/4; U of the sum of "
        "speeds. Biboulet and Houpert (2010), line contacts: Barus, Dowson-Higginson, M 0.2-200, L 4-16.",
    ) + text(
        f"Why ours lies above at M = 20: the figure is settled on the mesh ({mesh:.0e} between 1000 and 2000 points), "
        "and it is right in the limit that has a closed form. Over E' R U^3/4 it rises to a maximum near M = 5-20 and "
        "falls slowly beyond; a constant for all of it is a fit in the middle of that."
    )


def _regimes(found: dict[str, Any]) -> str:
    """The four asymptotes, as far into each regime as the solver goes, and the map that joins them."""
    isoviscous, piezoviscous = found["rigid_constants"]
    lines = []
    for name, words, power, source, exact in (
        ("rigid_isoviscous", "H M", lambda load, oil: load, "3", isoviscous),
        ("rigid_piezoviscous", "H / L^2/3", lambda load, oil: oil ** (-2 / 3), "1.287", piezoviscous),
        ("elastic_isoviscous", "H M^1/5", lambda load, oil: load**0.2, "2.621", None),
        ("elastic_piezoviscous", "H M^1/8 / L^3/4", lambda load, oil: load**0.125 * oil**-0.75, "1.311", None),
    ):
        row = found["deepest"][name]
        ours = row["H"] * power(row["M"], row["L"])
        agrees = row["status"] == "converged" and abs(ours / float(source) - 1) < (0.01 if exact else MOES)
        lines.append(
            (
                f"{name.replace('_', ' ')}: {words} at M = {row['M']:g}, L = {row['L']:g}",
                f"{source}, Moes (1992)" + (f"; {exact:.4f} by quadrature" if exact else ""),
                "1 %: a limit with a closed form" if exact else "10 %, as he says of his formula",
                f"{ours:.4f}",
                f"{_verdict(agrees)}: {100 * (ours / (exact or float(source)) - 1):+.1f} %",
            )
        )
    apart = [(row["H"] / row["moes"] - 1, row) for row in found["map"]]
    low, high = (pick(apart, key=lambda pair: pair[0]) for pick in (min, max))
    unsolved = sum(row["status"] != "converged" for row in found["map"])
    lines.append(
        (
            f"joined formula, {len(apart)} films, M = 0.1 to 1000, L = 0 to 15",
            "Moes (1992)",
            "10 %, as he says",
            "; ".join(f"{100 * off:+.1f} % at M = {row['M']:g}, L = {row['L']:g}" for off, row in (low, high)),
            _verdict(unsolved == 0 and max(-low[0], high[0]) < MOES),
        )
    )
    mesh = max(row["H_half"] for row in (*found["map"], *found["deepest"].values()))
    return table(
        HEADERS,
        lines,
        caption="Film of a line contact at the largest pressure in R U^1/2: Barus, incompressible, Newtonian. On half "
        f"the points none changes by more than {100 * mesh:.1f} %.",
    )


def _load_shares(curves: list[dict[str, Any]]) -> str:
    """Our share over Lambda for each length of the patch, and the published curves."""
    import matplotlib.pyplot as plt

    drawing, axes = plt.subplots(figsize=(6, 3.4), layout="constrained")
    grid = [10 ** (-1.3 + 0.02 * i) for i in range(121)]
    for (b, c), name in zip(SHARES.values(), SHARES, strict=True):
        axes.semilogx(grid, [math.exp(-b * x**c) for x in grid], color=COLOURS[6], linewidth=0.8, label=name)
    half = sorted((math.log(2) / b) ** (1 / c) for b, c in SHARES.values())
    constants = [sorted(values) for values in zip(*SHARES.values(), strict=True)]
    lines = []
    for number, curve in enumerate(curves):
        rows, length = curve["rows"], curve["length_over_hertz"]
        counted = {"patch": "oil on the patch", "loaded": "oil where the film is loaded"}[curve["oil_volume"]]
        ratio, share = [row["lambda"] for row in rows], [row["contact_share"] for row in rows]
        axes.plot(ratio, share, "o-", color=COLOURS[number], label=f"ours, {length:g} times Hertz', {counted}")
        inside = all(low <= curve[key] <= high for key, (low, *_, high) in zip("BC", constants, strict=True))
        lines.append(
            (
                f"share of the load in contact, patch {length:g} times as long as Hertz' contact, {counted}",
                "exp(-B Lambda^C): "
                + ", ".join(f"{name} {b}, {c}" for name, (b, c) in SHARES.items())
                + f"; half at Lambda = {half[0]:.2f} to {half[-1]:.2f}",
                "that form to 0.05, what a plotted curve shows; B and C within the published ones",
                f"B = {curve['B']:.2f} ± {curve['B_error']:.2f}, C = {curve['C']:.2f} ± {curve['C_error']:.2f}; off by "
                f"{curve['largest']:.2f} at most; {max(share):.2f} at Lambda = {min(ratio):.2f}",
                _verdict(inside and curve["largest"] <= READING),
            )
        )
    axes.set(xlabel="central film over Sq", ylabel="share of the load in contact", ylim=(0, 1))
    axes.legend(frameon=False, fontsize="small")
    return (
        table(
            HEADERS,
            lines,
            caption="Load share over Lambda. Zhou and Hoeprich (1991): ground surfaces after running-in; Schwarz and "
            "others (2023): raceway and rib of a tapered roller bearing. B and C are a surface's: the range is that of "
            "three. Ours: roller on raceway at 1 GPa, Sq 160 nm, waves of some 30 um, pure rolling.",
        )
        + figure(drawing, "Share of the load in contact over Lambda, ours by length of the patch.")
        + text(
            "Where film and contact carry side by side in a contact many times wider than the waves, keeping one "
            "volume of oil over the rough patch lets the film carry a share at any speed however low: most of that oil "
            "lies beside Hertz' contact, and the longer the patch, the more of it there is. At small Lambda such a "
            "share is the patch's and not the surface's. Counted where the film is loaded (sharing.oil_volume), oil "
            "beside it has no say, nor has the length. See the documentation on oil films."
        )
    )


def _self_affine(rows: Rows) -> str:
    import matplotlib.pyplot as plt

    drawing, axes = plt.subplots(figsize=(6, 3.4), layout="constrained")
    pressure = [row["pressure"] for row in rows]
    axes.loglog(pressure, [row["area"] for row in rows], "o", color=COLOURS[0], label="ours, 512 cells, 3 surfaces")
    axes.loglog(pressure, [math.erf(math.sqrt(2) * p) for p in pressure], color=COLOURS[1], label="Persson")
    low = [p for p in pressure if p <= 0.1]
    axes.loglog(low, [math.sqrt(2 * math.pi) * p for p in low], ":", color=COLOURS[2], label="Bush, Gibson and Thomas")
    axes.set(xlabel="pressure over E* and rms slope", ylabel="contact area fraction")
    axes.legend(frameon=False)
    slopes = [row["area"] / row["pressure"] for row in rows if row["pressure"] <= 0.05]
    first, last = (row for row in rows if row["pressure"] in (0.01, 0.05))
    decay = (first["gap"] - last["gap"]) / math.log(last["pressure"] / first["pressure"])
    law = [row["area"] / math.erf(math.sqrt(2) * row["pressure"]) - 1 for row in rows]
    lines = [
        (
            "area over pressure, light loads",
            "1.60 (Persson 2001) to 2.51 (Bush, Gibson and Thomas 1975); about 2 by boundary elements and "
            "Green's functions (Prodanov, Dapp and Mueser 2014; Yastrebov, Anciaux and Molinari 2017)",
            "between the two theories",
            f"{min(slopes):.2f} to {max(slopes):.2f}",
            _verdict(all(math.sqrt(8 / math.pi) < s < math.sqrt(2 * math.pi) for s in slopes)),
        ),
        (
            "area up to full contact",
            "erf(sqrt(2) p), Persson; boundary elements lie above at light loads and meet it at full contact",
            "nowhere 5 % below it, what a plotted curve shows; within that of it at p = 1",
            f"{100 * max(law):+.0f} % at p = {pressure[law.index(max(law))]:g}, {100 * min(law):+.1f} % at p = "
            f"{pressure[law.index(min(law))]:g}, {100 * law[-1]:+.1f} % at p = 1",
            _verdict(min(law) > -READING and abs(law[-1]) < READING),
        ),
        (
            "mean gap, p ~ exp(-u/u0): u0 over Sq",
            "0.4 to 0.5, Persson 2007 and the numerical results it was compared to",
            "that range",
            f"{decay:.3f}",
            _verdict(0.4 <= decay <= 0.5),
        ),
    ]
    return table(
        HEADERS,
        lines,
        caption="Self-affine surfaces, H = 0.8, waves of 1/4 to 1/64 of the square, 8 cells to the shortest.",
    ) + figure(drawing, "Contact area of self-affine surfaces over pressure, in units of E* and the rms slope.")


def _hard_cases(plastic: Rows, near_full: Rows) -> str:
    """Contacts that others report as not converging."""
    lines = []
    for rows, name, source in (
        (
            plastic,
            "capped, H = 0.1 E*, rms slope 0.08",
            "no convergence above 0.07 E*: ContactMechanics, issue 68",
        ),
        (
            near_full,
            "elastic up to full contact, 2048 x 2048 cells",
            "poor convergence of Polonsky and Keer's method, 2048 x 2048 not converged: ContactMechanics, issue 3",
        ),
    ):
        for row in rows:
            done = row["status"] == "converged"
            lines.append(
                (
                    f"{name}, p = {row['pressure']:g} E*" + ("" if rows is plastic else " and slope"),
                    source,
                    "converged, by what is recomputed from the result",
                    f"{row['convolutions']:.0f} convolutions, residual {row['residual']:.0e}, area {row['area']:.4f}"
                    + (f", {row['plastic_area']:.4f} at the hardness" if "plastic_area" in row else ""),
                    "converges" if done else row["status"],
                )
            )
    return table(HEADERS, lines, caption="Contacts that other codes are known to stall in.")
