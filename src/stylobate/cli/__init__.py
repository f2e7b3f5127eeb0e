"""The command line. Modules here import nothing heavy when they are loaded: ``stylobate --help`` answers at once."""
