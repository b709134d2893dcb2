"""Friction of oils computed for the conditions of published measurements.

    python -m reports.experiments.friction_measured

Some half an hour on one core. No constant is fitted to these measurements: the oils have the constants of their bases
(`bem/lubrication/rheology.toml`). The result is stored in `reports/results/friction_measured.json`, which
`reports.friction` holds against the measurements.
"""

from __future__ import annotations

import math
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from bem import Lubricant, solve_line_film
from bem.elements.answer import friction_power
from bem.elements.contact import ElementContact
from bem.elements.element import Element, element_template, load_element
from bem.elements.running import POINTS, run_contact
from bem.errors import InputError, Status
from bem.grid import FloatArray
from bem.lubrication.oil_scatter import oil_scatter
from bem.lubrication.oils.catalogue import correlation, oil_from_viscosities
from bem.lubrication.oils.oil import Oil
from bem.lubrication.results import FilmSolution
from bem.lubrication.viscosity import ViscosityLaw
from bem.materials import CATALOGUE, Body
from reports.experiments.kept import keep, result_of, rounded

RESULT = result_of("friction_measured")
STEEL, MODULUS = Body(CATALOGUE["steel-52100"].material), 115.5e9
CELSIUS = 273.15

BASES = ("mineral", "pao", "ester", "pag")
PLACES = 11
"""Places on the path of contact of the gear pair."""
GEAR_ROUGHNESS = 350e-9
"""Rms height of both flanks together [m]: Ra 0.2 um of each in Arana et al. (2019), table 4, Rq 1.25 Ra."""
ROUGHNESSES = (500e-9, 350e-9, 250e-9, 150e-9)
"""Rms heights of the experiment on roughness [m], from ground to run-in and polished flanks."""
GEAR_BOUNDARY = 0.065
"""Friction coefficient of the flanks in boundary lubrication, measured at the lowest speed: Arana et al. (2019)."""
SEEDS = ((11, 12), (21, 22))
"""Of the random surfaces of both flanks."""

DISC_RADIUS, DISC_PRESSURE, DISC_INLET = 0.02, 1e9, 60.0
"""Twin discs of 80 mm diameter [m], Hertz pressure [Pa], oil [degC]: Mann (1995) in Arana et al. (2019)."""
SPEEDS, SLIPS = (2.0, 4.0, 8.0, 16.0), (0.02, 0.05, 0.1)
OTHER_ALPHA = (("pag", 17.6 / 15.24), ("ester", 1.0))
"""Largest factor of the pressure-viscosity coefficient: 17.6 1/GPa of a copolymer of ethylene and propylene oxide of
0.204 Pa s at 30 degC (Stachowiak and Batchelor, table 2.3) over the catalogue's correlation."""
TEMPERATURES = (40.0, 60.0, 80.0, 100.0)


@dataclass(frozen=True)
class MannOil:
    """Oil of Mann's measurements: table 2 (viscosities [m^2/s], limiting coefficient) and table 3 (alpha over pressure)
    of Arana et al. (2019)."""

    base: str
    viscosities: tuple[float, float]
    limiting: float
    a: tuple[float, float]
    b: tuple[float, float]

    def oil(self, name: str) -> Oil:
        """The oil with its measured viscosities, all else that of its base."""
        points = dict(zip((40.0 + CELSIUS, 100.0 + CELSIUS), self.viscosities, strict=True))
        return oil_from_viscosities(points, name=name, base=self.base)

    def modulus(self, temperature: float) -> tuple[float, float]:
        """A [Pa] and B of ln(mu/mu0) = p/(A + B p) at a temperature [K]."""
        return self.a[0] + self.a[1] * temperature, self.b[0] + self.b[1] * temperature


