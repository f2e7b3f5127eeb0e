"""Columns in company: the same column alone, under architraves, in a row and in a corner, shaken by the same records."""
