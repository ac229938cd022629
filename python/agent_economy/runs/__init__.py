"""Interactive runs, their outcomes, and the brains in them.

`simulation` and `classic_simulation` are runs of the two engines; `factory` creates the one that a
scenario names. `outcome` is the result of a run, `brain` a single brain without a simulation.
`python_brains`, `batch` and `commands` are brains and controllers written in Python.
"""
