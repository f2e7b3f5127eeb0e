"""``python -m stylobate``: the command line where its script is not on the path."""

from .cli.start import main

main()
