"""Analyses that rest on many runs, or on the statics of a column."""
