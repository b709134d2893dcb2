"""Error bars of load sharing: the balance found again with a coarser contact, and with a coarser film as well.

Film and contact act on one another through the balance, so that neither's own error says much about friction: the
balance is solved anew on the grid of twice the cell (what changes is the contact's part), and there once more with the
film on half the points, columns and layers (the film's part); both begin from the solution and cost about a third of it
together. A third part is the balance's own tolerance. Each part is an estimate: the difference, times the factor that
the order of convergence and experiment give (`reports/experiments/mixed_error_bars.py`); the bar is their sum.
"""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass

import numpy as np

from bem.accuracy.bars import GRID, POINTS, ErrorBars, Rule
from bem.accuracy.contact import SPOT, surface_is_resolved
from bem.accuracy.film import FEWEST
from bem.accuracy.traction import DIFFERENCE, FILM_SHARE
from bem.contact.nested_iteration import sample
from bem.errors import Status
from bem.friction import MixedSolution
from bem.friction.balance import BalanceStart, Regime
from bem.friction.forces import lambda_ratio, oil_temperature
from bem.friction.load_sharing import LoadSharing
from bem.friction.models import films_of
from bem.friction.setup import FEWEST_CELLS, MixedSetup
from bem.grid import FloatArray, Grid
from bem.notes.accuracy import NoBar

BALANCE = "balance"
"""The origin of what the imbalance of loads and the contact's tolerance leave."""
ORIGINS = (GRID, POINTS, BALANCE)
_FEWEST_CELLS = 16
_LOADS = Rule(0.67, 0.67, edge=0.005, rough_edge=0.005)
"""At the edge as the load of a contact at a given gap (`bem.accuracy.contact`), as the balance asks for it: with
less, loads fell short in surfaces of 4 to 8 cells to a wave whose difference passed zero."""
RULES: dict[str, Rule] = {
    "friction": Rule(0.8, 0.8, edge=0.003, rough_edge=0.001),
    "boundary_part": _LOADS,
    "film_part": Rule(0.8, 0.8, edge=0.004, rough_edge=0.005),
    "contact_load": _LOADS,
    "film_load": Rule(1.0, 0.8, edge=0.001, rough_edge=0.0005),
    "minimum_film": Rule(0.5, 0.4, edge=0.0005),
    "lambda_ratio": Rule(1.0, 1.0),
    "contact_area_fraction": Rule(0.67, 0.67, edge=0.006, rough_edge=0.05),
    "contact_temperature": Rule(1.0, 1.0, edge=0.005, rough_edge=0.005),
    "flash_temperature": Rule(1.0, 1.0, edge=0.01, rough_edge=0.01),
}
"""Of the difference between the grids; set by `reports/experiments/mixed_error_bars.py` with seeds that it does not
store. Edges of areas whose spots are not resolved count squared: errors of contacts of one to five cells were 4 to
0.3 times the area."""
TEMPERATURES = ("contact_temperature", "flash_temperature")
"""Of a contact whose heat was asked for and that slides: they count from the oil's."""
_PARTS = ("boundary_part", "film_part")
"""Of friction: load that passes from film to contact takes from one what it adds to the other, so that differences of
either were up to nine times that of their sum, where their errors were of one sign."""
_LOAD_SHARES = ("contact_load", "film_load")
OF_FILM = ("friction", "film_part", "minimum_film", "lambda_ratio")
"""What follows the film: with full heat by a share of its change, and more of the difference, as of kind traction."""
_SUMMITS = 2.2
"""On that for uncoupled summits, whose radii are second differences between cells."""
_FILM, _FILM_TWICE = 0.6, 1.5
"""Of the difference to half the points of the film, and to twice as many."""
_FILM_SHARE = 0.2
"""Of the relative change of the minimum film, times the oil's friction: what stays where that of the shear and that of
the rolling force cancel (see `bem.accuracy.film`)."""
_CONTINUING = 1.5
"""On what the difference says of films that go on from solved ones; 1.0 was just enough for the friction of a ball at
6.8 times the load that its film is solved under, 1.0 to 1.6 in ten random ones (at 1.2 to 10 times)."""


