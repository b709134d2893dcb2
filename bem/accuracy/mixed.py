"""Error bars of load sharing: the balance with a coarser contact, and with a coarser film as well.

Film and contact act on one another through the balance, so that neither's own error says much about friction. The
balance is solved on the grid of twice the cell (the difference is the contact's part), and there once more with the
film on half the points, columns and layers (the film's part); both start from the solution and cost about a third of
it. A third part is the balance's own tolerance. The bar is their sum.

Verified in tests/accuracy/test_mixed_bars.py; judged by the experiments that the tables name.
"""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass

import numpy as np

from bem.accuracy.bars import GRID, POINTS, ErrorBars
from bem.accuracy.coarsened import SPOT, edge_cell, half_grid, other_points, surface_is_resolved
from bem.accuracy.film import FEWEST
from bem.accuracy.richardson import Regime, Table, at, cover_parts, follow, relative, rows, share_error, to_half
from bem.contact.nested_iteration import sample
from bem.errors import Status
from bem.friction import MixedSolution
from bem.friction.asperities import AsperityContact
from bem.friction.balance import BalanceStart
from bem.friction.balance import Regime as LubricationRegime
from bem.friction.forces import lambda_ratio, supply_temperature
from bem.friction.load_sharing import LoadSharing
from bem.friction.models import films_of
from bem.friction.setup import FEWEST_CELLS, MixedSetup
from bem.grid import FloatArray
from bem.notes.accuracy import NoBar

BALANCE = "balance"
"""Origin of the errors that the imbalance of loads and the contact's tolerance leave."""
ORIGINS = (GRID, POINTS, BALANCE)
_FEWEST_CELLS = 16
"""Cells along the longer axis below which the grid of twice the cell has no contact to compare with."""
TEMPERATURES = ("contact_temperature", "flash_temperature")
"""Temperatures of a sliding contact whose heat was asked for; they count from the oil's."""
_PARTS = ("boundary_part", "film_part")
"""Parts of friction. Load that passes from film to contact adds to one what it takes from the other: differences of
either were up to nine times that of their sum, where their errors were of one sign."""
_LOADS = ("contact_load", "film_load")
"""Loads whose sum is prescribed."""

RULES = Table(
    "mixed_error_bars mixed_ball_error_bars heated_mixed_error_bars",
    rows("friction", 0.8, "Second order: 2.4 times Richardson, of a sum whose parts scatter.", edge=(0.003, 0.001)),
    rows(
        "boundary_part contact_load",
        0.67,
        "Second order: twice Richardson. The floor is that of the load of a contact at a given gap, for which the "
        "balance asks: differences of surfaces of 4 to 8 cells to a wave may pass zero.",
        edge=0.005,
    ),
    rows("film_part", 0.8, "As friction, whose other part it is.", edge=(0.004, 0.005)),
    rows("film_load", (1.0, 0.8), "The load less that of the contact.", edge=(0.001, 0.0005)),
    rows(
        "minimum_film",
        (0.5, 0.4),
        "It follows the film's load: weakly between elastic walls, in proportion between rigid ones (`_thinning`).",
        edge=(0.0005, 0.0),
    ),
    rows("lambda_ratio", 1.0, "The roughness on every second cell is another sample: first order.", order=1),
    rows(
        "contact_area_fraction",
        0.67,
        "Second order where spots are resolved. Elsewhere the edge counts squared: errors of contacts of one to five "
        "cells were 4 to 0.3 times the area.",
        edge=(0.006, 0.05),
    ),
    rows("contact_temperature", 1.0, "First order: heat enters through whole cells.", order=1, edge=0.005),
    rows("flash_temperature", 1.0, "First order: the hottest place is that of a cell.", order=1, edge=0.01),
)
"""Contact's part. Factors on the difference, and a floor on the figure's fraction within a cell of the edge (edge)."""
FILM_RULES = Table(
    "mixed_error_bars mixed_ball_error_bars",
    rows(" ".join(RULES), 0.6, "Second order: 1.8 times Richardson, as thicknesses of line films."),
    rows("film_part", 0.6, "Differences of the shear and of the rolling force may cancel.", film=0.12),
)
"""Film's part. Factors on the difference to half the points of the film, and a floor on the relative change of the
minimum film times the figure (film)."""
HOT_FILM_RULES = Table(
    "hot_mixed_error_bars heated_mixed_error_bars",
    rows(" ".join(RULES), 1.2, "First order: columns and layers of heat; 1.2 times Richardson.", order=1),
    rows("friction", 1.0, "First order; it follows the film.", order=1, film=0.7),
    rows("minimum_film lambda_ratio", 0.6, "The film, whose heat is of first order, in the floor.", film=1.0),
    rows(
        "film_part",
        1.0,
        "First order; differences of the shear and of the rolling force may cancel.",
        order=1,
        film=1.0,
    ),
)
"""Film's part of a line contact with heat; factors as of `FILM_RULES`."""
_LOCAL_THINNING = 1.5
"""Thinning of a film by its own load over the mean thinning from there to the whole load."""
_SUMMITS = 2.2
"""Factor on the contact's part for uncoupled summits, whose radii are second differences between cells."""
_CONTINUING = 1.5
"""Factor on the extrapolated difference of films that go on from solved ones: 1.0 was just enough for the friction of a
ball at 6.8 times the load that its film is solved under, 1.0 to 1.6 in ten random ones (at 1.2 to 10 times)."""


