"""stylobate: will this freestanding ancient column stand the shaking?

The public names are those of ``__init__.pyi``. Each is loaded when it is first used, so that importing the package is
cheap.
"""

import lazy_loader

from .version import __version__ as __version__

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
