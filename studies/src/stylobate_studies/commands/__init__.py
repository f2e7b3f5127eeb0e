"""The commands of the studies, which the command line of stylobate finds by its entry points."""
