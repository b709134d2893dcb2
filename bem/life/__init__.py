"""Life of up to millions of cycles: wear by pressure and distance, a tribofilm and fatigue together, in cycle jumps.

1. A round takes two bodies through a number of positions (positions.py). In each position: solve the contact with its
   wear as a compliance (`bem.wear.ContactStep`, dry or lubricated), wear both bodies, grow and wear the tribofilm
   (surfaces.py).
2. A step of n cycles is two rounds of n/2 cycles, in which each position stands for an equal part of them. A round of n
   cycles measures their error: step doubling (march.py).
3. After each step, monitors (monitors.py) estimate the number of pieces, which is the worn volume over the mean volume
   of the pieces that a wear criterion would find, and add the fatigue damage below the surface (fatigue.py) by Dang
   Van's or Crossland's limit (fatigue_limit.py).
4. Errors of jumps, positions, cells and films add up to error bars (`bem.accuracy.life`, sampling.py).

Source: Archard (1953) at each place; tribofilm of the thesis, paper E; fatigue of Morales-Espejel and Brizmer (2011).
Cost: three rounds per step, a contact per position, two with a film defect.

Sees wear, tribofilms, load sharing, contacts and stresses; no scene, no file.

Verified in tests/life: volume, closed forms of wear, cycle by cycle, order in the tolerance, resuming, criteria on
closed stress paths.
"""
