"""The rigid beam: the model, its matrices, its lanes, its state and its verdict."""
