"""The questions of studies, one file each: the runs that they need, and their answers.

A question has the methods of the others, and:

Attributes:
    requirement: What a run must meet; None if the question is about the merit.
    quantity: The column of what is recorded of each run.
    columns: Columns that an answer uses besides, of those that the simulator has.
    part: Part of the allowed error for the intervals of one quantity: see `Evidence`.
    typical: The column whose median selects the typical run.
    shown_leaders: Which of the leaders the display of a running study shows.
    certifies: Whether its procedure certifies configurations.
    counts_quarantined: Whether a run without an outcome is recorded, as not met.
"""