MANN = {
    "N100": MannOil("naphthenic", (97.9e-6, 8.61e-6), 0.053, (-7.23e7, 3.48e5), (5.00e-3, -1.83e-5)),
    "M100": MannOil("mineral", (96.0e-6, 10.6e-6), 0.047, (-2.28e7, 2.26e5), (-68.20e-3, 27.68e-5)),
    "PAO100": MannOil("pao", (94.1e-6, 14.0e-6), 0.035, (-5.73e7, 3.90e5), (-39.50e-3, 23.54e-5)),
}


def gear_pair(base: str, roughness: float, speed: str = "2250 rpm") -> Element:
    """FZG-C gears in ISO VG 100 of a base at 90 degC, with the law of base oils."""
    text = (
        element_template("gear-pair")
        .replace("points = 41", f"points = {PLACES}")
        .replace('"500 nm"', f'"{1e9 * roughness:.6g} nm"')
    )
    text = text.replace('"2250 rpm"', f'"{speed}"') + f'base = "{base}"\n'
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "gears.toml"
        path.write_text(text, encoding="utf-8")
        return load_element(path)


def film_loss(base: str) -> dict[str, Any]:
    """Friction power of the gear mesh without asperities, as `bem element --running` has it [W], its mean coefficient,
    and both scatters from the oil."""
    element = gear_pair(base, GEAR_ROUGHNESS)
    runs, scatters = [], []
    for contact in element.found.contacts:
        run = run_contact(element, contact)
        if not run.converged:
            raise ArithmeticError(f"gear pair, {base}: no film at {contact.name}")
        runs.append(run)
        scatters.append(_place_scatter(element, contact) if contact.slide_roll_ratio else (0.0, 0.0))
    power, slid = friction_power(element, runs).film, _slid_power(element)
    down, up = (_mean_over_sliding(element, values) for values in zip(*scatters, strict=True))
    return {"power": power, "coefficient": power / slid, "down": down, "up": up, "sliding_power": slid}


def _slid_power(element: Element) -> float:
    """Return load times sliding speed of all pairs of teeth in mesh, mean over the path of contact [W]."""
    found = element.found
    return found.mean(lambda one: one.load * abs(one.speeds[0] - one.speeds[1])) * found.at_once


def _mean_over_sliding(element: Element, values: Sequence[float], places: Sequence[float] | None = None) -> float:
    """Return the mean of a value over the path of contact, weighted by load times sliding speed.

    values : at the places, by default those of all contacts; linear between them.
    """
    found = element.found
    at = [one.place for one in found.contacts] if places is None else places

    def weighted(one: ElementContact) -> float:
        return one.load * abs(one.speeds[0] - one.speeds[1]) * float(np.interp(one.place, at, values))

    return found.mean(weighted) * found.at_once / _slid_power(element)


def _place_scatter(element: Element, contact: Any) -> tuple[float, float]:
    """Scatter of the film's friction at one place of the gear mesh."""
    from bem.kinds.traction.run import case_of
    from bem.kinds.traction.scene import TractionScene
    from bem.scenes.load import load_scene

    scene = load_scene(element.scene(contact, "traction"))
    assert isinstance(scene, TractionScene)
    assert element.model.oil is not None
    found = oil_scatter(case_of(scene).on(POINTS), element.model.oil.build())
    return found.down, found.up


