"""Strong-motion records of any network: one function that reads them, in SI units, with directions and provenance.

It reads with stylobate, to which it gives its formats by an entry point, and to ObsPy those that ObsPy lacks.
"""

from .record import Channel, Record, read

__all__ = ["Channel", "Record", "read"]
