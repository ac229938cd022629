"""The warden: the only process with sockets to robots.

It imports the standard library only, never waits, and applies `rules` 50 times per second.
"""
