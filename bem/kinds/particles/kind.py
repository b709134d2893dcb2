"""Kind `particles`, from its parts."""

from __future__ import annotations

from bem.kinds.particles.plan import plan
from bem.kinds.particles.record import ParticlesRecord
from bem.kinds.particles.run import run
from bem.kinds.particles.scene import ParticlesScene
from bem.scenes.kind import Kind

KIND = Kind(
    name="particles",
    title="wear particle sizes from an AFM height map",
    model=ParticlesScene,
    record=ParticlesRecord,
    plan=plan,
    run=run,
    figures=("particle-map", "particle-sizes"),
    warm_up=(("particles-afm-map", ("synthetic.shape=[256, 256]",)),),
)
