"""Distinct elements in space: laws of round faces, exact rotation, lanes of drums, and what is looked at between steps."""
