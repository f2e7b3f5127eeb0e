"""The rigid beam: the adaptive solver's error follows its tolerance."""

import numpy as np

from stylobate.column import Column, Joint
from stylobate.constants import g
from stylobate.models.rigid_beam import adaptive as rigid_beam_adaptive
from stylobate.models.rigid_beam.model import RigidBeam
from stylobate.motion import Motion
from stylobate.simulate import simulate

#: So soft and tough that the joints stay closed: linear vibration.
JOINT = Joint(normal_stiffness=1e8, shear_stiffness=5e7)
COLUMN = Column.tapered(height=2.0, bottom_width=1.5, top_width=1.2, drums=3, density=2000.0, joint=JOINT)


def test_adaptive_error_follows_its_tolerance(monkeypatch):
    # Order 8: the error falls with the tolerance, the steps grow by its eighth root only. With wide tolerances the limit of
    # stability sets the step, and the error there is one of rounding in the fastest modes: no order shows in it.
    smooth = Motion(2e-4, np.sin(np.arange(1601) * 2e-4 * 9.0), factor=0.3 * g)
    reference = simulate(COLUMN, smooth, RigidBeam(time_step=2e-4)).residual_top_displacement
    errors, steps = [], []
    tolerances = (1e-4, 1e-6, 1e-8)
    for tolerance in tolerances:
        monkeypatch.setattr(rigid_beam_adaptive, "RELATIVE_TOLERANCE", tolerance)
        monkeypatch.setattr(rigid_beam_adaptive, "ABSOLUTE_TOLERANCE", tolerance * 1e-3)
        response = simulate(COLUMN, smooth, RigidBeam(solver="adaptive"))
        errors.append(abs(response.residual_top_displacement / reference - 1.0))
        steps.append(response.steps)
    assert (np.array(errors) < 100.0 * np.array(tolerances)).all()
    assert errors[2] < 0.2 * errors[1]
    assert steps[2] < 20 * steps[0]
