"""stylobate: will this freestanding ancient column stand the shaking?"""

__version__ = "0.1.0"
