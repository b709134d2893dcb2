"""Our numbers and verdicts for the lines on paper D: running-in in mixed lubrication."""

from __future__ import annotations

from reports.validation_values import (
    READING,
    Rule,
    Summary,
    at,
    at_speed,
    clear_minimum,
    cycles_of,
    drop,
    experiment,
    falling,
    largest_drop,
    mean_of,
    quoted,
    speed,
    stored,
    within,
)

MODEL_AND_LIGHT = (200, 223 + 13)
"""Radius [nm] at 0.01 m/s: from the source's model to the upper end of the scatter of its light scattering."""


def _falls_with_speed(summary: Summary, key: str) -> bool:
    """Return True if the radius falls from each speed to the next that has particles, and none are left at 0.05 m/s."""
    found = [i for i, count in enumerate(summary["particles_per_cycle"]) if count > 0]
    return falling([at(summary, key, i) for i in found]) and at_speed(summary, "particles_per_cycle", 0.05).mean == 0.0


def _drops_as_in_the_source(summary: Summary) -> bool:
    """Largest at 0.03-0.05 m/s; none, by the digits of the source's friction, in full film."""
    gone = [v for v in summary["speed_m_s"] if 0.2 <= v <= 0.4]
    return 0.03 <= largest_drop(summary) <= 0.05 and all(abs(drop(summary, v)) < 0.005 for v in gone)


def _drops_there(summary: Summary) -> str:
    return ", ".join(f"{drop(summary, v):.3f}" for v in (0.03, 0.05, 0.1))


def _roughness_there(summary: Summary) -> str:
    return f"{at(summary, 'Sq_initial_nm')} to {at(summary, 'Sq_final_nm')} nm"


def _radius_there(summary: Summary) -> str:
    return f"{at(summary, 'volume_mean_radius_nm')} nm by volume, {at(summary, 'number_mean_radius_nm')} by number"


def _over_hardness(summary: Summary) -> str:
    friction = ", ".join(f"{value:.4f}" for value in summary["friction_run_in"])
    return f"{friction} at {', '.join(f'{1e-9 * value:g}' for value in summary['hardness_Pa'])} GPa"


def _contact_load_falls(summary: Summary) -> bool:
    """Return True if the contact load at 0.01 m/s falls by more than its repetitions scatter."""
    before, after = (at(summary, key, speed(0.01)(summary)) for key in ("contact_load_initial_N", "contact_load_N"))
    return before.mean - after.mean > (after.spread or 0.0)


def _contact_loads(summary: Summary) -> str:
    """Contact load at 0.01 m/s before and after running-in [N]."""
    before, after = (at(summary, key, speed(0.01)(summary)) for key in ("contact_load_initial_N", "contact_load_N"))
    return f"{before.mean:.3f} to {after.mean:.3f} N"


def _early_and_late(summary: Summary) -> tuple[float, float] | None:
    """Radius [nm] of a cycle's mean piece volume at 0.01 m/s: mean of the first five and of the last 50 cycles."""
    row = cycles_of(summary, "cycle_radius_nm", speed(0.01)(summary))
    return None if row is None else (mean_of(row[:5]), mean_of(row[-50:]))


def _cycles_line(summary: Summary) -> str:
    found = _early_and_late(summary)
    return "cycles not stored" if found is None else f"{found[0]:.0f} to {found[1]:.0f} nm"


def _radius_grows(summary: Summary) -> bool | None:
    found = _early_and_late(summary)
    return None if found is None else found[1] > found[0]


def _initial_share(summary: Summary, metres_per_second: float) -> float:
    """Part of the load that the surfaces carry before running-in."""
    return at(summary, "contact_load_initial_N", speed(metres_per_second)(summary)).mean / 5.5