def mixed_loss(base: str, roughness: float, seeds: tuple[int, int]) -> dict[str, Any]:
    """Mean coefficient of the gear mesh with film and asperities sharing the load."""
    from bem.friction.solve import solve_setup
    from bem.kinds.friction.scene import FrictionScene, resolve
    from bem.scenes import build
    from bem.scenes.load import scene_from_table

    element = gear_pair(base, roughness)
    places, friction, touching, downs, ups = [], [], [], [], []
    for contact in element.found.contacts:
        if abs(contact.slide_roll_ratio) < 1e-3:
            continue
        table = element.scene(contact, "friction")
        table["contact"]["boundary_friction"] = GEAR_BOUNDARY
        scene = resolve(scene_from_table(table))
        assert isinstance(scene, FrictionScene)
        grid = build.grid_of(scene.grid)
        lower, upper = (
            build.heights_of(getattr(scene, body).surface, grid, seed, lambda text: None)
            for body, seed in zip(("lower", "upper"), seeds, strict=True)
        )
        setup = scene.curve_setup("off")
        own = solve_setup(setup, lower + upper, scene.speeds.build()[0], None)
        if own.status is not Status.CONVERGED:
            raise ArithmeticError(f"gear pair, {base}: no balance at {contact.name}")
        film_share, scatter = own.film_load / own.load, (0.0, 0.0)
        if isinstance(own.film, FilmSolution) and own.film_load > 0:
            of_film = oil_scatter(own.film, scene.oil.build())
            scatter = film_share * of_film.down, film_share * of_film.up
        places.append(contact.place)
        friction.append(abs(own.friction))
        touching.append(1 - film_share)
        downs.append(scatter[0])
        ups.append(scatter[1])
    return {
        name: _mean_over_sliding(element, values, places)
        for name, values in (("coefficient", friction), ("touching", touching), ("down", downs), ("up", ups))
    }


def gears() -> dict[str, Any]:
    """Losses of the FZG-C pair: film alone, mixed with two pairs of random surfaces, and over the roughness."""
    out: dict[str, Any] = {"film": {}, "mixed": {}, "roughness": {}}
    for base in BASES:
        out["film"][base] = film_loss(base)
        pairs = [mixed_loss(base, GEAR_ROUGHNESS, seeds) for seeds in SEEDS]
        first = {key: 0.5 * (pairs[0][key] + pairs[1][key]) for key in pairs[0]}
        out["mixed"][base] = first | {"numerical": 0.5 * abs(pairs[0]["coefficient"] - pairs[1]["coefficient"])}
        print("gears", base, out["film"][base], out["mixed"][base], flush=True)
        out["roughness"][base] = {
            f"{1e9 * rms:.0f}": (pairs[0] if rms == GEAR_ROUGHNESS else mixed_loss(base, rms, SEEDS[0]))["coefficient"]
            for rms in ROUGHNESSES
        }
        print("roughness", base, out["roughness"][base], flush=True)
    return out


def roller(
    lubricant: Lubricant,
    speed: float,
    slip: float,
    pressure: float = DISC_PRESSURE,
    radius: float = DISC_RADIUS,
    points: int = 600,
    thermal: str = "lumped",
) -> FilmSolution:
    """Film of a steel line contact at a Hertz pressure [Pa], mean speed [m/s] and slide-to-roll ratio.

    Raises
    ------
    ArithmeticError : no film.
    """
    found = solve_line_film(
        load=math.pi * radius * pressure**2 / MODULUS,
        radius=radius,
        contact_modulus=MODULUS,
        speeds=(speed * (1 + 0.5 * slip), speed * (1 - 0.5 * slip)),
        lubricant=lubricant,
        bodies=(STEEL, STEEL),
        thermal=thermal,
        points=points,
    )
    if found.status is not Status.CONVERGED:
        raise ArithmeticError(f"no film at {speed} m/s, slide-to-roll ratio {slip}")
    return found


def traction(lubricant: Lubricant, speed: float, slip: float, **asked: Any) -> dict[str, Any]:
    """Coefficient of sliding friction of a roller, its scatter from the oil and its numerical error: the difference to
    full heat is the model's, that to half the points the mesh's."""
    found = roller(lubricant, speed, slip, **asked)
    scatter = oil_scatter(found, lubricant)
    coarse = oil_scatter(roller(lubricant, speed, slip, **(asked | {"points": 300})), lubricant).friction
    return {
        "coefficient": scatter.friction,
        "down": scatter.down,
        "up": scatter.up,
        "numerical": abs(scatter.friction - coarse),
        "temperature": (found.mean_temperature or math.nan) - CELSIUS,
    }


