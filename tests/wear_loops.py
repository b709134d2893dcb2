"""What tests of several wear laws ask alike: a loop that was stopped goes on to the same bits."""

import numpy as np

from bem import run_in
from bem.wear import pack_state, unpack_state


def goes_on(whole, surfaces, arguments, *, cycles, stopped):
    """The loop once more, stopped and taken up from its packed state; heights and cycles are those of `whole`."""
    states = []
    run_in(*surfaces, cycles=stopped, callback=states.append, **arguments)
    rest = run_in(*surfaces, cycles=cycles, state=unpack_state(pack_state(states[-1])), **arguments)
    assert np.array_equal(whole.lower_heights, rest.lower_heights)
    assert np.array_equal(whole.upper_heights, rest.upper_heights)
    assert np.array_equal(whole.cycles, rest.cycles)
    return rest
