"""Forces in the joints by all models (the paper's section 2.3): while joints are closed, and while they rock."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from stylobate.column import preset
from stylobate.column.catalogue import PAPER
from stylobate.constants import g
from stylobate.messages import percent
from stylobate.motion import harmonic
from stylobate.simulate import simulate

from .cases import BEAM, BLOCKS, DEM, MODELS, SHORT
from .sentences import Statement, judged

#: Amplitudes at which all joints of the models stay closed, and at which they open [g]; one frequency [Hz].
CLOSED, ROCKING, FREQUENCY = 0.1, 0.25, 0.66

#: Times at which forces are compared [s]; the runs go a little further.
TIMES = np.arange(0.1, 3.9, 0.02)

#: Models compare within this share of the root mean square of the rigid block's force.
ALIKE = 0.1

ACTIONS = ("shear", "moment")


def differences(name: str, amplitude: float) -> dict[str, dict[str, float]]:
    """By model and action: root mean square of the difference from the rigid block, in all joints, over the block's [-]."""
    actions = {}
    for label in (BLOCKS, BEAM, DEM):
        shaking = harmonic(FREQUENCY, amplitude * g, TIMES[-1] + 0.2)
        response = simulate(preset(name), shaking, MODELS[label], output_interval=0.02, until_end=True)
        forces = response.joint_forces()
        histories = {action: getattr(forces, action).T for action in ACTIONS}
        actions[label] = {
            name: np.stack([np.interp(TIMES, forces.time, values) for values in history])
            for name, history in histories.items()
        }
    block = actions.pop(BLOCKS)
    return {
        label: {
            action: float(np.sqrt(np.mean((by[action] - block[action]) ** 2) / np.mean(block[action] ** 2)))
            for action in ACTIONS
        }
        for label, by in actions.items()
    }


def forces_statement() -> Statement:
    """The sentence, at both amplitudes."""
    far = {(name, a): differences(name, a) for name in PAPER for a in (CLOSED, ROCKING)}
    alike = {
        f"{words}, {SHORT[name]}": all(max(difference.values()) <= ALIKE for difference in far[name, a].values())
        for a, words in ((CLOSED, "closed joints"), (ROCKING, "rocking"))
        for name in PAPER
    }
    return Statement(
        "2.3 ¶2", "Interface actions of the rigid block model can be compared directly with nodal forces of the rigid beam.",
        f"shear; moment of all joints, root mean square of the difference from the rigid block over the block's, at "
        f"{FREQUENCY:g} Hz. " + " ".join(_ratios(a, {name: far[name, a] for name in PAPER}) for a in (CLOSED, ROCKING)),
        judged(all(alike.values()), alike),
        f"Taken as: within {percent(ALIKE)}. Means over 40 ms, from the motion of what stands on each joint. The beam's "
        "normal forces are those at rest. Once joints open the models move differently, and blows last milliseconds.",
    )  # fmt: skip


def _ratios(amplitude: float, far: Mapping[str, Mapping[str, Mapping[str, float]]]) -> str:
    each = ", ".join(
        f"{SHORT[name]} {label} " + "; ".join(percent(value) for value in by.values())
        for name, models in far.items()
        for label, by in models.items()
    )
    return f"{amplitude:g} g: {each}."
