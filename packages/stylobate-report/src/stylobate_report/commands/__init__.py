"""The commands of this package, which the command line of stylobate finds by its entry points."""
