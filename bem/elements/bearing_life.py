"""Rating life of a bearing of an element's file: the ratings of the file or of its geometry, its oil and its loads."""

from __future__ import annotations

import math
from dataclasses import dataclass

from bem.elements.element import Element
from bem.elements.rating_life import (
    CONTAMINATION,
    LEAST_KAPPA,
    MOST_KAPPA,
    RELIABILITY,
    RatingLife,
    axial_factors,
    contamination_factor,
    dynamic_rating,
    equivalent_load,
    equivalent_static_load,
    fatigue_limit,
    hours,
    life_modification_factor,
    rating_life,
    reference_viscosity,
    static_rating,
)
from bem.elements.reference_life import (
    ReferenceLife,
    ball_reference_life,
    roller_reference_life,
)
from bem.elements.rolling_bearing import BearingModel
from bem.notes import Note
from bem.notes.elements import (
    KAPPA_ABOVE_FILM,
    LOAD_ABOVE_LIFE_FORMULA,
    RATING_NOT_OF_GEOMETRY,
    STATIC_LOAD_ABOVE_RATING,
)

HIGHEST_LOAD = 0.5
"""P / C up to which the formulas of ISO 281 hold."""
KAPPA_EXPONENT = 1.3
"""ISO 281 relates the viscosity ratio to the lambda ratio by kappa = lambda^1.3, approximately."""
_WELL_BELOW = 0.7
"""Fraction of kappa below which a note says that the film's own kappa is smaller: a_ISO hardly differs above."""
_RATINGS_ALIKE = 2.0
"""Factor by which a catalogue's rating may differ from that of the dimensions without a note."""
DEFAULT_CLEANLINESS = "normal"
"""Cleanliness of a bearing whose file says none."""


@dataclass(frozen=True)
class BearingLife:
    """Lives of a bearing.

    rating : basic and modified life of ISO 281. reference : life of ISO/TS 16281 with the loads of all elements.
    modified_reference : the latter with a_ISO at its reference load, of rollers slice by slice [revolutions]; None
    where a_ISO is not known. axial_factors : X and Y; None without an axial load. static_load : P_0 [N].
    static_rating : C_0 [N]. reference_viscosity : nu1 [m^2/s].
    slice_pressure : highest Hertz pressure of a slice of a roller on the inner ring [Pa]; None for balls.
    """

    rating: RatingLife
    reference: ReferenceLife
    modified_reference: float | None
    static_rating: float
    static_load: float
    reference_viscosity: float
    axial_factors: tuple[float, float] | None = None
    slice_pressure: float | None = None


def bearing_life(element: Element, viscosity_ratio: float | None = None) -> BearingLife:
    """Return the lives of a rolling bearing.

    viscosity_ratio : kappa; that of the oil's viscosity over the required one if not given.
    """
    model = element.model
    assert isinstance(model, BearingModel)
    geometry = model.geometry
    rating = model.dynamic_load_rating or dynamic_rating(geometry)
    static = model.static_load_rating or static_rating(geometry)
    limit = model.fatigue_load_limit or fatigue_limit(static, geometry)
    factors, load = None, model.load
    if model.axial_load:
        factors = model.axial_factors or axial_factors(model.axial_load, static, geometry)
        load = equivalent_load(load, model.axial_load, factors)
    dirt = model.contamination_factor
    if dirt is None:
        dirt = contamination_factor(model.cleanliness or DEFAULT_CLEANLINESS, model.pitch)
    needed = reference_viscosity(model.pitch, model.speed)
    kinematic = kinematic_viscosity(element)
    kappa = viscosity_ratio
    if kappa is None and kinematic is not None:
        kappa = kinematic / needed
    found = rating_life(
        model.rolling,
        rating=rating,
        load=load,
        viscosity_ratio=kappa,
        contamination=dirt,
        limit=limit,
        reliability=model.reliability,
    )
    pressure = None
    if model.slices is None:
        reference = ball_reference_life(geometry, rating, model.shared)
    else:
        reference = roller_reference_life(geometry, rating, model.slices)
        inner = element.found.contacts[0]
        assert reference.highest_slice is not None
        pressure = math.sqrt(reference.highest_slice * element.modulus / (math.pi * inner.radius))
    modified = None
    if kappa is not None:
        known = kappa

        def factor(load: float) -> float | None:
            return life_modification_factor(
                model.rolling, viscosity_ratio=known, contamination=dirt, limit_over_load=limit / load
            )

        modified = reference.modified(factor)
    if modified is not None:
        modified *= RELIABILITY[model.reliability]
    return BearingLife(
        found,
        reference,
        modified,
        static,
        equivalent_static_load(model.load, model.axial_load),
        needed,
        factors,
        pressure,
    )


