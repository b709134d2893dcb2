"""Load sharing between oil film and rough contact, and the Stribeck curve.

The smooth film under the load F_H gives the thickness h(x). The rough surfaces are pressed together until the volume of
oil between them, deformed, is that of the smooth film; that takes the load F_C. F_H is found so that F_H + F_C is the
load (`balance`); the films are solved as they are asked for (`film`), the contact is the rough half-space or uncoupled
asperities (`rough_contact`).
"""

from __future__ import annotations

import dataclasses
import difflib
import inspect
from collections.abc import Sequence
from typing import Any

import numpy as np

from bem.errors import InputError, Status
from bem.friction.balance import Balance, Regime, share_load
from bem.friction.boundary import BoundaryFrictionGiven
from bem.friction.choose_contact import rough_contact
from bem.friction.continuation import continuation, first_trial
from bem.friction.curves import relative_difference
from bem.friction.film import PatchFilm, SolvedFilm, middle_line
from bem.friction.films import SolvedFilms, films_of
from bem.friction.forces import Forces, coupling_notes, friction_forces, lambda_ratio, validity_notes
from bem.friction.oil_beside import oil_notes
from bem.friction.oil_on_contact import covered_notes
from bem.friction.oil_sensitivity import oil_beside
from bem.friction.oil_volume import OilVolume
from bem.friction.rough_contact import RoughContact
from bem.friction.setup import FILM_CELLS, MixedSetup
from bem.friction.solution import MixedSolution
from bem.grid import FloatArray, Grid
from bem.lubrication import FilmSolution, Lubricant, PointFilmSolution
from bem.lubrication.line_kept import without_equations
from bem.lubrication.rough_walls import WallFactors
from bem.lubrication.supply import Supply
from bem.materials import Body
from bem.notes import Note
from bem.plausibility import body_arguments, lubricant_arguments, notes_on_arguments

LARGEST_ERROR = 0.01
"""Of a film under the whole load, whose minimum makes the lambda ratio."""


