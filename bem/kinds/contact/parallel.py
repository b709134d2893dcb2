"""What a contact on several processes can do."""

from __future__ import annotations

from bem.distributed.spectra import responds_evenly
from bem.errors import InputError
from bem.kinds.contact.scene import ContactScene
from bem.scenes import build

HOLDS = (
    "a dry contact under contact.load, mean_pressure, hertz_pressure or approach, elastic or capped at the hardness, "
    "periodic or free, with bodies that do not relax"
)


def refuse_on_ranks(scene: ContactScene) -> None:
    """Refuse what the solver on several processes cannot do.

    Raises
    ------
    InputError : options that hold in one process only.
    """
    contact = scene.contact
    lower, upper = scene.lower.build(), scene.upper.build()
    friction = contact.friction != 0 and build.traction_couples(lower, upper, contact.friction)
    found = {
        "contact.mean_gap": contact.mean_gap is not None,
        "contact.adhesion": contact.adhesion is not None,
        "contact.times": bool(contact.times),
        "contact.sliding_speed or rolling_speed": scene.speeds is not None,
        "contact.friction that changes the gap": friction,
        "a crystal that does not respond alike on both sides of the x axis": not all(
            responds_evenly(body) for body in (lower, upper) if body is not None
        ),
        "shape.conforming": bool(scene.shape.conforming),
        "uncertain": bool(scene.uncertain),
        "accuracy": scene.accuracy is not None,
    }
    names = [name for name, there in found.items() if there]
    if names:
        raise InputError(f"--ranks: {', '.join(names)}: in one process only; allowed: {HOLDS}")
