"""A body of unit thermal properties."""

from bem import Body, Material


def body(conductivity=1.0, capacity=1.0, density=1.0):
    """Of unit diffusivity by default: the Peclet number of half-width 1 is half the speed."""
    return Body(
        Material(
            "solid",
            youngs_modulus=1e9,
            poissons_ratio=0.3,
            thermal_conductivity=conductivity,
            density=density,
            heat_capacity=capacity,
        )
    )


UNIT = body()
