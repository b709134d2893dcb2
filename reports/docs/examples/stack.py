import bem

run = bem.open_run(folder)  # the folder of the run
stress = run.dataset["stress"]  # component, depth, x, y
dlc, steel = slice(0.10005e-6, 2.10005e-6), slice(3.10005e-6, None)  # between the interfaces [m]
along = stress.sel(component="xx", depth=dlc).max()
found = {
    "dlc_max_stress_xx_Pa": float(along),
    "dlc_max_stress_xx_without_residual_Pa": float(along) + 2e9,
    "steel_max_von_mises_Pa": float(run.dataset["von_mises"].sel(depth=steel).max()),
}
print(found)
