"""Runs that pages watch.

A `session` connects one page to one run: `player` decides what to do next, `timeline` is the run
with its past, and `engines` says what is drawn of it.
"""
