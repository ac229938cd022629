"""Runs stepped by hand, what they return, and the brains in them.

`simulation` and `classic_simulation` are runs of the two engines (`factory` creates the one of a
scenario); `outcome` is what a run returns; `brain` is a robot's brain on its own; `python_brains`,
`batch` and `commands` are brains written in Python.
"""
