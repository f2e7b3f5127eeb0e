"""Statics: limit analysis and pushover of rigid blocks."""