@dataclass(frozen=True, eq=False)
class MixedCase:
    """Load sharing that was solved: set-up, heights (nx, ny) [m] and solution."""

    setup: MixedSetup
    height: FloatArray
    solution: MixedSolution


@dataclass(frozen=True)
class Shares:
    """Figures of load sharing by their names, whether it converged, and the largest load up to which its films are
    solved [N]: beyond it they go on from there (`point_film.thin_film`)."""

    figures: dict[str, float]
    status: Status
    solved_load: float


@dataclass(frozen=True)
class CoarserShares:
    """The figures with the coarser contact, and with the other film as well, which has `ratio` times the points; or why
    there are none."""

    contact: Shares | None
    both: Shares | None
    ratio: float = 0.5
    why: NoBar = NoBar.COARSER_UNSOLVED


def mixed_figures(solution: MixedSolution) -> dict[str, float]:
    """Figures of load sharing that have bars; temperatures [K] where there are any."""
    hot = {name: getattr(solution, name) for name in TEMPERATURES if getattr(solution, name) is not None}
    area = 0.0 if solution.contact is None else solution.contact.contact_area / solution.grid.area
    return {
        "friction": solution.friction,
        "boundary_part": solution.boundary_force / solution.load,
        "film_part": solution.film_force / solution.load,
        "contact_load": solution.contact_load,
        "film_load": solution.film_load,
        "minimum_film": solution.minimum_film,
        "lambda_ratio": solution.lambda_ratio,
        "contact_area_fraction": area,
        **hot,
    }


def solve_coarser_mixed(case: MixedCase) -> CoarserShares:
    """The balance again on the grid of twice the cell, with the film on as many points and on half of them (on twice as
    many where half are too few)."""
    grid = case.setup.grid
    if case.setup.repeated_cell:
        return CoarserShares(None, None, why=NoBar.REPEATED_CELL)
    if max(grid.shape) < _FEWEST_CELLS:
        return CoarserShares(None, None, why=NoBar.TOO_SMALL)
    points = case.setup.film_resolution
    fewest = FEWEST if case.setup.radii is None else FEWEST_CELLS
    other = points // 2 if points >= 2 * fewest else 2 * points
    contact = _shares(case, points)
    both = _shares(case, other, heat_mesh=0.5)
    if {contact.status, both.status} != {Status.CONVERGED}:
        return CoarserShares(None, None, why=NoBar.COARSER_UNSOLVED)
    return CoarserShares(contact, both, other / points)


