"""Record files of any network: one registry recognises the format from the content and reads it."""

from .registry import Format, formats, read_motion, sample_motion
from .samples import Sample, samples
from .suite import Suite, read_suite

__all__ = ["Format", "Sample", "Suite", "formats", "read_motion", "read_suite", "sample_motion", "samples"]
