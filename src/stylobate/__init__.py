"""stylobate: will this freestanding ancient column stand the shaking?

The public names are those of ``__init__.pyi``, and those that installed packages add (``added.py``). Each is loaded when
it is first used, so that importing the package is cheap.
"""

import lazy_loader

from .added import with_added
from .version import __version__ as __version__

__getattr__, __dir__ = with_added(__name__, lazy_loader.attach_stub(__name__, __file__))