def mixed_bars(case: MixedCase, coarser: CoarserShares) -> ErrorBars:
    """Bars of the figures of load sharing, their parts by origin."""
    if coarser.contact is None or coarser.both is None:
        return ErrorBars.unknown(mixed_figures(case.solution), coarser.why)
    found, cool = mixed_figures(case.solution), oil_temperature(case.setup)
    found |= {name: found[name] - cool for name in TEMPERATURES if name in found}
    one, two = coarser.contact.figures, coarser.both.figures
    resolved, uncoupled = surface_is_resolved(case.height, case.setup.grid), case.setup.contact_model == "uncoupled"
    if uncoupled and not resolved and not case.solution.full_film:
        return ErrorBars.unknown(found, NoBar.OTHER_SUMMITS)
    summits = _SUMMITS if uncoupled else 1.0
    share = _share_at_edge(case.solution)
    resolved = resolved and share < 4 / SPOT
    edge = _at_edge(case.solution, found, share, resolved=resolved)
    halved = _FILM_TWICE if coarser.ratio > 1 else _FILM * 3 / (1 / coarser.ratio**2 - 1)
    halved = max(halved, _of_continuing(found["film_load"], coarser.contact.solved_load, coarser.both.solved_load))
    parts = {
        GRID: {n: summits * RULES[n].bar(found[n] - one[n], edge[n], resolved=resolved) for n in found},
        POINTS: {n: halved * abs(one[n] - two[n]) for n in found},
        BALANCE: _balance_part(case.solution, case.setup, found),
    }
    hot_line = case.setup.thermal != "off" and case.setup.radii is None
    if hot_line:
        halved = max(halved, DIFFERENCE)
    thinner = abs(one["minimum_film"] - two["minimum_film"]) / max(found["minimum_film"], two["minimum_film"])
    parts[POINTS]["film_part"] += halved * _FILM_SHARE * thinner * abs(found["film_part"])
    if hot_line:
        for name in OF_FILM:
            parts[POINTS][name] += FILM_SHARE * thinner * abs(found[name])
    # film and contact sum to the load, so that one is as wrong as the other; boundary friction goes with the latter
    for part in parts.values():
        part |= dict.fromkeys(_LOAD_SHARES, max(part[name] for name in _LOAD_SHARES))
    if found["contact_load"] > 0:
        of_contact = parts[GRID]["contact_load"] / found["contact_load"]
        parts[GRID]["boundary_part"] = max(parts[GRID]["boundary_part"], of_contact * abs(found["boundary_part"]))
    for part in (parts[GRID], parts[POINTS]):
        part["friction"] = max(part["friction"], *(part[name] for name in _PARTS))
        # heat is friction's, and temperatures are linear in it
        missed = part["friction"] / abs(found["friction"]) if found["friction"] else 0.0
        for name in TEMPERATURES:
            if name in found:
                part[name] = max(part[name], missed * found[name])
    bars = ErrorBars.together(parts)
    if case.setup.load > coarser.contact.solved_load:
        bars = bars.without("lambda_ratio", NoBar.SCALED_FILM)
    if case.solution.regime is Regime.BOUNDARY:
        return bars.without("minimum_film", NoBar.LEAST_FILM)
    continued = found["film_load"] > coarser.contact.solved_load
    return bars.without("minimum_film", NoBar.SCALED_FILM) if continued else bars


def _of_continuing(load: float, solved: float, other: float) -> float:
    """On the difference between films that go on to a load [N] from solved ones under two others: the error grows with
    the logarithm of how far they go on, or faster, and of that the difference is a part."""
    beyond = math.log(max(load / solved, 1.0))
    return _CONTINUING * beyond / abs(beyond - math.log(max(load / other, 1.0))) if beyond > 0 else 0.0


def _share_at_edge(solution: MixedSolution) -> float:
    """Share of the contact area within a cell of its edge, 4 cells over the mean spot's width; 0 where there is none,
    and for closed forms."""
    contact = solution.contact
    area, perimeter = getattr(contact, "contact_area", 0.0), getattr(contact, "contact_perimeter", 0.0)
    return perimeter * math.sqrt(solution.grid.cell_area) / area if area > 0 and perimeter > 0 else 0.0


def _at_edge(solution: MixedSolution, found: dict[str, float], share: float, *, resolved: bool) -> dict[str, float]:
    """What of the figures lies within a cell of the contact's edge. Of loads no more than the other of film and contact
    has: that much can pass between them."""
    if not share > 0:
        return dict.fromkeys(found, 0.0)
    passed = min(solution.contact_load, solution.film_load)
    of_contact = passed / solution.contact_load if solution.contact_load > 0 else 0.0
    of_film = passed / solution.film_load if solution.film_load > 0 else 0.0
    parts = {"friction": of_contact, "boundary_part": of_contact, "contact_load": of_contact, "film_load": of_film}
    if not resolved:
        parts["contact_area_fraction"] = share
    return {name: share * parts.get(name, 1.0) * value for name, value in found.items()}


