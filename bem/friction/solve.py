"""Public functions of mixed lubrication: one speed, a Stribeck curve, and the difference of two curves.

`solve_setup` assembles one point: film model, warm start, load sharing, comparison of oil volumes, notes.
"""

from __future__ import annotations

import dataclasses
import difflib
import inspect
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from bem.errors import InputError, Status
from bem.friction.balance import Regime
from bem.friction.boundary import BoundaryFrictionGiven
from bem.friction.continuation import continuation_from, start_from_solution
from bem.friction.film import PatchFilm, middle_line
from bem.friction.forces import Forces
from bem.friction.line_film import SolvedLineFilm
from bem.friction.load_sharing import LoadSharing, SharedLoad
from bem.friction.models import SolvedFilms, films_of
from bem.friction.oil_sensitivity import OilVolumeSensitivity, oil_volume_sensitivity
from bem.friction.oil_volume import OilVolume
from bem.friction.result_notes import coupling_notes, oil_notes, oil_on_contact_notes, validity_notes
from bem.friction.setup import FILM_CELLS, MixedSetup
from bem.friction.solution import MixedSolution
from bem.grid import FloatArray, Grid
from bem.lubrication import FilmSolution, Lubricant
from bem.lubrication.flow_factors import WallFactors
from bem.lubrication.line.case import check_entrainment
from bem.lubrication.line.state import without_factors
from bem.lubrication.supply import Supply
from bem.materials import Body
from bem.notes import Note
from bem.plausibility import body_arguments, lubricant_arguments, notes_on_arguments

