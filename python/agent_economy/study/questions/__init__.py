"""The questions of studies, one file each: the runs that they need, and their answers."""
