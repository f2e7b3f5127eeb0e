"""Runs of a model of somebody's own are known again by the version that its class states, and by nothing else."""

import subprocess
import sys

MODEL = """
import stylobate as st
from stylobate.campaign.digests import Hasher

class Mine(st.HousnerBlock):
    name = "mine"
    {version}

print(Hasher(Mine()).of_product("", st.__file__))
"""


def digests(version, processes=2):
    """Digest of a run of a model that states a version, in some processes."""
    script = MODEL.format(version=version)
    return [
        subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True).stdout
        for _ in range(processes)
    ]


def test_a_model_of_a_version_is_the_same_in_every_process():
    first, again = digests('version = "1"')
    (other,) = digests('version = "2"', 1)
    assert first == again != other


def test_a_model_without_a_version_is_known_again_in_its_own_process_alone():
    first, again = digests("ratio = 0.5")
    assert first != again
