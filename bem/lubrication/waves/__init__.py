"""Rough films by waves: how the waves of both surfaces' roughness leave a film and its pressure, without marching.

Roughness of small amplitude changes film and pressure linearly, so that each of its waves can be followed alone. Inside
the contact, where the oil is stiff and the smooth film flat, a wave exp(i(kx x + ky y - kx u_j t)) of a body with the
speed u_j leaves two waves (Greenwood and Morales-Espejel, Proc. IMechE J 208 (1994) 121; Hooke and Venner, Proc. IMechE
J 214 (2000) 439; Morales-Espejel and Brizmer, Tribol. Trans. 54 (2011) 625, eq. 5-8):

1. The *particular* wave moves with the surface (`plateau`): oil of high viscosity that slides against it flattens it,
   except for what the oil's compression leaves.
2. The *complementary* wave moves with the oil, at the mean speed, and has kx u_j / u in place of kx. The inlet
   generates it (`inlet`): the roughness modulates the flow there. In pure rolling both waves are one, whose amplitude
   is the "amplitude reduction" of the literature.

`ripples.film_ripples` sums the waves of both surfaces to fields of film and pressure; `flattening` gives load sharing
the heights that they leave. The originals of the papers above
could not be read: the equations here are derived anew, from Reynolds' equation, half-spaces and the Ertel-Grubin inlet,
without constants fitted to solutions (of two lengths of the inlet, one was chosen on some: `ripples.plateau_of`).
They are compared with figures of Greenwood and Morales-Espejel, with the table of Venner, Couhier, Lubrecht and
Greenwood (1997), with linear solutions of the whole contact, and with marches (tests/lubrication/test_waves.py,
reports/experiments/wave_ripples.py).

Cost: a table of 1000 waves of the inlet for each speed of a body over the mean speed (0.1 s, cached), then
FFTs of the patch.
"""

from typing import TYPE_CHECKING

from bem.startup.lazy import loader

if TYPE_CHECKING:
    from bem.lubrication.waves.ripples import FilmRipples, film_ripples

__all__ = ["FilmRipples", "film_ripples"]

__getattr__ = loader(__name__, {"ripples": ["FilmRipples", "film_ripples"]})
