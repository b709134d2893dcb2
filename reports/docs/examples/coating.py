import bem

run = bem.open_run(folder)  # the folder of the run
stress = run.dataset["stress"]  # component, depth, x, y
mises = run.dataset["von_mises"]
layer = slice(0, 2e-6)
below = slice(2e-6, None)
found = {
    "dlc_max_stress_xx_Pa": float(stress.sel(component="xx", depth=layer).max()),
    "dlc_foot_max_stress_xx_Pa": float(stress.sel(component="xx", depth=1.99e-6).max()),
    "interface_max_stress_xz_Pa": float(abs(stress.sel(component="xz", depth=1.99e-6)).max()),
    "dlc_max_von_mises_Pa": float(mises.sel(depth=layer).max()),
    "steel_max_von_mises_Pa": float(mises.sel(depth=below).max()),
}
print(found)
