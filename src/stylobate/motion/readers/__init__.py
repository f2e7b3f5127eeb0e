"""Record files of any network: one registry recognises the format from the content and reads it."""

from .registry import Format, Suite, formats, read_motion, read_suite, sample_motion
from .source import Sample, samples

__all__ = ["Format", "Sample", "Suite", "formats", "read_motion", "read_suite", "sample_motion", "samples"]