def kinematic_viscosity(element: Element) -> float | None:
    """Return the kinematic viscosity of the element's oil [m^2/s]; None without an oil or its density."""
    if element.model.film_oil is None:
        return None
    oil = element.model.film_oil.build()
    return None if oil.density is None else oil.viscosity / oil.density


def life_of_film(element: Element, film_ratio: float | None) -> BearingLife | None:
    """Return the lives with the viscosity ratio that the solved film stands for, kappa = lambda^1.3.

    None where that is not below the ratio of the viscosities, and where one of both is not known.

    film_ratio : smallest lambda ratio of the solved films; None without roughness or films.
    """
    kappa = bearing_life(element).rating.viscosity_ratio
    if kappa is None or film_ratio is None:
        return None
    film = film_ratio**KAPPA_EXPONENT
    return bearing_life(element, film) if film < min(kappa, MOST_KAPPA) else None


def life_rows(element: Element, film_ratio: float | None = None) -> list[tuple[str, str]]:
    """Return the lives of a rolling bearing in words; `film_ratio` as in `life_of_film`."""
    model = element.model
    assert isinstance(model, BearingModel)
    life, of_film = bearing_life(element), life_of_film(element, film_ratio)
    rating, speed = life.rating, model.speed
    source = "of the file" if model.dynamic_load_rating else "from the geometry by ISO 281; a catalogue's may be higher"
    rows = [
        (
            "basic rating life",
            f"L10 = {_life(rating.basic, speed)}; C = {1e-3 * rating.dynamic_rating:.4g} kN ({source}), "
            f"P = {1e-3 * rating.load:.4g} kN{_factors(model, life)}, C/P = {rating.dynamic_rating / rating.load:.3g}",
        )
    ]
    said = _modified(model, life)
    if of_film is not None:
        assert film_ratio is not None
        name, film, film_life = f"L{100 - model.reliability}m", of_film.rating.viscosity_ratio, of_film.rating.modified
        assert film is not None
        if film_life is None:
            said = (
                f"{name} not defined: kappa {film:.2g}, for which lambda = {film_ratio:.3g} of these rough surfaces "
                f"stands, is below {LEAST_KAPPA}, where ISO 281 gives no modified life; take a thicker oil or a finer "
                f"finish. With the usual finish of bearings {said}"
            )
        else:
            said = (
                f"{name} = {_life(film_life, speed)} with kappa = {film:.3g}, for which lambda = {film_ratio:.3g} of "
                f"these rough surfaces stands. With the usual finish of bearings {said}"
            )
    rows.append(("modified rating life", said))
    said = f"L10r = {_life(life.reference.basic, speed)}"
    if life.modified_reference is not None:
        each = " with a_ISO of every slice" if life.slice_pressure is not None else ""
        modified = _life(life.modified_reference, speed)
        if of_film is not None:
            used = "not defined" if of_film.modified_reference is None else _life(of_film.modified_reference, speed)
            modified = f"{used} with the kappa of lambda ({modified} with the usual finish)"
            each = each.replace(" with", ", with")
        said += f", modified {modified}{each}"
    said += "; ISO/TS 16281, from the load of every rolling element at this clearance"
    if life.slice_pressure is not None:
        edge = f"{model.edge_words}, which L10r has as a factor" if model.edge_words else ""
        tilt = f"tilt {1e3 * model.tilt:.3g} mrad" if model.tilt else "no tilt"
        said += (
            f" and slice by slice ({model.profile} profile, {tilt}; highest slice "
            f"{1e-9 * life.slice_pressure:.3g} GPa{edge})"
        )
    rows.append(("reference rating life", said))
    rows.append(
        (
            "static safety",
            f"C0 / P0 = {life.static_rating / life.static_load:.3g}; C0 = {1e-3 * life.static_rating:.4g} kN "
            f"({'of the file' if model.static_load_rating else 'from the geometry by ISO 76'})",
        )
    )
    return rows


