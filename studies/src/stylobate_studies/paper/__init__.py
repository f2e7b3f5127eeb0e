"""The study of Baraldi, Sarhosis and Milani, recomputed, and what it says sentence by sentence."""
