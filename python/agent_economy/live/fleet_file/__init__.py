"""Reads and checks a fleet file: its schema, then what several values mean together.

`findings` collects errors and warnings with their lines, `schema` is what each value may be,
`entry` a robot of the file, `scenario_kind` what the scenario states about its kind, `walls` its
obstacles, `routes` the ways between waypoints; `team`, `sensors`, `network`, `timing`, `area` and
`leg_warnings` are the checks, one subject each.
"""
