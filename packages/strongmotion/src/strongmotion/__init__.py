"""Strong-motion records of any network: one function that reads them, in SI units, with directions and provenance.

It reads with stylobate, to which it gives its formats by an entry point, and to ObsPy those that ObsPy lacks. Names are
loaded when they are first used: the program stylobate loads the package for its command.
"""

from typing import TYPE_CHECKING

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(__name__, submod_attrs={"record": ["Channel", "Record", "read"]})

if TYPE_CHECKING:
    from .record import Channel as Channel
    from .record import Record as Record
    from .record import read as read