def solve_mixed(
    *,
    height: FloatArray,
    grid: Grid,
    bodies: Body | tuple[Body, Body],
    radius: float | None = None,
    width: float | None = None,
    radii: Sequence[float] | None = None,
    load: float,
    speeds: Sequence[float],
    lubricant: Lubricant,
    boundary_friction: BoundaryFrictionGiven,
    hardness: float | None = None,
    tolerance: float = 1e-4,
    film_points: int = 2000,
    film_cells: int = FILM_CELLS,
    contact_model: str = "coupled",
    asperity_separation: str = "volume",
    separation: str = "volume",
    contact_tolerance: float = 1e-6,
    film_position: FloatArray | None = None,
    striated_exit: bool = False,
    initial: MixedSolution | None = None,
    flow_factors: WallFactors | str = "off",
    oil_volume: OilVolume | str = OilVolume.LOADED,
    supply: Supply | float | None = None,
    thermal: str = "off",
) -> MixedSolution:
    """Friction of a rough cylinder, ball or ellipsoid on a flat in mixed lubrication.

    Parameters
    ----------
    height : (nx, ny), roughness of both surfaces together [m], out of the flat; its mean does not matter.
    grid : of the rough patch, centred under the cylinder; free along x and periodic along y as a rule. Its length
        along y is one slice of the contact. Under a ball it is free, and holds the contact; or it is periodic along x
        and y, a cell of the roughness that repeats all over the contact (`bem.friction.repeated_cell`), with the oil
        counted where the film is "loaded".
    bodies : one Body (the other rigid) or a pair.
    radius, width : of the cylinder [m].
    radii : (Rx, Ry) of relative curvature of a ball or ellipsoid [m], in place of radius and width. Its film is that of
        `solve_point_film`.
    load : on the whole width [N].
    speeds : (u1, u2) of flat and cylinder or ball along x [m/s].
    lubricant : the oil.
    boundary_friction : coefficient where the surfaces touch; or a law of `bem.friction.boundary`, as an object or as a
        table such as {"kind": "pressure_dependent", "shear_strength": 1e6, "pressure_coefficient": 0.1}.
    hardness : cap of the contact pressure [Pa]; None is elastic.
    tolerance : of the balance, (F_H + F_C - load) / load.
    film_points : nodes of the film's own mesh.
    film_cells : of a ball's film along an axis.
    contact_model : "coupled" (the half-space), or "uncoupled" (every summit a Hertz sphere), the usual baseline.
    asperity_separation : distance of the mean planes for uncoupled asperities: "volume" keeps the volume of oil between
        the surfaces, cut where they overlap; "film" is the film thickness itself.
    separation : "volume" keeps the volume of oil between the surfaces (`oil_volume`). "film": the undeformed mean
        planes are as far apart as the film is thick at its centre, for coupled and uncoupled asperities alike, as in
        figures 5 and 6 of the thesis' paper A (`bem.friction.given_separation`). It needs a cylinder and a grid that is
        periodic along x and y.
    contact_tolerance : of the rough contact.
    film_position : ascending abscissae [m] on which `film` is returned; the film's own mesh by default.
    striated_exit : whether the oil behind the exit adds to the friction (`FilmSolution.striated_shear_force`); not with
        heat.
    initial : solution of a similar case to start from.
    flow_factors : "off", or a table of `bem.flow_factors`: roughness then changes the film too, see `solve_line_film`;
        `lambda_ratio` is that of the film between rough walls.
    oil_volume : area over which the mean opening of the rough surfaces equals the mean film thickness
        (`bem.friction.oil_volume`). "loaded": where the film carries load, weighted by its pressure; it conserves the
        flow through the loaded zone and converges with the patch's length. "patch": the whole patch, the thesis'
        choice; it follows the patch's length where nearly all oil lies beside the Hertz contact. "hertz": the nominal
        Hertz contact under the total load. `MixedSolution.oil` says how far the last two differ from "loaded".
    supply : oil that reaches the contact, as of `solve_line_film`; of a ball a layer of it, without flow factors.
        `MixedSolution.film.starvation` says what it does.
    thermal : "off", "lumped" or "full": the film with its heat, as of `solve_line_film`; the contact's surfaces as
        warm as rubbing makes them (`bem.friction.contact_heat`), which boundary friction over temperature is told. Far
        away both bodies are as warm as the oil that comes. No supply with "full", which is not there under a ball.

    Returns
    -------
    MixedSolution; friction = (F_boundary + F_film) / load, F_boundary the sum of the boundary shear stress over the
    contact (boundary_friction F_C for a coefficient), F_film the shear force of the film on the flat outside the cells
    in contact. `status` is converged only where the returned film and contact carry the load to
    `tolerance`; `notes` say where a model is outside its validity. A film that is left with less than a tenth of the
    tolerance is boundary lubrication: the contact is then solved for all the rest of the load. So it is, and a note
    tells it apart, where the film's model ends while the film is a few molecules thick.

    Raises
    ------
    InputError : values out of range; no entrainment; a patch that is larger than `film_position` or does not cover
        the contact; film positions that do not reach the inlet.

    Notes
    -----
    Model of the thesis' papers A and D; the volume condition is `mean_gap` control of the rough contact. Boundary
    friction couples into the normal displacements of the coupled contact unless the bodies are elastically alike, where
    it cancels; the flat feels it against its sliding over the cylinder; a law takes one number for it
    (`bem.friction.boundary`). Uncoupled asperities do not feel it.
    """
    setup = MixedSetup(
        grid=grid,
        bodies=bodies,
        radius=radius,
        width=width,
        radii=radii,
        load=load,
        lubricant=lubricant,
        boundary_friction=boundary_friction,
        hardness=hardness,
        tolerance=tolerance,
        film_points=film_points,
        film_cells=film_cells,
        contact_model=contact_model,
        asperity_separation=asperity_separation,
        separation=separation,
        contact_tolerance=contact_tolerance,
        film_position=film_position,
        striated_exit=striated_exit,
        flow_factors=flow_factors,
        oil_volume=oil_volume,
        supply=supply,
        thermal=thermal,
    )
    found = solve_setup(setup, height, speeds, initial)
    return dataclasses.replace(found, notes=_notes_on_arguments(setup, found.speeds) + found.notes)