def arana(oil: MannOil, film: FilmSolution, lubricant: Lubricant, speed: float, slip: float, inlet: float) -> float:
    """Coefficient of friction by eq. 13 of Arana et al. (2019), which describes Mann's discs within 0.005.

    Eyring's stress is 2 Lambda / alpha with alpha at Hertz' pressure, viscosity that at the mean pressure, both at the
    film's temperature, which flash and film heat raise (eq. 26 to 28). The central film is that of `film`; bodies are
    as warm as the oil.

    inlet : temperature of oil and bodies [K].
    """
    mean, half = 0.25 * math.pi * DISC_PRESSURE, 2 * DISC_RADIUS * DISC_PRESSURE / MODULUS
    slide, temperature, found = slip * speed, inlet, 0.0
    steel = CATALOGUE["steel-52100"].material
    assert steel.thermal_conductivity is not None
    assert steel.thermal_diffusivity is not None
    own = oil.oil("measured")
    for _ in range(200):
        first, second = oil.modulus(temperature)
        eyring = 2 * oil.limiting * (first + second * DISC_PRESSURE)
        viscosity = own.dynamic_viscosity(temperature) * math.exp(mean / (first + second * mean))
        newtonian = viscosity * slide / film.central_thickness
        found = min(eyring / mean * math.asinh(newtonian / eyring), oil.limiting)
        heat = found * mean * slide
        flash = 1.06 * 0.5 * heat / steel.thermal_conductivity * math.sqrt(steel.thermal_diffusivity * half / speed)
        across = film.central_thickness * heat / (8 * (lubricant.thermal_conductivity or 0.14))
        temperature += 0.5 * (inlet + flash + across - temperature)
    return found


def disc(name: str, speed: float, slip: float, inlet: float) -> dict[str, Any]:
    """Twin discs with one of Mann's oils, beside the formula that describes them; inlet [degC]."""
    oil = MANN[name]
    lubricant = oil.oil(name).at(inlet + CELSIUS, shear_law="base_oil")
    film = roller(lubricant, speed, slip)
    formula = arana(oil, film, lubricant, speed, slip, inlet + CELSIUS)
    ours = traction(lubricant, speed, slip)
    return {"oil": name, "speed": speed, "slip": slip, "inlet": inlet, "formula": formula, **ours}


def discs() -> list[dict[str, Any]]:
    """Twin discs with Mann's three oils over slide-to-roll ratio, speed and temperature."""
    cases = [(name, speed, slip, DISC_INLET) for name in MANN for speed in SPEEDS for slip in SLIPS]
    cases += [(name, 8.0, 0.1, at) for name in MANN for at in TEMPERATURES if at != DISC_INLET]
    rows = []
    for case in cases:
        rows.append(disc(*case))
        print("discs", rounded(rows[-1]), flush=True)
    return rows


def base_oil(base: str) -> dict[str, Any]:
    """Twin discs with an oil of VG 100 of a base at 8 m/s and 10 % sliding, film alone; HFC 46 for water-glycol."""
    asked: dict[str, Any] = {"shear_law": "base_oil"}
    if base == "water-glycol":
        asked |= {"temperature": 40 + CELSIUS, "pressure_viscosity": 3e-9, "viscosity_index": 200.0}
        return traction(Lubricant.of("water-glycol 46", **asked), 8.0, 0.1)
    return traction(Lubricant.of("ISO VG 100", temperature=DISC_INLET + CELSIUS, base=base, **asked), 8.0, 0.1)


def base_oils() -> dict[str, Any]:
    """Twin discs with oils of all bases."""
    out = {}
    for base in ("mineral", "naphthenic", "pao", "ester", "pag", "traction", "water-glycol"):
        out[base] = base_oil(base)
        print("base", base, rounded(out[base]), flush=True)
    return out


