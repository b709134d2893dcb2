from bem import Body, Grid, Material, displacement_operator, solve_contact, subsurface_stress, von_mises

steel = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3, hardness=6e9)
grid = Grid((64, 64), (1e-6, 1e-6))
gap = (grid.x[:, None] ** 2 + grid.y[None, :] ** 2) / (2 * 10e-3)  # a ball of 10 mm radius
bodies = (Body(steel), Body(steel))
solution = solve_contact(gap, displacement_operator(grid, bodies), load=1.0)
stress = subsurface_stress(solution.pressure, grid, bodies[0], depths=[0.0, 5e-6], friction=0.1)
print(solution)
print(von_mises(stress).max())