def _late_changes(summary: Summary) -> list[float] | None:
    """Largest relative difference of any ten cycles of the second half from the last ten, speed after speed."""
    rows = summary.get("cycle_friction")
    if rows is None:
        return None
    means = [[mean_of(row[i : i + 10]) for i in range(len(row) // 2, len(row), 10)] for row in rows]
    return [max(abs(mean / tens[-1] - 1) for mean in tens) for tens in means]


def _from_120_nm(summary: Summary) -> float:
    """Largest relative difference of run-in friction over hardness from that of the scene, a disk of Sq 120 nm."""
    pairs = zip(summary["friction_run_in"], stored("hardness-optimum")["friction_run_in"], strict=True)
    return max(abs(ours / scene - 1) for ours, scene in pairs)


def _scatter_over_hardness() -> float:
    """Largest relative scatter of run-in friction over repetitions in the scene on hardness."""
    scene = stored("hardness-optimum")
    pairs = zip(scene["friction_run_in_spread"], scene["friction_run_in"], strict=True)
    return max(spread / friction for spread, friction in pairs)


SMOOTHER, ROUGHER = "hardness-disk-sq-60-nm", "hardness-disk-sq-240-nm"
CHOICES = {
    "drop-cylinder-90-patch": "with a moving disk",
    "drop-disk-0-patch": "without a skin",
    "drop-disk-90-hertz": "with oil counted over Hertz' contact",
}
CYCLES = {"running-in-cells-of-450-nm": "in the first five and the last 50 cycles"}
CELLS = {f"running-in-cells-of-{cell}-nm": f"with cells of {cell} nm" for cell in (450, 225, 113)}
DROPS = {
    "drop-as-it-is": "as it is",
    "drop-half-the-cell": "on half the cell",
    "drop-patch-of-180-um": "with the oil's volume kept over 180 instead of 90 um",
}
HALF_CELL_DROPS = {
    "drop-half-the-cell": "on half the cell",
    "drop-half-the-cell-half-the-patch": "there on 45 instead of 90 um",
}
LONGER_WAVES = {"hardness-correlation-2-um": "with a correlation length of 2 instead of 1.5 um, on one surface"}


RULES: dict[str, Rule] = {
    "initial_less_run_in_friction_at_0_01_0_03_0": Rule(
        lambda s: ", ".join(f"{drop(s, v):.4f}" for v in (0.01, 0.03, 0.05, 0.1, 0.2, 0.4)),
        _drops_as_in_the_source,
        quoted(_drops_there, DROPS),
    ),
    "all_three_regimes_are_present": Rule(
        lambda s: ", ".join(f"{_initial_share(s, v):.3g}" for v in (0.001, 0.05, 0.4)),
        lambda s: _initial_share(s, 0.001) > 0.9 > _initial_share(s, 0.05) > _initial_share(s, 0.4) == 0,
    ),
    "contact_load_falls_with_running_in_at_0_01_m": Rule(
        lambda s: (
            f"{at(s, 'contact_load_initial_N', speed(0.01)(s)).mean:.3f} to "
            f"{at(s, 'contact_load_N', speed(0.01)(s)).mean:.3f} ± {at(s, 'contact_load_N', speed(0.01)(s)).spread:.3f}"
        ),
        _contact_load_falls,
        lambda s: (
            f"{at(s, 'contact_load_initial_N', speed(0.05)(s))} to {at(s, 'contact_load_N', speed(0.05)(s))} N. Other "
            f"choices, one surface at 0.01 m/s: {quoted(_contact_loads, CHOICES)(s)}"
        ),
    ),
    "radius_over_cycles_at_0_01_m_s": Rule(
        _cycles_line,
        _radius_grows,
        quoted(_cycles_line, CYCLES),
    ),
    "radius_by_light_scattering_at_0_01_m_s": Rule(
        lambda s: f"{at(s, 'scattering_mean_radius_nm', speed(0.01)(s))}".replace("none", "not stored"),
        lambda s: (
            within(at(s, "scattering_mean_radius_nm", speed(0.01)(s)), 223 - 13, 223 + 13)
            if "scattering_mean_radius_nm" in s
            else None
        ),
        quoted(lambda s: f"{at(s, 'scattering_mean_radius_nm')} nm", CELLS),
    ),
    "no_running_in_where_the_disk_is_hard": Rule(
        lambda s: f"{s['friction_initial'][-1]:.4f} to {s['friction_run_in'][-1]:.4f}",
        lambda s: abs(s["friction_run_in"][-1] / s["friction_initial"][-1] - 1) < READING,
        quoted(
            lambda s: f"{s['friction_initial'][-1]:.4f} to {s['friction_run_in'][-1]:.4f}",
            {"hardness-frame-cylinder": "with the one", "hardness-skin-0": "with the other"},
        ),
    ),
    "sq_of_the_disk_at_0_01_m_s_nm": Rule(
        lambda s: f"{at(s, 'Sq_initial_nm', speed(0.01)(s))} to {at(s, 'Sq_final_nm', speed(0.01)(s))}",
        lambda s: at(s, "Sq_final_nm", speed(0.01)(s)).mean < at(s, "Sq_initial_nm", speed(0.01)(s)).mean,
        quoted(_roughness_there, CELLS),
    ),
    "particle_radius_at_0_01_m_s_nm": Rule(
        lambda s: (
            f"{at(s, 'volume_mean_radius_nm', speed(0.01)(s))} by volume, "
            f"{at(s, 'number_mean_radius_nm', speed(0.01)(s))} by number"
        ),
        lambda s: within(at(s, "volume_mean_radius_nm", speed(0.01)(s)), *MODEL_AND_LIGHT),
        quoted(_radius_there, CELLS),
    ),
    "radius_over_speed_0_001_to_0_4_m_s_on_the": Rule(
        lambda s: ", ".join(f"{at(s, 'particle_equivalent_radius_nm', i).mean:.0f}" for i in range(9)),
        lambda s: _falls_with_speed(s, "particle_equivalent_radius_nm"),
        quoted(
            lambda s: ", ".join(f"{value:.0f}" for value in s["volume_mean_radius_nm"]) + " nm",
            {"drop-cylinder-90-patch": "with a moving disk", "drop-disk-0-patch": "without a skin"},
        ),
    ),
    "full_film_after_running_in": Rule(
        lambda s: ", ".join(f"{at(s, 'contact_load_N', speed(v)(s)).mean:.3f}" for v in (0.03, 0.05, 0.1, 0.2)),
        lambda s: all(at(s, "contact_load_N", speed(v)(s)).mean == 0.0 for v in (0.05, 0.1, 0.2)),
        quoted(
            lambda s: f"{at(s, 'contact_load_N', speed(0.05)(s)).mean:.2f} N",
            DROPS | {"drop-disk-90-hertz": "with oil counted over Hertz' contact"},
        ),
    ),
    "two_hundred_cycles_settle_friction": Rule(
        lambda s: ", ".join(f"{100 * change:.1f}" for change in _late_changes(s) or ()) or "cycles not stored",
        lambda s: None if _late_changes(s) is None else max(_late_changes(s) or (0.0,)) < READING,
    ),
    "the_same_on_half_the_cell_0_003_to_0_2_m_s_nm": Rule(
        lambda s: (
            ", ".join(f"{v:.0f}" for v in s["volume_mean_radius_nm"])
            + " by volume; "
            + ", ".join(f"{v:.0f}" for v in s["number_mean_radius_nm"])
            + " by number"
        ),
        lambda s: (
            within(at(s, "volume_mean_radius_nm", speed(0.01)(s)), *MODEL_AND_LIGHT)
            and _falls_with_speed(s, "volume_mean_radius_nm")
        ),
        quoted(_radius_there, CELLS),
    ),
    "initial_less_run_in_friction_on_half_the_cell": Rule(
        lambda s: ", ".join(f"{drop(s, v):.4f}" for v in (0.01, 0.02, 0.03, 0.05, 0.1, 0.2)),
        _drops_as_in_the_source,
        quoted(_drops_there, HALF_CELL_DROPS),
    ),
    "friction_run_in_at_0_01_m_s_over_the_disk_s": Rule(
        lambda s: (
            ", ".join(f"{f:.4f}" for f in s["friction_run_in"])
            + f"; least at {s['hardness_of_least_friction_Pa'] / 1e9:g} GPa"
        ),
        clear_minimum,
        quoted(_over_hardness, LONGER_WAVES),
    ),
    "soft_disks_lose_the_largest_particles": Rule(
        lambda s: ", ".join(f"{value:.0f}" for value in s["volume_mean_radius_nm"]),
        lambda s: s["volume_mean_radius_nm"][0] == max(s["volume_mean_radius_nm"]),
        quoted(
            lambda s: ", ".join(f"{value:.0f}" for value in s["volume_mean_radius_nm"]) + " nm",
            {"hardness-frame-cylinder": "with a moving disk", "hardness-skin-0": "without a skin"},
        ),
    ),
    "initial_roughness_of_the_soft_body_and_hardness": Rule(
        lambda s: f"{100 * max(_from_120_nm(s), _from_120_nm(experiment(SMOOTHER))):.1f}",
        lambda s: max(_from_120_nm(s), _from_120_nm(experiment(SMOOTHER))) <= _scatter_over_hardness(),
        lambda s: (
            f"{100 * _scatter_over_hardness():.1f} %. One surface each: "
            f"{quoted(_over_hardness, {SMOOTHER: 'with Sq 60 nm', ROUGHER: 'with Sq 240 nm'})(s)}"
        ),
    ),
}
