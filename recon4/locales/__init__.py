"""Texts for people, in every language that has a folder here."""
