"""Runs that pages watch.

A `session` connects one page to one run: `player` decides what to do next, `timeline` is the run
with its history, and `engines` contains what differs between the simulators.
"""
