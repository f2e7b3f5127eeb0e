"""Pictures in one style, a file for each subject. Every function returns a figure; ``save`` writes it as PNG and SVG.

A picture has a ``title`` of its own unless one is given, and a figure of its own unless a ``figure`` or
``ax`` to draw in is given.

The names are those of ``__init__.pyi``; each is loaded when it is first used, with what its results are made of.
"""

import lazy_loader

from ..added import with_added

__getattr__, __dir__ = with_added(__name__, lazy_loader.attach_stub(__name__, __file__))