def _notes_on_arguments(setup: MixedSetup, speeds: tuple[float, float]) -> tuple[Note, ...]:
    """Notes on arguments of `solve_mixed` outside their usual ranges."""
    radii = (setup.radius,) if setup.radii is None else tuple(setup.radii)
    arguments = {
        "load": ("load", setup.load),
        "radius" if setup.radii is None else "radii": ("radius", tuple(one for one in radii if one is not None)),
        "width": ("length of a body", setup.width),
        "speeds": ("speed", speeds),
        "hardness": ("hardness", setup.hardness),
        "grid": ("cell of the grid", setup.grid.spacing),
        "boundary_friction": ("friction", setup.boundary_law.constant),
    }
    return notes_on_arguments(arguments | lubricant_arguments(setup.lubricant) | body_arguments(setup.bodies))


def stribeck_curve(speeds: Sequence[float | Sequence[float]], **as_solve_mixed: Any) -> list[MixedSolution]:
    """Load sharing at many speeds, each started from the one before.

    Parameters
    ----------
    speeds : sliding speeds of the flat [m/s], the cylinder at rest; or pairs (u1, u2).
    **as_solve_mixed : the other arguments of `solve_mixed`.

    Returns
    -------
    One MixedSolution per speed, in the order given.

    Raises
    ------
    InputError : as `solve_mixed`; no speeds; an argument that `solve_mixed` does not have, or one missing.
    """
    pairs = [(float(u), 0.0) if isinstance(u, (int, float, np.number)) else u for u in speeds]
    if not pairs:
        raise InputError("speeds: give at least one")
    _check_keywords(as_solve_mixed)
    initial, height = as_solve_mixed.pop("initial", None), as_solve_mixed.pop("height")
    setup = MixedSetup(**as_solve_mixed)
    curve: list[MixedSolution] = []
    for pair in pairs:
        initial = solve_setup(setup, height, pair, initial)
        curve.append(dataclasses.replace(initial, notes=_notes_on_arguments(setup, initial.speeds) + initial.notes))
    return curve


def _check_keywords(given: dict[str, Any]) -> None:
    """Keywords of `stribeck_curve` against those of `solve_mixed`."""
    parameters = inspect.signature(solve_mixed).parameters
    known = [name for name in parameters if name != "speeds"]
    messages = []
    for name in given:
        if name not in parameters:
            near = difflib.get_close_matches(name, known, n=1)
            hint = f"did you mean {near[0]!r}?" if near else f"choose from {', '.join(known)}"
            messages.append(f"stribeck_curve: {name!r} is not an argument; {hint}")
    for name in known:
        if parameters[name].default is inspect.Parameter.empty and name not in given:
            messages.append(f"stribeck_curve: {name!r} is missing")
    if messages:
        raise InputError(messages)


def largest_difference(coupled: Sequence[MixedSolution], uncoupled: Sequence[MixedSolution]) -> float:
    """Maximum relative difference d of two friction curves: the largest |f_u - f_c| over f_u at that speed.

    Eq. (13) of the thesis' paper A.

    Raises
    ------
    InputError : curves at different speeds, or none.
    """
    if not coupled or [s.speeds for s in coupled] != [s.speeds for s in uncoupled]:
        raise InputError("largest_difference: the curves must be at the same speeds")
    return relative_difference([s.friction for s in coupled], [s.friction for s in uncoupled])


def solve_setup(
    setup: MixedSetup, height: FloatArray, speeds: Sequence[float], initial: MixedSolution | None = None
) -> MixedSolution:
    """Load sharing of a set-up with heights (nx, ny) [m] at a pair of speeds (u1, u2) [m/s].

    Raises
    ------
    InputError : heights of another shape or not finite; no entrainment; film positions that do not reach the inlet.
    """
    height = setup.grid.check_field(height, "height")
    if not (initial is None or isinstance(initial, MixedSolution)):
        raise InputError(f"initial: {type(initial).__name__} is not a MixedSolution")
    film = films_of(setup, speeds, initial=None if initial is None else initial.film)
    rough = rough_contact(setup, height, film.speeds)
    wholes = _whole_films(film, rough, setup.load, None if initial is None else initial.continuation.whole)
    start = first_trial(setup, film.speeds, initial)
    balance = share_load(film, rough, setup.load, setup.tolerance, wholes[-1], start)
    balance = dataclasses.replace(balance, films=balance.films + len(wholes))
    return _solution(setup, height, film, rough, wholes, balance, initial)