@dataclass(frozen=True, eq=False)
class MixedCase:
    """Solved load sharing: set-up, heights (nx, ny) [m] and solution."""

    setup: MixedSetup
    height: FloatArray
    solution: MixedSolution


@dataclass(frozen=True)
class Shares:
    """Figures of load sharing by their names, its status, and the largest load [N] under which its films are solved:
    beyond it they are extrapolated in load (`point_film.extrapolate_in_load`)."""

    figures: dict[str, float]
    status: Status
    solved_load: float


@dataclass(frozen=True)
class CoarserShares:
    """Figures with the coarser contact, and with a film of `ratio` times the points as well; or the reason why there
    are none."""

    contact: Shares | None
    both: Shares | None
    ratio: float = 0.5
    why: NoBar = NoBar.COARSER_UNSOLVED


def mixed_figures(solution: MixedSolution) -> dict[str, float]:
    """Return the figures of load sharing that have error bars; temperatures [K] where there are any."""
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
    """Solve the balance on the grid of twice the cell, with the film on as many points and on half of them (on twice as
    many where half are too few)."""
    grid = case.setup.grid
    if case.setup.repeated_cell and case.setup.radii is not None:
        return CoarserShares(None, None, why=NoBar.REPEATED_CELL)
    if max(grid.shape) < _FEWEST_CELLS:
        return CoarserShares(None, None, why=NoBar.TOO_SMALL)
    points = case.setup.film_resolution
    other = other_points(points, FEWEST if case.setup.radii is None else FEWEST_CELLS)
    contact = _shares(case, points)
    both = _shares(case, other, heat_mesh=0.5)
    if {contact.status, both.status} != {Status.CONVERGED}:
        return CoarserShares(None, None, why=NoBar.COARSER_UNSOLVED)
    return CoarserShares(contact, both, other / points)