if TYPE_CHECKING:
    from bem.lubrication import PointFilmSolution


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
    initial: MixedSolution | None = None,
    flow_factors: WallFactors | str = "off",
    oil_volume: OilVolume | str = OilVolume.LOADED,
    supply: Supply | float | None = None,
    thermal: str = "off",
    film_modulus: float | None = None,
) -> MixedSolution:
    """Return the friction of a rough cylinder, ball or ellipsoid on a flat in mixed lubrication.

    Parameters
    ----------
    height : (nx, ny), roughness of both surfaces together [m], out of the flat; its mean does not matter.
    grid : of the rough patch, centred under the cylinder, free along x and periodic along y. Its length along y is one
        slice of the contact. Under a ball the patch is free and holds the contact. Under both it may be periodic along
        x and y, a cell of the roughness that repeats over the whole contact (`bem.friction.homogenised_contact`), with
        `oil_volume` "loaded".
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
    tolerance : largest imbalance of the oil, mean opening over mean film thickness less one where oil is counted, and
        of the load, (F_film + F_contact - load) / load. The search closes the imbalance of the oil; each of its trials
        shares the load exactly, up to the tolerances of the solvers. Two cases are exceptions: surfaces at the hardness
        that cannot carry their part, and an opening that jumps at one load.
    film_points : nodes of the line film's mesh.
    film_cells : cells of a ball's film along an axis.
    contact_model : "coupled" (rough half-space), or "uncoupled" (every summit a Hertz sphere), the usual baseline.
    asperity_separation : distance of the mean planes for uncoupled asperities: "volume" keeps the volume of oil between
        the surfaces, cut where they overlap; "film" is the film thickness itself.
    separation : rule for the distance of the mean planes, which `MixedSolution.separation` holds. "volume" keeps the
        volume of oil between the surfaces (`oil_volume`). "film": the undeformed mean planes are as far apart as the
        central film thickness, for coupled and uncoupled asperities alike, as in figures 5 and 6 of the thesis' paper A
        (`bem.friction.given_separation`). It needs a cylinder and a grid that is periodic along x and y.
    contact_tolerance : of the rough contact.
    film_position : ascending abscissae [m] on which `film` is returned; the film's own mesh by default.
    initial : solution of a similar case, a warm start.
    flow_factors : "off", or a table of `bem.flow_factors`: roughness then changes the film too, see `solve_line_film`;
        `lambda_ratio` is that of the film between rough walls.
    oil_volume : area over which the mean opening of the rough surfaces equals the mean film thickness
        (`bem.friction.oil_volume`). "loaded": where the film carries load, weighted by its pressure; it conserves the
        flow through the loaded zone and converges with the patch's length. The whole load then deforms the film's
        bodies: their modulus is E* F_film / F, and the rough surfaces are pressed into the film pressure's part of that
        deflection. "patch": the whole patch, the thesis' choice; it follows the patch's length where nearly all oil
        lies beside the Hertz contact. "hertz": the nominal Hertz contact under the total load. With the last two a
        second balance is solved at every mixed speed whose first one converged (not with `separation` "film"):
        `MixedSolution.oil` says how far they differ from "loaded".
    supply : oil that reaches the contact, as of `solve_line_film`; of a ball a layer, without flow factors.
        `MixedSolution.film.starvation` has its effect.
    thermal : "off", "lumped" or "full": heat of the film, as of `solve_line_film`, and frictional heat of the contact
        (`bem.friction.contact_heat`), whose temperature laws of boundary friction use. Heat of the contact does not act
        back on film and balance: inlet heating alone thins a film with lumped heat. Far away both bodies have the
        temperature of the oil that arrives. The grid is free along x. "full" takes no supply and no ball.
    film_modulus : contact modulus of the film and of the Hertz contact [Pa] where it is not that of the bodies, such as
        of a thin wall in a stiff housing; needs a grid that repeats under the contact, periodic along x and y.

    Returns
    -------
    MixedSolution; friction = (F_boundary + F_film) / load, F_boundary the sum of the boundary shear stress over the
    contact (boundary_friction F_C for a coefficient), F_film the shear force of the film on the flat outside the real
    contact: cells in contact count by the fraction of them that does not touch. `status` is converged only where the
    returned film and contact carry the load and hold the oil to `tolerance`, or hold the oil to the error that the
    tightest contact leaves in the opening: contact tolerance times the standard deviation of the gap. The contact is
    solved more tightly than `contact_tolerance`, down to 1e-9, before that error is accepted. At both ends, full film
    and boundary lubrication, the oil is not tested. With heat `converged` includes temperatures that balance the film's
    heat. The film thickness itself is then uncertain, in a line contact by 5e-3, since the oil that inlet heating thins
    is found to that tolerance; under a ball the power of the viscosity is interpolated between loads, and the error may
    be larger. `notes` say where a model is outside its validity. A film with less than a tenth of the tolerance is
    boundary lubrication: the contact is solved for the rest of the load. The same holds, with a note of its own,
    where the film model ends while the film is a few molecules thick.

    Raises
    ------
    InputError : values out of range; no entrainment; a patch that is larger than `film_position` or does not cover
        the contact; film positions that do not reach the inlet. With `thermal` also during the balance: inlet heating
        that makes the oil so thin that no film can be found under the load of a trial.

    Notes
    -----
    Model of the thesis' papers A and D; the volume condition is the mean gap of the rough contact. Boundary friction
    couples into the normal displacements of the coupled contact unless the bodies are elastically alike, where it
    cancels. The flat feels it against its sliding over the cylinder; a law takes one coefficient for this coupling
    (`bem.friction.boundary`). Uncoupled asperities are not coupled.
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
        flow_factors=flow_factors,
        oil_volume=oil_volume,
        supply=supply,
        thermal=thermal,
        film_modulus=film_modulus,
    )
    solution = solve_setup(setup, height, speeds, initial)
    return dataclasses.replace(solution, notes=_notes_on_arguments(setup, solution.speeds) + solution.notes)


def _notes_on_arguments(setup: MixedSetup, speeds: tuple[float, float]) -> tuple[Note, ...]:
    """Return notes on arguments of `solve_mixed` outside their usual ranges."""
    radii = (setup.radius,) if setup.radii is None else tuple(setup.radii)
    arguments = {
        "load": ("load", setup.load),
        "radius" if setup.radii is None else "radii": ("radius", tuple(one for one in radii if one is not None)),
        "width": ("length of a body", setup.width),
        "speeds": ("speed", speeds),
        "hardness": ("hardness", setup.hardness),
        "grid": ("cell of the grid", [setup.grid.spacing[axis] for axis in setup.grid.varying_axes]),
        "boundary_friction": ("friction", setup.boundary_law.constant),
    }
    return notes_on_arguments(arguments | lubricant_arguments(setup.lubricant) | body_arguments(setup.bodies))


def stribeck_curve(speeds: Sequence[float | Sequence[float]], **as_solve_mixed: Any) -> list[MixedSolution]:
    """Return load sharing at many speeds, each started from the one before.

    Parameters
    ----------
    speeds : sliding speeds of the flat [m/s], the cylinder at rest; or pairs (u1, u2).
    **as_solve_mixed : the other arguments of `solve_mixed`.

    Returns
    -------
    One MixedSolution per speed, in the order given.

    Raises
    ------
    InputError : as `solve_mixed`, for any of the speeds before the first one is solved; no speeds; an argument that
        `solve_mixed` does not have, or one missing.
    """
    pairs = [(float(u), 0.0) if isinstance(u, (int, float, np.number)) else u for u in speeds]
    if not pairs:
        raise InputError("speeds: give at least one")
    _check_keywords(as_solve_mixed)
    for pair in pairs:
        check_entrainment(pair)
    initial, height = as_solve_mixed.pop("initial", None), as_solve_mixed.pop("height")
    setup = MixedSetup(**as_solve_mixed)
    curve: list[MixedSolution] = []
    for pair in pairs:
        initial = solve_setup(setup, height, pair, initial)
        curve.append(dataclasses.replace(initial, notes=_notes_on_arguments(setup, initial.speeds) + initial.notes))
    return curve


def _check_keywords(given: dict[str, Any]) -> None:
    """Check the keywords of `stribeck_curve` against those of `solve_mixed`.

    Raises
    ------
    InputError : a keyword that is unknown or missing.
    """
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
    """Return |f_u - f_c| / f_u of two friction curves at the speed where |f_u - f_c| is largest.

    Eq. (13) of the thesis' paper A.

    Raises
    ------
    InputError : curves at different speeds, or none.
    """
    from bem.friction.curves import relative_difference  # one speed has no curve

    if not coupled or [s.speeds for s in coupled] != [s.speeds for s in uncoupled]:
        raise InputError("largest_difference: the curves must be at the same speeds")
    return relative_difference([s.friction for s in coupled], [s.friction for s in uncoupled])


def solve_setup(
    setup: MixedSetup, height: FloatArray, speeds: Sequence[float], initial: MixedSolution | None = None
) -> MixedSolution:
    """Share the load of a set-up at one pair of speeds.

    Parameters
    ----------
    setup : what stays the same over speeds.
    height : (nx, ny) [m], sum of both surfaces, positive out of the flat.
    speeds : (u1, u2) of flat and cylinder or ball [m/s].
    initial : solution of a similar case, a warm start.

    Raises
    ------
    InputError : heights of another shape or not finite; no entrainment; film positions that do not reach the inlet.
    """
    height = setup.grid.check_field(height, "height")
    if not (initial is None or isinstance(initial, MixedSolution)):
        raise InputError(f"initial: {type(initial).__name__} is not a MixedSolution")
    films = films_of(setup, speeds, initial=None if initial is None else initial.film)
    start = start_from_solution(setup, films.speeds, initial)
    shared = LoadSharing(setup, films, films.speeds).solve(height, start)
    oil = oil_volume_sensitivity(
        setup,
        height,
        shared.balance,
        shared.whole,
        speeds=films.speeds,
        friction=shared.friction,
        before=None if initial is None else initial.oil,
    )
    return _solution(films, shared, oil, initial)


def _solution(
    films: SolvedFilms, shared: SharedLoad, oil: OilVolumeSensitivity, initial: MixedSolution | None
) -> MixedSolution:
    """Build the solution that users see."""
    setup, balance, forces = shared.setup, shared.balance, shared.forces
    contact, heat = balance.contact, forces.heat
    patch_film, returned = _film_on_patch(balance.film, setup), _returned_film(films, shared)
    return MixedSolution(
        speeds=films.speeds,
        friction=shared.friction,
        boundary_force=forces.boundary,
        film_force=forces.film,
        load=setup.load,
        contact_load=shared.contact_load,
        film_load=balance.film.load,
        film=returned,
        contact=None if contact is None else contact.solution,
        separation=_film_separation(patch_film, setup) if contact is None else contact.separation,
        lambda_ratio=shared.lambda_ratio,
        minimum_film=balance.film.minimum_thickness,
        contact_area=shared.contact_area,
        evaluations=balance.films,
        contact_solves=balance.contacts,
        imbalance=balance.imbalance,
        oil_imbalance=balance.oil_imbalance,
        oil=oil,
        patch_film=patch_film,
        balance_slope=balance.slope,
        continuation=continuation_from(films.speeds, balance, setup.load, shared.coarse_whole, initial),
        status=returned.status if shared.status is Status.CONVERGED else shared.status,
        grid=setup.grid,
        boundary_friction=_boundary_friction(setup, forces),
        contact_temperature=None if heat is None else heat.mean,
        flash_temperature=None if heat is None else heat.maximum,
        oil_on_contact=forces.on_contact / setup.load,
        regime=balance.regime,
        notes=_notes(shared, oil),
    )


def _notes(shared: SharedLoad, oil: OilVolumeSensitivity) -> tuple[Note, ...]:
    """Return the notes on one speed: of balance, friction, heat and oil."""
    setup, balance, forces = shared.setup, shared.balance, shared.forces
    notes = balance.notes
    notes += validity_notes(shared.friction, forces, balance.film, shared.whole, setup)
    notes += coupling_notes(forces, shared.rough.traction, setup)
    if forces.heat is not None:
        notes += tuple(note for note in forces.heat.notes if note not in balance.notes)
    return notes + oil_notes([oil]) + oil_on_contact_notes([(shared.friction, forces.on_contact / setup.load)])


def _returned_film(films: SolvedFilms, shared: SharedLoad) -> FilmSolution | PointFilmSolution:
    """Return the solution of the balance's film, at the abscissae of the set-up, without factorised equations."""
    setup, balance = shared.setup, shared.balance
    solution: FilmSolution | PointFilmSolution | None = balance.film.solution
    assert solution is not None
    if setup.film_position is not None:
        assert isinstance(films, SolvedLineFilm)
        negligible = balance.regime is Regime.BOUNDARY
        solution = films.resampled(balance.film, setup.film_position, negligible=negligible)
    return without_factors(solution) if isinstance(solution, FilmSolution) else solution


def _film_on_patch(film: PatchFilm, setup: MixedSetup) -> PatchFilm:
    """Return the film on the rough patch, without the solution that it was sampled from.

    A repeated cell has the film at the centre of the contact.
    """
    film = dataclasses.replace(film, solution=None)
    if not setup.repeated_cell:
        return film
    from bem.friction.homogenised_contact import film_at_centre

    return film_at_centre(film)


def _film_separation(film: PatchFilm, setup: MixedSetup) -> FloatArray:
    """Return the separation (nx,) [m] of surfaces that do not touch: the film thickness on the middle line."""
    return np.broadcast_to(middle_line(film.thickness), setup.grid.shape[:1])


def _boundary_friction(setup: MixedSetup, forces: Forces) -> BoundaryFrictionGiven:
    """Return the boundary friction, at the contact's temperature if the law depends on temperature."""
    heat = forces.heat
    return heat.law if heat is not None and heat.law.needs_temperature else setup.boundary_friction
