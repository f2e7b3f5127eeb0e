"""The rigid beam: the adaptive solver's error follows its tolerance."""

import numpy as np
import pytest
from oracles import adaptive_beam

from stylobate.column import Column, Joint
from stylobate.models.rigid_beam.model import RigidBeam
from stylobate.motion import Motion
from stylobate.simulate import simulate

#: So soft that the joints stay closed, so rough that nothing slides: linear vibration.
JOINT = Joint(normal_stiffness=1e8, shear_stiffness=5e7, friction_coefficient=1.0)
COLUMN = Column.tapered(height=2.0, bottom_width=1.5, top_width=1.2, drums=3, density=2000.0, joint=JOINT)


@pytest.mark.processor
def test_adaptive_error_follows_its_tolerance(monkeypatch):
    # Free vibration, let go from a rotation under which no joint opens: nothing in it but the modes, so that the method's
    # order 8 shows. The local error is held at the tolerance, and what is left after 0.3 s is proportional to it; the
    # steps grow by the eighth root of what the tolerance falls. Under an input of straight pieces neither is to be seen:
    # there the kinks make the error, and its last digits are chance.
    still = Motion(0.32, np.zeros(2))

    def freed(tolerance):
        monkeypatch.setattr(adaptive_beam, "RELATIVE_TOLERANCE", tolerance)
        monkeypatch.setattr(adaptive_beam, "ABSOLUTE_TOLERANCE", tolerance * 1e-3)
        return adaptive_beam.run_adaptive(COLUMN, still, RigidBeam(initial_rotation=1e-5), output_interval=0.01)

    reference = freed(1e-12).top_displacement
    size = np.abs(reference).max()
    tolerances = np.array([1e-5, 1e-7, 1e-9])
    responses = [freed(tolerance) for tolerance in tolerances]
    errors = np.array([np.abs(response.top_displacement - reference).max() / size for response in responses])
    assert (errors < tolerances).all()
    assert ((30.0 < errors[:-1] / errors[1:]) & (errors[:-1] / errors[1:] < 300.0)).all()  # 100, but for whole steps
    assert responses[2].steps < 1.5 * 1e4 ** (1.0 / 8.0) * responses[0].steps
    # The solver of fixed step is another method, of order 4.
    fixed = [simulate(COLUMN, still, RigidBeam(time_step=h, initial_rotation=1e-5)) for h in (4e-4, 2e-4)]
    coarse, fine = (abs(response.top_displacement[-1] - reference[-1]) / size for response in fixed)
    assert fine < 1e-6
    assert 10.0 < coarse / fine < 25.0  # 2⁴