def mixed_bars(case: MixedCase, coarser: CoarserShares) -> ErrorBars:
    """Return the error bars of the figures of load sharing, and their parts by origin."""
    if coarser.contact is None or coarser.both is None:
        return ErrorBars.unknown(mixed_figures(case.solution), coarser.why)
    found, oil = mixed_figures(case.solution), supply_temperature(case.setup)
    found |= {name: found[name] - oil for name in TEMPERATURES if name in found}
    resolved, uncoupled = surface_is_resolved(case.height, case.setup.grid), case.setup.contact_model == "uncoupled"
    if uncoupled and not resolved and not case.solution.full_film:
        return ErrorBars.unknown(found, NoBar.OTHER_SUMMITS)
    if uncoupled and _border_touches(case):
        return ErrorBars.unknown(found, NoBar.FREE_EDGE)
    parts = {
        GRID: _contact_part(case, found, coarser.contact, resolved=resolved),
        POINTS: _film_part(case, found, coarser.contact, coarser.both, coarser.ratio),
        BALANCE: _balance_part(case.solution, case.setup, found),
    }
    for part in parts.values():
        share_error(part, _LOADS)
    follow(parts[GRID], "boundary_part", "contact_load", found)
    thinning = _thinning(case, found)
    for part in (parts[GRID], parts[POINTS]):
        cover_parts(part, "friction", _PARTS)
        if thinning > 0:
            thinner = thinning * part["film_load"] / found["film_load"] * found["minimum_film"]
            part["minimum_film"] = max(part["minimum_film"], thinner)
        # temperatures are linear in the heat of friction
        for name in TEMPERATURES:
            if name in found:
                follow(part, name, "friction", found)
    bars = ErrorBars.together(parts)
    if case.setup.load > coarser.contact.solved_load:
        bars = bars.without("lambda_ratio", NoBar.SCALED_FILM)
    if case.solution.regime is LubricationRegime.BOUNDARY:
        return bars.without("minimum_film", NoBar.LEAST_FILM)
    continued = found["film_load"] > coarser.contact.solved_load
    return bars.without("minimum_film", NoBar.SCALED_FILM) if continued else bars


def _contact_part(case: MixedCase, found: dict[str, float], there: Shares, *, resolved: bool) -> dict[str, float]:
    """Return the errors of the contact's cells."""
    fraction = _edge_fraction(case.solution)
    regime = Regime.RESOLVED if resolved and fraction < 4 / SPOT else Regime.UNRESOLVED
    edge = relative(fraction, found)
    # no more load can pass between film and contact than the lighter of them carries
    passed = min(case.solution.contact_load, case.solution.film_load)
    for names, carried in (
        (("friction", "boundary_part", "contact_load"), case.solution.contact_load),
        (("film_load",), case.solution.film_load),
    ):
        for name in names:
            edge[name] *= passed / carried if carried > 0 else 0.0
    if regime is Regime.UNRESOLVED:
        edge["contact_area_fraction"] *= fraction
    summits = _SUMMITS if case.setup.contact_model == "uncoupled" else 1.0
    return relative(summits, RULES.errors(found, there.figures, {"edge": edge}, regime=regime))


def _film_part(case: MixedCase, found: dict[str, float], one: Shares, other: Shares, ratio: float) -> dict[str, float]:
    """Return the errors of the film's points, from balances on the same cells with films of 1 and `ratio` times the
    points."""
    hot_line = case.setup.thermal != "off" and case.setup.radii is None
    rules = HOT_FILM_RULES if hot_line else FILM_RULES
    loads = found["film_load"], one.solved_load, other.solved_load
    scale = max(to_half(ratio), _extrapolated_difference(*loads) / at(rules["film_load"].factor, Regime.RESOLVED))
    films = [shares.figures["minimum_film"] for shares in (one, other)]
    changed = scale * abs(films[0] - films[1]) / max(found["minimum_film"], films[1])
    nearer = {name: value + scale * (other.figures[name] - value) for name, value in one.figures.items()}
    own = {name: one.figures[name] for name in found}
    return rules.errors(own, nearer, {"film": relative(changed, found)})


def _extrapolated_difference(load: float, solved: float, other: float) -> float:
    """Return the factor on the difference between films extrapolated to a load [N] from two largest solved loads; 0 for
    a solved film.

    The error grows with the logarithm of the ratio of the loads, or faster, and the difference is a part of it.
    """
    beyond = math.log(max(load / solved, 1.0))
    return _CONTINUING * beyond / abs(beyond - math.log(max(load / other, 1.0))) if beyond > 0 else 0.0


