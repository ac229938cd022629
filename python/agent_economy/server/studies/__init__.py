"""StudyManager that the page asks, watches, stops and shows.

`routes` are the addresses; `asks` reads what a page asks, with the `factors` that there are;
`keeper` starts and stops studies, each at `work` in a process of its own, and says what is known of
each (`summary`); `watched` tells how one goes on, `shown` and `runs` what it came to.
"""