def half_grid(grid: Grid) -> Grid:
    """Every second cell of a grid along either axis, twice as wide (an odd number of periodic cells: a little less)."""
    shape, spacing = [], []
    for n, d, periodic in zip(grid.shape, grid.spacing, grid.periodic, strict=True):
        few = (n + 1) // 2
        shape.append(few)
        spacing.append(n * d / few if periodic else 2 * d if n > 1 else d)
    return Grid((shape[0], shape[1]), (spacing[0], spacing[1]), periodic=grid.periodic)


def _shares(case: MixedCase, points: int, heat_mesh: float = 1.0) -> Shares:
    """The balance on the grid of twice the cell with a film of other points, and times the columns and layers of full
    heat.

    Cells lie where every second of the finer ones does: on a free axis of an even number they are not centred, and the
    film is looked at where they are.
    """
    grid = half_grid(case.setup.grid)
    old, solution = case.setup.grid, case.solution
    setup = dataclasses.replace(case.setup, grid=grid, film_position=None, heat_mesh=heat_mesh).with_film(points)
    height = sample(case.height, grid.shape, grid.periodic)
    x, y = (
        whole[::2] if not periodic else own
        for whole, own, periodic in zip((old.x, old.y), (grid.x, grid.y), old.periodic, strict=True)
    )
    film = films_of(setup, solution.speeds, at=(x, y), initial=solution.film)
    whole = film.under(min(setup.load, film.largest_load), len(film.errors) - 1, solution.continuation.whole_film)
    pressure = None
    if solution.contact is not None:
        pressure = np.clip(sample(solution.contact_pressure, grid.shape, grid.periodic), 0.0, setup.hardness)
    start = BalanceStart(max(solution.film_load, 1e-12 * setup.load), solution.balance_slope, pressure)
    shared = LoadSharing(setup, film, film.speeds, whole).solve(height, start)
    balance, forces = shared.balance, shared.forces
    figures = {
        "friction": shared.friction,
        "boundary_part": forces.boundary / setup.load,
        "film_part": forces.film / setup.load,
        "contact_load": shared.contact_load,
        "film_load": balance.film.load,
        "minimum_film": balance.film.minimum_thickness,
        "lambda_ratio": lambda_ratio(whole, case.height),
        "contact_area_fraction": shared.contact_area_fraction,
        # rises over the oil; a contact that does not touch has none
        "contact_temperature": 0.0 if forces.heat is None else forces.heat.mean - oil_temperature(setup),
        "flash_temperature": 0.0 if forces.heat is None else forces.heat.maximum - oil_temperature(setup),
    }
    return Shares(figures, balance.status, film.solved_load)


def _balance_part(solution: MixedSolution, setup: MixedSetup, found: dict[str, float]) -> dict[str, float]:
    """What the balance's imbalances and the contact's tolerance may hide: the film load is off by that of the oil over
    the slope of the balance, the contact's load by as much and the imbalance, all else in proportion."""
    if solution.full_film:
        return dict.fromkeys(found, 0.0)
    missing = abs(solution.imbalance) + setup.contact_tolerance + abs(solution.oil_imbalance)
    film = missing * solution.film_load / max(solution.balance_slope, 0.1)
    if solution.regime is Regime.BOUNDARY:  # anything from nothing to this
        film = solution.film_load
    contact = missing * solution.load + film
    of_contact = contact / solution.contact_load if solution.contact_load > 0 else math.inf
    of_film = film / solution.film_load if solution.film_load > 0 else math.inf
    boundary, oil = abs(found["boundary_part"]) * of_contact, abs(found["film_part"]) * of_film
    heat = min((boundary + oil) / abs(found["friction"]), 1.0) if found["friction"] else 0.0
    return {
        **{name: found[name] * heat for name in TEMPERATURES if name in found},
        "friction": boundary + oil,
        "boundary_part": boundary,
        "film_part": oil,
        "contact_load": contact,
        "film_load": film,
        "minimum_film": found["minimum_film"] * of_film,
        "lambda_ratio": 0.0,
        "contact_area_fraction": found["contact_area_fraction"] * of_contact,
    }
