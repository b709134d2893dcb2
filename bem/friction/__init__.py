"""Mixed lubrication: load sharing between oil film and rough contact, the Stribeck curve, boundary friction.

Film and rough contact carry the load in parallel (Johnson, Greenwood and Poon, *Wear* 19, 1972, 91; papers A and D of
the thesis). The film is that between smooth surfaces under its part of the load F_film. The rough surfaces are pressed
together by the rest. Their mean opening must equal the mean film thickness, both taken over the area where oil is
counted. The parts of one point of a Stribeck curve, `solve.solve_mixed`; in code the warm start (4) comes before the
contact model (3):

1. `setup.MixedSetup` checks the arguments, `solve` the heights, speeds and start. `smooth` has the contact of the
   smooth bodies: half-axes and undeformed gap. `oil_volume` averages film and opening over the patch weighted by the
   film pressure (default), over the patch (the thesis), or over the Hertz contact. With the default the whole load
   deforms the film's bodies: their modulus is E* F_film / F, and the surfaces are pressed into the film pressure's part
   of that deflection.
2. `models` chooses the film model and the contact model. A film model gives the film under any load, at a coarse and at
   the wanted accuracy (protocol `film.Film`): `line_film` and `point_film` solve films when they are requested,
   `film_table` interpolates them in load, `worn_film` corrects them for worn bodies. With `thermal` every film of the
   balance has heat of its own, which thins the film and lowers its shear stress. Line contacts: one trial with lumped
   heat solves two or three films on 250 cells, which find the viscosity of the thinned film, and that film on all nodes
   of the level (1.1 to 1.3 times the Newton steps of one isothermal film), then dense systems for the temperatures of
   200 cells; with full heat one to three times the steps and 5 to 15 temperature fields. Ball: the power of the
   viscosity that the film follows is found on 64 cells at loads three times apart and interpolated; the factor of inlet
   heating is that of the load itself, with `OilVolume.LOADED` the same under every film load, as p_h/E* is
   (`point_film.film_with_heat`).
3. The contact model gives the opening under any load (protocol `rough_contact.RoughContact`): the rough half-space or
   uncoupled `asperities`; `homogenised_contact` with `cell_law` for a cell that repeats over the contact of a ball
   (Greenwood and Tripp 1967); `given_separation` for mean planes at the central film thickness (figures 5 and 6 of
   paper A).
4. `continuation` predicts the film load from the solution at the last speed: the log odds of the film load change in
   proportion to the logarithm of the speed.
5. `load_sharing.LoadSharing` is the one driver. `solve` serves one point and its error bars; wear cycles and lives call
   its steps `balance` and `with_forces`. `solve` first finds the film under the whole load, for the lambda ratio. Cost:
   of a ball one film on all cells; of a cylinder one on 400 nodes and, where that clears the roughness, one on all.
6. `balance.share_load` finds the film load, a root in the log odds of the film load (`numerics.bracketed_root`), on the
   coarse film first. It recognises full film and boundary lubrication as ends of the range. Cost in mixed lubrication:
   three or four films, coarse and fine, each with one rough contact; six to eight without a solution at another speed.
7. `forces` sums boundary and film friction. `boundary` has the laws of boundary friction, one class each.
   `contact_heat` has the temperatures of the rough contact (Jaeger 1942) with `thermal`. It follows the balance once:
   it changes boundary friction of laws over temperature, but neither film nor balance. Cost: one or a few heat
   conductions.
8. `oil_sensitivity` repeats the balance with the default area of oil, only where another one was asked for. Cost: a
   third of the convolutions of step 6, up to as many.
9. `solve` gathers the notes of film (`lubrication.checks`), contact and balance; `result_notes` adds those on friction,
   lambda ratio, coatings and oil. `solution.MixedSolution` is the result.

`flattened` shares the load with the roughness that the film leaves, by waves. `sensitivity` has the derivatives of a
solved point with respect to its inputs.
`curves` collects the speeds of a curve, and `share_fit` fits the contact share over the lambda ratio. `asperity_array`
(figures 3 and 4 of paper A) presses an array of equal asperities and has no film.

Terms: the *whole* film is the film under the whole load; the *opening* is the mean gap between the rough surfaces where
oil is counted; the *rest* is the load less the film load; the *odds* of a film load are film load over rest. *Coarse*
without more is a film on `line_film.BALANCE_POINTS` = 400 nodes, the first level of the balance (residual 1e-5; with
heat 1e-8 on both levels). Inside one film `lubrication` has coarse meshes of its own: 160 to 400 cells for starts in
`line.continuation` (residual 1e-4), 250 on which lumped heat of a line finds the viscosity of the thinned film and
with it the thickness (to 5e-3), and 400 cells for the coupling with full heat in `thermal.coupling` (residual 1e-3).

Names are loaded at first use, so that laws of boundary friction need no solver. The package knows films, contacts and
operators, but no wear and no scene. Verified in tests/friction: the balance against its parts solved separately, the
limits of full film and boundary lubrication, random cases; and against papers A and D in the validation page.
"""

from typing import TYPE_CHECKING

from bem.startup.lazy import loader

if TYPE_CHECKING:
    from bem.friction.sensitivity import FrictionSensitivities, sensitivities
    from bem.friction.share_fit import fit_load_share
    from bem.friction.solution import MixedSolution
    from bem.friction.solve import largest_difference, solve_mixed, stribeck_curve

__all__ = [
    "FrictionSensitivities",
    "MixedSolution",
    "fit_load_share",
    "largest_difference",
    "sensitivities",
    "solve_mixed",
    "stribeck_curve",
]

__getattr__ = loader(
    __name__,
    {
        "sensitivity": ["FrictionSensitivities", "sensitivities"],
        "share_fit": ["fit_load_share"],
        "solve": ["largest_difference", "solve_mixed", "stribeck_curve"],
        "solution": ["MixedSolution"],
    },
)
