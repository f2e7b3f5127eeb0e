"""The same columns alone, under architraves, in a row and in a corner, shaken alike: the paper's sentence on top beams."""
