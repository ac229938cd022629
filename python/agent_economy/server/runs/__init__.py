"""Runs that pages watch.

A `connection` serves one page, and a `host` one run: a `timeline`, which is the run with its past
and is moved by a `player`, or a `live_run`, which all pages share and a `follower` moves. `engines`
contains what differs between the simulators.
"""
