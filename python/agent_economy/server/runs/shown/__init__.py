"""What pages show of a run beside its frames, as data.

Each subject has a file, and a line in `subjects`.
"""
