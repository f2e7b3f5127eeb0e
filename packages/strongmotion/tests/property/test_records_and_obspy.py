"""``strongmotion.read`` and the plug-ins of ObsPy: every component of a file as the reader of motions has it."""

import io
import json
import math

import numpy as np
import pytest
from fuzz.record_files import FORMATS
from records import FOLDER, needs_folder

import strongmotion
from strongmotion.formats import FORMATS as LISTED
from stylobate.motion import read_motion
from stylobate.motion.readers import formats
from stylobate.motion.readers.registry import Format

obspy = pytest.importorskip("obspy", reason="needs ObsPy")

from strongmotion.obspy_formats import NAMES  # noqa: E402

pytestmark = pytest.mark.filterwarnings("ignore::stylobate.errors.OutOfRangeWarning")  # of motions, and of test files


@pytest.fixture(params=sorted(FORMATS))
def file(request, tmp_path):
    """A small file of each format."""
    path = tmp_path / "record.txt"
    path.write_bytes(FORMATS[request.param][0].encode("latin-1"))
    return path


def test_stylobate_has_the_formats_by_the_entry_point():
    assert formats() == LISTED
    assert all(isinstance(file_format, Format) for file_format in LISTED)


def test_every_component_is_that_of_the_motion(file):
    motion, record = read_motion(file), strongmotion.read(file)
    level = [component for component in record.components if not component.vertical]
    if math.isfinite(level[0].dt):  # else the motion is resampled
        assert np.array_equal(level[0].acceleration[: len(motion.acceleration)], motion.acceleration)
        assert level[0].dt == motion.dt
    assert record.files == ("record.txt",)
    assert record.provenance["format"] == motion.metadata["format"]
    assert sum(component.vertical for component in record.components) == (motion.vertical is not None)
    json.dumps(record.provenance, default=str)


def test_obspy_recognises_and_reads_it(file):
    record = strongmotion.read(file)
    if not all(math.isfinite(component.dt) for component in record.components):
        with pytest.raises(ValueError, match="samples at unequal times"):
            obspy.read(str(file))
        return
    stream = obspy.read(str(file))
    assert stream[0].stats._format in NAMES
    assert len(stream) == len(record.components)
    for trace, component in zip(stream, record.components, strict=True):
        assert np.array_equal(trace.data, component.acceleration)
        assert trace.stats.delta == component.dt
        assert trace.stats.channel.endswith("Z") == component.vertical
        assert trace.stats.strongmotion["unit"] == "m/s2"
    again = obspy.read(io.BytesIO(file.read_bytes()))
    assert [np.array_equal(a.data, b.data) for a, b in zip(again, stream, strict=True)] == [True] * len(stream)


def test_every_plug_in_is_a_format_that_is_read_here():
    assert set(NAMES.values()) == {file_format.name for file_format in LISTED} - {"miniSEED", "K-NET / KiK-net"}


def test_times_are_set_only_where_they_are_universal():
    from strongmotion.obspy_formats import _utc

    assert _utc("8/24/14, 10:20:33.0 UTC (GPS)") is None
    assert _utc("2014-08-24T10:20:33") is None
    assert _utc("2014-08-24T10:20:33+02:00").hour == 8


@needs_folder
def test_unequal_steps_are_refused_in_one_sentence():
    path = FOLDER / "smc_v1_LomaPrieta1989_DelValleDam_065.smc"
    with pytest.raises(ValueError, match=r"samples at unequal times.*strongmotion\.read"):
        obspy.read(str(path))
    component = strongmotion.read(path).components[0]
    assert component.time is not None
    assert component.time.shape == component.acceleration.shape
