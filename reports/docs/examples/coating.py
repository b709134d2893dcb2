import bem

run = bem.open_run(folder)  # the folder of the run
stress = run.dataset["stress"]  # component, depth, x, y
mises = run.dataset["von_mises"]
layer = slice(0, 2e-6)
below = slice(2e-6, None)
found = {
    "highest tension in the layer [Pa]": float(stress.sel(component="xx", depth=layer).max()),
    "highest tension in the layer at the interface [Pa]": float(stress.sel(component="xx", depth=1.99e-6).max()),
    "highest shear stress at the interface [Pa]": float(abs(stress.sel(component="xz", depth=1.99e-6)).max()),
    "highest von Mises stress in the layer [Pa]": float(mises.sel(depth=layer).max()),
    "highest von Mises stress in the steel [Pa]": float(mises.sel(depth=below).max()),
}
print(found)
