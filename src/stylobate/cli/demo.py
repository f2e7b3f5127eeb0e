"""``make demo``: both columns of the paper, what stands and what falls, in pictures.

One history each under 1 Hz and 0.3 g, one pulse, and the safe-unsafe domain of 24 frequencies and 32 amplitudes, all by
distinct elements in the plane.
"""

from __future__ import annotations

import time
from pathlib import Path

from . import console
from .domain import describe as describe_domain
from .run import describe as describe_run

FOLDER = Path("demo")

#: Time after the shaking, in which most columns come near enough to rest for a verdict [s].
TAIL = 5.0


def demo(folder: Path = FOLDER) -> None:
    """Compute and draw; the last line printed is the folder of the figures."""
    from .. import plots
    from ..analysis.domain import collapse_domain
    from ..campaign.study import amplitude_range, frequency_range
    from ..column.presets import PRESETS, preset
    from ..constants import g
    from ..models.registry import make_model
    from ..motion import harmonic
    from ..motion.pulses import ricker
    from ..simulate import simulate

    started = time.perf_counter()
    model = make_model("dem2d")
    frequencies, amplitudes = frequency_range("0.33:4:24"), amplitude_range("0.05g:0.6g:32")
    with console.folder(folder):
        for name in PRESETS:
            column = preset(name)
            shaking = harmonic(1.0, 0.3 * g, 10.0)
            response = simulate(column, shaking, model, tail=TAIL)
            files = [response.save(folder / f"{name}.nc")]
            files += plots.save(plots.draw_histories(response), folder / f"{name}-histories")
            files += plots.save(plots.draw_filmstrip(response), folder / f"{name}-filmstrip")
            files += plots.save(plots.draw_joints(response), folder / f"{name}-joints")
            files += plots.save(plots.draw_energy(response), folder / f"{name}-energy")
            describe_run(response, shaking, files)
            print()
        pulse = ricker(0.6, 0.45 * g)
        response = simulate(preset("paper-12-drums"), pulse, model)
        files = plots.save(plots.draw_motion(pulse), folder / "pulse-motion")
        files += plots.save(plots.draw_histories(response), folder / "pulse-histories")
        files += plots.save(plots.draw_filmstrip(response), folder / "pulse-filmstrip")
        describe_run(response, pulse, files)
        print()
        for name in PRESETS:
            with console.progress(name) as progress:
                domain = collapse_domain(
                    preset(name), model, frequencies, amplitudes, 10.0, tail=TAIL, progress=progress
                )
            if not domain.complete:
                raise console.Interrupted("interrupted; the domain is not drawn.")
            files = [domain.save(folder / f"{name}-domain.nc"), domain.save(folder / f"{name}-domain.csv")]
            files += plots.save(plots.draw_domain(domain), folder / f"{name}-domain")
            describe_domain(domain, files)
            print()
    print(f"{time.perf_counter() - started:.0f} s; figures and data are in")
    print(folder.resolve())


if __name__ == "__main__":
    demo()
