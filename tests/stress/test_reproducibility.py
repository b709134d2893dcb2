"""The same bits over threads, over processes, and over repeats: contact, stresses, a wear loop."""

import hashlib
import os
import subprocess
import sys

import numpy as np
import pytest

from bem import Body, Grid, Material, displacement_operator, generate_surface, solve_contact, subsurface_stress
from bem.stress import von_mises_planes
from bem.threads import get_threads, one_blas_thread, set_threads

CODE = """
import hashlib, numpy as np
from bem import Body, Grid, Material, displacement_operator, generate_surface, run_in, solve_contact, subsurface_stress
from bem import threads
import sys
threads.set_threads(int(sys.argv[1]))
threads.SHARED_FROM = 1  # small fields, too
digest = hashlib.sha256()
steel = Body(Material("steel", youngs_modulus=210e9, poissons_ratio=0.3, hardness=1.8e9))
soft = Body(Material("soft", youngs_modulus=70e9, poissons_ratio=0.2))
for shape, periodic in (((144, 131), (True, True)), ((97, 128), (False, True)), ((113, 120), (False, False))):
    grid = Grid(shape, (1e-7, 1e-7), periodic=periodic)
    gap = -generate_surface(grid, rms_height=4e-8, correlation_length=8e-7, seed=3)
    operator = displacement_operator(grid, (steel, soft), friction=0.3)
    solution = solve_contact(gap, operator, load=5e-3, hardness=1.8e9)
    digest.update(solution.pressure.tobytes())
    digest.update(subsurface_stress(solution.pressure, grid, steel, [1e-7, 4e-7], friction=0.3).tobytes())
grid = Grid((48, 40), (1e-7, 1e-7), periodic=(False, True))
lower = generate_surface(grid, rms_height=1e-7, correlation_length=4e-7, seed=1)
upper = generate_surface(grid, rms_height=3e-8, correlation_length=4e-7, seed=2)
settings = {"grid": grid, "bodies": (steel, steel), "load": 2e-3, "depths": np.arange(12) * 95e-9, "friction": 0.16}
run = run_in(lower, upper, cycles=4, **settings)
digest.update(run.lower_heights.tobytes())
print(digest.hexdigest())
"""


def bits(threads):
    done = subprocess.run([sys.executable, "-c", CODE, str(threads)], capture_output=True, text=True, check=True)
    return done.stdout.strip()


@pytest.mark.slow
def test_the_same_bits_in_every_process_and_for_every_number_of_threads():
    first = bits(1)
    assert len(first) == 64
    assert bits(3) == first


@pytest.mark.internal
def test_the_same_bits_within_a_process_over_threads_and_repeats():
    body = Body(Material("steel", youngs_modulus=210e9, poissons_ratio=0.3))
    grid = Grid((160, 150), (1e-7, 1e-7), periodic=(False, True))
    gap = -generate_surface(grid, rms_height=4e-8, correlation_length=8e-7, seed=3)
    operator = displacement_operator(grid, body)
    before, digests = get_threads(), set()
    try:
        for threads in (1, 2, 3, 1):
            set_threads(threads)
            solution = solve_contact(gap, operator, load=5e-3)
            depths = [1e-7, 5e-7, 9e-7, 0.0, 2e-6]
            stress = subsurface_stress(solution.pressure, grid, body, depths, friction=0.2)
            tractions = 0.2 * solution.pressure * np.array([0.6, 0.8])[:, None, None]
            planes = [
                plane.tobytes() for plane in von_mises_planes(solution.pressure, grid, body, depths, traction=tractions)
            ]
            digests.add(hashlib.sha256(b"".join([solution.pressure.tobytes(), stress.tobytes(), *planes])).hexdigest())
    finally:
        set_threads(before)
    assert len(digests) == 1
    assert np.isfinite(solution.residual)


FILM = """
import hashlib
from bem import Lubricant, solve_line_film
oil = Lubricant(0.05, pressure_viscosity=2e-8)
film = solve_line_film(load=6e4, radius=0.01, contact_modulus=1.15e11, speeds=(1.0, 0.5), lubricant=oil, points=1000)
print(hashlib.sha256(film.pressure.tobytes() + film.thickness.tobytes()).hexdigest())
"""


def test_bits_do_not_depend_on_the_threads_of_linear_algebra():
    """A script of one's own and the command line differ in what the environment says."""
    found = set()
    for threads in ("1", "2", "4"):
        environment = {**os.environ, "OPENBLAS_NUM_THREADS": threads, "OMP_NUM_THREADS": threads}
        done = subprocess.run([sys.executable, "-c", FILM], env=environment, capture_output=True, text=True, check=True)
        found.add(done.stdout)
    assert len(found) == 1


@pytest.mark.internal
def test_linear_algebra_has_its_threads_back_afterwards():
    from threadpoolctl import threadpool_info, threadpool_limits

    def counts():
        return [one["num_threads"] for one in threadpool_info() if one["user_api"] == "blas"]

    with threadpool_limits(2, user_api="blas"):
        before = counts()
        assert set(one_blas_thread(counts)()) == {1}
        assert counts() == before