def life_notes(element: Element, film_ratio: float | None) -> tuple[Note, ...]:
    """Return notes on limits of the lives.

    film_ratio : smallest lambda ratio of the solved films; None without roughness or films.
    """
    model = element.model
    assert isinstance(model, BearingModel)
    life, of_film = bearing_life(element), life_of_film(element, film_ratio)
    rating, notes = life.rating, []
    for key, given, own in (
        ("dynamic_load_rating", model.dynamic_load_rating, dynamic_rating(model.geometry)),
        ("static_load_rating", model.static_load_rating, static_rating(model.geometry)),
    ):
        if given is not None and not 1 / _RATINGS_ALIKE < given / own < _RATINGS_ALIKE:
            notes.append(RATING_NOT_OF_GEOMETRY(key, given=given, own=own))
    if rating.load > HIGHEST_LOAD * rating.dynamic_rating:
        notes.append(LOAD_ABOVE_LIFE_FORMULA(ratio=rating.load / rating.dynamic_rating))
    if life.static_rating < life.static_load:
        notes.append(STATIC_LOAD_ABOVE_RATING(safety=life.static_rating / life.static_load))
    kappa, film = rating.viscosity_ratio, None if of_film is None else of_film.rating.viscosity_ratio
    if of_film is not None and kappa is not None and film is not None and film < _WELL_BELOW * min(kappa, MOST_KAPPA):
        reason = "not defined" if of_film.rating.modified is None else "shorter"
        notes.append(KAPPA_ABOVE_FILM(kappa=kappa, ratio=film_ratio, film=film, reason=reason))
    return tuple(notes)


def _factors(model: BearingModel, life: BearingLife) -> str:
    """Return in words how the equivalent load of an axial load came about."""
    if life.axial_factors is None:
        return ""
    if life.rating.load == model.load:
        return " (the radial load: the axial one is too small to count)"
    (x, y), source = life.axial_factors, "of the file" if model.axial_factors else "ISO 281"
    return f" = {x:.3g} x {1e-3 * model.load:.4g} + {y:.3g} x {1e-3 * model.axial_load:.4g} kN ({source})"


def _modified(model: BearingModel, life: BearingLife) -> str:
    rating = life.rating
    if rating.viscosity_ratio is None:
        return "not known: the kinematic viscosity is missing; give an oil by its grade or viscosities, or its density"
    needed = f"required viscosity nu1 = {1e6 * life.reference_viscosity:.3g} mm²/s"
    if rating.a_iso is None or rating.modified is None:
        return (
            f"not defined: kappa = {rating.viscosity_ratio:.3g} is below {LEAST_KAPPA} ({needed}); take a thicker oil"
        )
    if model.contamination_factor is not None:
        dirt = ""
    else:
        chosen = model.cleanliness or DEFAULT_CLEANLINESS
        low, high = CONTAMINATION[chosen][0 if model.pitch < 0.1 else 1]
        assumed = "" if model.cleanliness else ", assumed"
        dirt = f" ({chosen} cleanliness{assumed}: {low:g} to {high:g})"
    return (
        f"L{100 - model.reliability}m = {_life(rating.modified, model.speed)}; a_ISO = {rating.a_iso:.3g} with "
        f"kappa = {rating.viscosity_ratio:.3g} ({needed}), e_C = {rating.contamination:.3g}{dirt}, "
        f"C_u = {1e-3 * rating.fatigue_limit:.3g} kN"
    )


def _life(revolutions: float, speed: float) -> str:
    """Return a life in million revolutions and hours, in words."""
    return f"{_plain(1e-6 * revolutions)} million revolutions ({_plain(hours(revolutions, speed))} h)"


def _plain(value: float) -> str:
    """Return a number with three digits, its thousands apart, and powers of ten from a thousand million on."""
    if value >= 1e9:
        return f"{value:.3g}"
    rounded = float(f"{value:.3g}")
    return f"{rounded:,.0f}".replace(",", " ") if rounded >= 100 else f"{value:.3g}"