def _whole_films(film: SolvedFilms, rough: RoughContact, load: float, start: PatchFilm | None) -> tuple[PatchFilm, ...]:
    """Films under the whole load, or under as much as there are films for, the last the best: a finer one only where
    the coarser clears the roughness, or says too little of the lambda ratio."""
    load = min(load, film.largest_load)
    wholes: list[PatchFilm] = []
    levels = [level for level, error in enumerate(film.errors) if error <= LARGEST_ERROR]
    for level in levels:
        wholes.append(film.under(load, level, wholes[-1] if wholes else start))
        if not rough.clears(wholes[-1]):
            break
    return tuple(wholes)


def _solution(
    setup: MixedSetup,
    height: FloatArray,
    film: SolvedFilms,
    rough: RoughContact,
    wholes: tuple[PatchFilm, ...],
    balance: Balance,
    initial: MixedSolution | None,
) -> MixedSolution:
    found, contact, whole = balance.film, balance.contact, wholes[-1]
    before = None if initial is None else initial.oil
    forces = friction_forces(found, contact, setup, film.speeds)
    friction, covered = (forces.boundary + forces.film) / setup.load, forces.covered / setup.load
    oil = oil_beside(setup, height, balance, whole, speeds=film.speeds, friction=friction, before=before)
    returned: FilmSolution | PointFilmSolution | None = found.solution
    assert returned is not None
    seen = _seen(found, setup)
    if setup.film_position is not None:
        assert isinstance(film, SolvedFilm)
        negligible = balance.regime is Regime.BOUNDARY
        returned = film.resampled(found, setup.film_position, negligible=negligible)
    return MixedSolution(
        speeds=film.speeds,
        friction=friction,
        boundary_force=forces.boundary,
        film_force=forces.film,
        load=setup.load,
        contact_load=0.0 if contact is None else contact.load,
        film_load=found.load,
        film=without_equations(returned) if isinstance(returned, FilmSolution) else returned,
        contact=None if contact is None else contact.solution,
        separation=_separation(seen, setup) if contact is None else contact.separation,
        lambda_ratio=lambda_ratio(whole, height),
        minimum_film=found.minimum_thickness,
        contact_area=0.0 if contact is None else contact.area,
        evaluations=balance.films,
        contact_solves=balance.contacts,
        imbalance=balance.imbalance,
        oil_imbalance=balance.oil_imbalance,
        oil=oil,
        patch_film=seen,
        balance_slope=balance.slope,
        continuation=continuation(film.speeds, balance, setup.load, wholes[0], initial),
        status=_status(balance.status, forces),
        grid=setup.grid,
        boundary_friction=_told(setup, forces),
        contact_temperature=None if forces.heat is None else forces.heat.mean,
        flash_temperature=None if forces.heat is None else forces.heat.maximum,
        oil_on_contact=covered,
        regime=balance.regime,
        notes=balance.notes
        + validity_notes(friction, forces, found, whole, setup)
        + coupling_notes(forces, rough.traction, setup)
        + (() if forces.heat is None else tuple(note for note in forces.heat.notes if note not in balance.notes))
        + oil_notes([oil])
        + covered_notes([(friction, covered)]),
    )


def _seen(film: PatchFilm, setup: MixedSetup) -> PatchFilm:
    """The film as the rough patch sees it, without what it was sampled from."""
    film = dataclasses.replace(film, solution=None)
    if not setup.repeated_cell:
        return film
    from bem.friction.repeated_cell import at_centre

    return at_centre(film)


def _separation(film: PatchFilm, setup: MixedSetup) -> FloatArray:
    """Of surfaces that a film (as the patch sees it) keeps apart, on the middle line (nx,) [m]."""
    return np.broadcast_to(middle_line(film.thickness), setup.grid.shape[:1])


def _status(of_balance: Status, forces: Forces) -> Status:
    """That of the balance, or of the heat in the contact where only that did not converge."""
    return of_balance if of_balance is not Status.CONVERGED or forces.heat is None else forces.heat.status


def _told(setup: MixedSetup, forces: Forces) -> BoundaryFrictionGiven:
    """Boundary friction as it is, at the contact's temperature where it depends on that."""
    heat = forces.heat
    return heat.law if heat is not None and heat.law.needs_temperature else setup.boundary_friction
