"""Reference rows of assemblies in space, each with what is computed here, by families of scenes."""
