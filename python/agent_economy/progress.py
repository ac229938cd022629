"""How far a study is, told to people: a bar on a terminal, else a plain line a team."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

from agent_economy.scenario import Scenario
from agent_economy.study.runs import Progress as StudyProgress
from agent_economy.study.sentence import robots

OnProgress = Callable[[StudyProgress], None]


class Teller:
    """Tells progress on standard error, and remembers it for when the study is stopped."""

    def __init__(self) -> None:
        """Begin with nothing done."""
        self.done = 0

    @contextmanager
    def shown(self, scenario: Scenario) -> Iterator[OnProgress]:
        """Show the progress of a scenario's study."""
        console = Console(stderr=True)
        show = bar if console.is_terminal else lines
        with show(scenario, console) as on_progress:

            def remember(progress: StudyProgress) -> None:
                self.done = progress.done
                on_progress(progress)

            yield remember


@contextmanager
def bar(scenario: Scenario, console: Console) -> Iterator[OnProgress]:
    """Show a bar with rate and time left."""
    total = scenario.runs * len(scenario.team_sizes)
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[rate]}"),
    )
    with Progress(*columns, console=console, transient=True) as progress:
        task = progress.add_task("runs", total=total, rate="")
        yield lambda now: progress.update(task, completed=now.done, rate=rate(now))


@contextmanager
def lines(scenario: Scenario, console: Console) -> Iterator[OnProgress]:
    """Show a line when a team is done."""

    def line(now: StudyProgress) -> None:
        if now.done % scenario.runs == 0:
            text = f"{robots(now.robots)}: {now.done:,} of {now.total:,} runs, {rate(now)}"
            console.print(text, highlight=False, soft_wrap=True)

    yield line


def rate(now: StudyProgress) -> str:
    """Return runs a second and the time left."""
    return f"{now.runs_per_s:,.0f} runs/s, {now.seconds_left:.0f} s left"
