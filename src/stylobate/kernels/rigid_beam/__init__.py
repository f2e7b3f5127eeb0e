"""The rigid beam: moment-rotation laws and the step over lanes."""
