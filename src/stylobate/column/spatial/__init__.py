"""Assemblies in space: bodies of any convex parts, the joints where their faces touch, and their files."""
