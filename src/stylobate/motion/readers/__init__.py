"""Record files of any network: one registry recognises the format from the content and reads it."""

from .registry import FORMATS, Format, read_motion

__all__ = ["FORMATS", "Format", "read_motion"]
