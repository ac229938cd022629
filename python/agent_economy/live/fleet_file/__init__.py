"""Reads and checks a fleet file: its schema, then what several values mean together.

`findings` collects errors and warnings with their lines, `schema` is what each value may be,
`entry` a robot of the file, `scenario_kind` what the scenario states about its kind; `team`,
`sensors`, `network`, `timing` and `area` are the checks, one subject each.
"""
