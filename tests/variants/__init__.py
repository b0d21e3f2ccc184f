"""Recordings drawn at random from what drivers in the field do, and what they must give."""