def trends() -> dict[str, Any]:
    """Loads at the limit in VG 320 oils; traction of a traction fluid over pressure and speed."""
    out: dict[str, Any] = {"at_limit": {}, "traction_pressure": {}, "traction_speed": {}}
    for base in ("mineral", "pao", "pag"):
        lubricant = Lubricant.of("ISO VG 320", temperature=80 + CELSIUS, base=base, shear_law="base_oil")
        film = roller(lubricant, 2.0, 0.5, pressure=0.95e9, radius=0.01)
        assert film.heat is not None
        at = np.interp(film.position, film.heat.position, film.heat.film_temperature)
        limit = np.asarray(lubricant.limiting_stress(np.maximum(film.pressure, 0), at))
        weight = np.maximum(film.pressure, 0) * np.gradient(film.position)
        share = np.abs(film.sliding_stress) / limit
        out["at_limit"][base] = float(np.sum(weight * share) / np.sum(weight))
    fluid = Lubricant.of("ISO VG 32", temperature=80 + CELSIUS, base="traction", shear_law="base_oil")
    for pressure in (1.0, 1.5, 2.0):
        out["traction_pressure"][f"{pressure:g}"] = peak(fluid, 10.0, pressure * 1e9)
    for speed in (5.0, 20.0, 50.0):
        out["traction_speed"][f"{speed:g}"] = peak(fluid, speed, 1.5e9)
    print("trends", rounded(out), flush=True)
    return out


def peak(
    lubricant: Lubricant, speed: float, pressure: float, slips: Sequence[float] = (0.01, 0.02, 0.04, 0.08)
) -> float:
    """Largest coefficient over the slide-to-roll ratio."""
    return max(oil_scatter(roller(lubricant, speed, s, pressure), lubricant).friction for s in slips)


def full_heat() -> list[dict[str, Any]]:
    """Lumped beside full heat at some of the discs' conditions: what the model of heat is worth."""
    rows = []
    for name, speed, slip in (("M100", 2.0, 0.05), ("M100", 8.0, 0.1), ("PAO100", 8.0, 0.1), ("M100", 4.0, 0.5)):
        lubricant = MANN[name].oil(name).at(DISC_INLET + CELSIUS, shear_law="base_oil")
        row: dict[str, Any] = {"oil": name, "speed": speed, "slip": slip}
        for heat in ("off", "lumped", "full"):
            try:
                row[heat] = oil_scatter(roller(lubricant, speed, slip, thermal=heat, points=400), lubricant).friction
            except (ArithmeticError, InputError) as error:
                row[heat] = str(error)
        rows.append(row)
        print("heat", rounded(row), flush=True)
    return rows


def pressure_coefficient(base: str, alpha: float) -> dict[str, Any]:
    """Twin discs with an oil of VG 100 of a base at 8 m/s and 10 % sliding and another alpha at 60 degC [1/Pa]."""
    asked: dict[str, Any] = {"shear_law": "base_oil"}
    asked |= {"temperature": DISC_INLET + CELSIUS, "pressure_viscosity": alpha}
    found = traction(Lubricant.of("ISO VG 100", base=base, **asked), 8.0, 0.1)
    return {"base": base, "alpha": alpha, "coefficient": found["coefficient"]}


def pressure_coefficients() -> list[dict[str, Any]]:
    """Polyglycol and ester with the secant at 0.2 GPa as alpha, with alpha of the catalogue, and larger."""
    rows = []
    for base, factor in OTHER_ALPHA:
        own = Lubricant.of("ISO VG 100", temperature=DISC_INLET + CELSIUS, base=base)
        assert own.density is not None
        secant = replace(correlation(base), pressure=0.0).at(own.viscosity, own.density, 0.0)
        alphas = {secant, own.pressure_viscosity, factor * own.pressure_viscosity}
        rows += [pressure_coefficient(base, alpha) for alpha in sorted(alphas)]
    print("alpha", rounded(rows), flush=True)
    return rows