def _thinning(case: MixedCase, found: dict[str, float]) -> float:
    """Return -d ln(minimum film) / d ln(film load), an upper estimate; 0 in full film, and beside uncoupled summits,
    where `_SUMMITS` covers the film as well.

    It falls from one between rigid walls to a tenth between elastic ones. That of the film's own load is larger than
    the mean one from this load to the whole load.
    """
    if not found["contact_load"] > 0 < found["film_load"] or case.setup.contact_model == "uncoupled":
        return 0.0
    lighter = math.log1p(found["contact_load"] / found["film_load"])
    whole = found["lambda_ratio"] * float(case.height.std())
    thicker = math.log(found["minimum_film"] / whole) if found["minimum_film"] > whole > 0 else 0.0
    return min(_LOCAL_THINNING * thicker / lighter, 1.0)


def _border_touches(case: MixedCase) -> bool:
    """Return True if a cell on the border of a free axis lies within the opposite surface.

    Whether it is a summit is decided by heights beyond the patch; uncoupled asperities leave it out.
    """
    contact = case.solution.contact
    if not isinstance(contact, AsperityContact):
        return False
    rough = case.height - case.height.mean()
    overlap = rough + contact.approach - np.broadcast_to(case.solution.patch_film.thickness, rough.shape)
    border = np.zeros(rough.shape, dtype=np.bool_)
    for axis, periodic in enumerate(case.setup.grid.periodic):
        if not periodic:
            np.moveaxis(border, axis, 0)[[0, -1]] = True
    return bool((overlap[border] > 0).any())


def _edge_fraction(solution: MixedSolution) -> float:
    """Return the fraction of the contact area within a cell of its edge; 0 without contact and for closed forms."""
    contact = solution.contact
    area, perimeter = getattr(contact, "contact_area", 0.0), getattr(contact, "contact_perimeter", 0.0)
    if not (area > 0 and perimeter > 0):
        return 0.0
    return float(perimeter * edge_cell(solution.contact_pressure, solution.grid) / area)


def _shares(case: MixedCase, points: int, heat_mesh: float = 1.0) -> Shares:
    """Solve the balance on the grid of twice the cell, with a film of other points.

    Cells lie where every second one of the finer grid does: on a free axis of an even number of cells they are not
    centred, and the film is evaluated at their places. Under cells that repeat the film keeps its own grid.

    heat_mesh : factor on the columns and layers of full heat.
    """
    grid = half_grid(case.setup.grid)
    old, solution = case.setup.grid, case.solution
    setup = dataclasses.replace(case.setup, grid=grid, film_position=None, heat_mesh=heat_mesh).with_film(points)
    height = sample(case.height, grid.shape, grid.periodic)
    x, y = (
        whole[::2] if not periodic else own
        for whole, own, periodic in zip((old.x, old.y), (grid.x, grid.y), old.periodic, strict=True)
    )
    at = None if setup.repeated_cell else (x, y)
    film = films_of(setup, solution.speeds, at=at, initial=solution.film)
    whole = film.under(min(setup.load, film.largest_load), len(film.level_errors) - 1, solution.continuation.whole_film)
    pressure = None
    if solution.contact is not None and not setup.repeated_cell:
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
        "contact_temperature": 0.0 if forces.heat is None else forces.heat.mean - supply_temperature(setup),
        "flash_temperature": 0.0 if forces.heat is None else forces.heat.maximum - supply_temperature(setup),
    }
    return Shares(figures, balance.status, film.solved_load)


def _balance_part(solution: MixedSolution, setup: MixedSetup, found: dict[str, float]) -> dict[str, float]:
    """Return the errors that the imbalances and the contact's tolerance leave.

    The film load is wrong by the imbalance of the oil over the slope of the balance, the contact load by as much and
    the imbalance of loads, all else in proportion.
    """
    if solution.full_film:
        return dict.fromkeys(found, 0.0)
    missing = abs(solution.imbalance) + setup.contact_tolerance + abs(solution.oil_imbalance)
    film = missing * solution.film_load / max(solution.balance_slope, 0.1)
    if solution.regime is LubricationRegime.BOUNDARY:  # the film carries anything up to this
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
