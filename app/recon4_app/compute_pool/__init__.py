"""The compute pool: short heavy work for the pages, in confined child processes.

The server parses no file of a user: all code that opens one runs here, in a child that can read and
write only what its `FileAccess` names and that has no network. A child returns JSON of the declared
type, never a pickle, so that one taken over by a hostile file cannot attack the server.

This file imports nothing: every child starts with it.
"""
