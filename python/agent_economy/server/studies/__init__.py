"""Studies that pages start, follow, stop and show.

`routes` has the addresses; `requests` reads what a page requests, with the `factors` that a study
can vary; `manager` starts and stops studies, each a `job` in a process of its own, and summarises
them (`summary`); `progress` is that of a running study, `detail` and `run_rows` are its results.
"""
