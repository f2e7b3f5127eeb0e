"""Assemblies of blocks in the plane, followed step by step."""
