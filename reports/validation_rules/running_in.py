"""Our numbers and verdicts for the lines on paper D: running-in in mixed lubrication."""

from __future__ import annotations

from reports.validation_values import Rule, Summary, at, clear_minimum, drop, largest_drop, speed, within


def _falls_with_speed(summary: Summary) -> bool:
    """Whether the radius falls from 0.001 to 0.1 m/s, and no particles are left at 0.05."""
    falls = at(summary, "particle_equivalent_radius_nm", 0).mean > at(summary, "particle_equivalent_radius_nm", 6).mean
    return falls and at(summary, "particles_per_cycle", speed(0.05)(summary)).mean == 0.0


RULES: dict[str, Rule] = {
    "initial_less_run_in_friction_at_0_01_0_03_0": Rule(
        lambda s: ", ".join(f"{drop(s, v):.4f}" for v in (0.01, 0.03, 0.05, 0.1, 0.2, 0.4)),
        lambda s: largest_drop(s) in (0.03, 0.05) and drop(s, 0.4) == 0.0,
    ),
    "contact_load_falls_with_running_in_at_0_05_m": Rule(
        lambda s: f"{at(s, 'contact_load_initial_N', speed(0.05)(s))} to {at(s, 'contact_load_N', speed(0.05)(s))}",
        lambda s: at(s, "contact_load_N", speed(0.05)(s)).mean < at(s, "contact_load_initial_N", speed(0.05)(s)).mean,
    ),
    "sq_of_the_disk_at_0_01_m_s_nm": Rule(
        lambda s: f"{at(s, 'Sq_initial_nm', speed(0.01)(s))} to {at(s, 'Sq_final_nm', speed(0.01)(s))}",
        lambda s: at(s, "Sq_final_nm", speed(0.01)(s)).mean < at(s, "Sq_initial_nm", speed(0.01)(s)).mean,
    ),
    "particle_radius_at_0_01_m_s_nm": Rule(
        lambda s: (
            f"{at(s, 'volume_mean_radius_nm', speed(0.01)(s))} by volume, "
            f"{at(s, 'number_mean_radius_nm', speed(0.01)(s))} by number"
        ),
        lambda s: within(at(s, "volume_mean_radius_nm", speed(0.01)(s)), 200 / 1.6, 200 * 1.6),
    ),
    "radius_over_speed_0_001_to_0_4_m_s_on_the": Rule(
        lambda s: ", ".join(f"{at(s, 'particle_equivalent_radius_nm', i).mean:.0f}" for i in range(9)),
        _falls_with_speed,
    ),
    "the_same_on_half_the_cell_0_003_to_0_2_m_s_nm": Rule(
        lambda s: (
            ", ".join(f"{v:.0f}" for v in s["volume_mean_radius_nm"])
            + " by volume; "
            + ", ".join(f"{v:.0f}" for v in s["number_mean_radius_nm"])
            + " by number"
        ),
        lambda s: (
            200 / 1.6 <= at(s, "number_mean_radius_nm", speed(0.01)(s)).mean <= 200 * 1.6
            and at(s, "number_mean_radius_nm", 0).mean > at(s, "number_mean_radius_nm", 5).mean
        ),
    ),
    "initial_less_run_in_friction_on_half_the_cell": Rule(
        lambda s: ", ".join(f"{drop(s, v):.4f}" for v in (0.01, 0.02, 0.03, 0.05, 0.1, 0.2)),
        lambda s: largest_drop(s) in (0.03, 0.05),
    ),
    "friction_run_in_at_0_01_m_s_over_the_disk_s": Rule(
        lambda s: (
            ", ".join(f"{f:.4f}" for f in s["friction_run_in"])
            + f"; least at {s['hardness_of_least_friction_Pa'] / 1e9:g} GPa"
        ),
        clear_minimum,
    ),
}
