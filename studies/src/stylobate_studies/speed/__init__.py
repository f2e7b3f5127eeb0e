"""Speed of the engines on this machine."""