@dataclass(frozen=True)
class Modulus(ViscosityLaw):
    """ln(mu/mu0) = p/(A + B p), as measured by Mann."""

    name: ClassVar[str] = "modulus"
    first: float
    second: float

    def log_viscosity_ratio(
        self, pressure: FloatArray, viscosity: float, pressure_viscosity: float
    ) -> tuple[FloatArray, FloatArray]:
        """The formula above."""
        whole = self.first + self.second * pressure
        return pressure / whole, self.first / whole**2


def viscosity_at_pressure(pressure: float = 1e9) -> list[tuple[str, dict[str, float]]]:
    """ln(mu/mu0) at a pressure [Pa] of Mann's oils, as measured and by Roelands' law with the catalogue's alpha, at 60
    and 90 degC; alpha [1/GPa]."""
    rows = []
    for name, own in MANN.items():
        for inlet in (60.0, 90.0):
            lubricant = own.oil(name).at(inlet + CELSIUS)
            first, second = own.modulus(inlet + CELSIUS)
            row = {
                "temperature": inlet,
                "alpha_measured": 1e9 / first,
                "alpha": 1e9 * lubricant.pressure_viscosity,
                "measured": pressure / (first + second * pressure),
                "ours": float(lubricant.log_viscosity_ratio(np.array([pressure]))[0][0]),
            }
            rows.append((name, row))
    return rows


def measured_viscosity(name: str, slip: float) -> dict[str, Any]:
    """Twin discs at 4 m/s with the viscosity over pressure as Mann measured it, in place of Roelands' law."""
    own = MANN[name]
    first, second = own.modulus(DISC_INLET + CELSIUS)
    laws = {"viscosity_law": Modulus(first, second), "pressure_viscosity": 1 / first, "shear_law": "base_oil"}
    lubricant = own.oil(name).at(DISC_INLET + CELSIUS, **laws)
    return {"oil": name, "slip": slip, "coefficient": oil_scatter(roller(lubricant, 4.0, slip), lubricant).friction}


def measured_viscosities() -> list[dict[str, Any]]:
    """All three oils."""
    rows = []
    for name in MANN:
        for slip in SLIPS:
            try:
                rows.append(measured_viscosity(name, slip))
            except (ArithmeticError, InputError) as error:
                rows.append({"oil": name, "slip": slip, "coefficient": math.nan, "status": str(error)})
            print("measured viscosity", rounded(rows[-1]), flush=True)
    return rows


def ball() -> list[dict[str, Any]]:
    """The built-in Stribeck curve of a ball with another draw of its surface; that of the scene: `hot_contacts`."""
    from bem.friction.solve import solve_setup
    from bem.kinds.friction.scene import FrictionScene, resolve
    from bem.scenes import build
    from bem.scenes.load import load_scene

    scene = resolve(load_scene("stribeck-ball-on-disc"))
    assert isinstance(scene, FrictionScene)
    grid = build.grid_of(scene.grid)
    height = build.heights_of(scene.lower.surface, grid, 11, lambda text: None)
    setup, last, rows = scene.curve_setup("off"), None, []
    for speeds in scene.speeds.build():
        last = solve_setup(setup, height, speeds, last)
        rows.append(
            {
                "speed": speeds[0],
                "friction": last.friction,
                "touching": last.contact_load / last.load,
                "lambda": last.lambda_ratio,
                "status": last.status.value,
            }
        )
        print("ball", rounded(rows[-1]), flush=True)
    return rows


def main() -> None:
    """Solve, print, store."""
    found = {
        "discs": discs(),
        "base_oils": base_oils(),
        "trends": trends(),
        "full_heat": full_heat(),
        "measured_viscosity": measured_viscosities(),
        "pressure_coefficient": pressure_coefficients(),
        "ball": ball(),
        "gears": gears(),
    }
    keep(RESULT, rounded(found))


if __name__ == "__main__":
    main()
