"""What ruins tell: which shaking has left them, what has not happened since, and what many monuments say together."""
