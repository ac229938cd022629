"""The answer in words."""

from agent_economy.scenario import Scenario
from agent_economy.study.estimate import Estimate
from agent_economy.study.teams import TeamResult


def in_words(scenario: Scenario, best: int, teams: tuple[TeamResult, ...]) -> str:
    """Return the answer: whom to send, what that gives, and how near the others are."""
    by_size = {team.robots: team for team in teams}
    parts = [
        f"Send {robots(best)}: {performance(scenario, by_size[best])}",
        *ties(teams),
        *runner_up(scenario, teams),
        *published_choice(scenario, best, by_size),
        *edge(best, teams),
    ]
    return "; ".join(parts) + "."


def robots(count: int) -> str:
    """Return "1 robot", "2 robots", ..."""
    return f"{count} robot" if count == 1 else f"{count} robots"


def performance(scenario: Scenario, team: TeamResult) -> str:
    """Return what a team does."""
    return (
        f"a search takes {team.time_s.value:.1f} s on average, {team.failed_share.value:.2%} fail "
        f"(and count as {scenario.cap_s:g} s), figure of merit {team.merit.value:.2f} "
        f"(95% interval {team.merit.low:.2f} to {team.merit.high:.2f})"
    )


def ties(teams: tuple[TeamResult, ...]) -> list[str]:
    """Return the teams that cannot be told apart from the best."""
    tied = [team for team in teams if team.is_tied]
    if not tied:
        return []
    worst = max(team.behind_best.high for team in tied if team.behind_best)
    runs = tied[0].runs
    sizes = listed([str(team.robots) for team in tied])
    return [f"{sizes} cannot be told apart from it with {runs:,} runs (at most {worst:.3f} worse)"]


def listed(words: list[str]) -> str:
    """Return "a", "a and b", "a, b and c"."""
    *most, last = words
    return f"{', '.join(most)} and {last}" if most else last


def runner_up(scenario: Scenario, teams: tuple[TeamResult, ...]) -> list[str]:
    """Return the nearest of the teams that are worse for sure, unless it is the published one."""
    beaten = [(team.behind_best, team) for team in teams if team.behind_best and not team.is_tied]
    if not beaten:
        return []
    behind, team = min(beaten, key=lambda pair: pair[0].value)
    if scenario.published and team.robots == scenario.published.choice:
        return []
    return [f"{team.robots} would cost {cost(behind)}"]


def published_choice(scenario: Scenario, best: int, teams: dict[int, TeamResult]) -> list[str]:
    """Return what the published choice costs, if it was run and is worse for sure."""
    if not scenario.published:
        return []
    source, choice = scenario.published.source, scenario.published.choice
    if choice == best:
        return [f"{source} chose the same"]
    team = teams.get(choice)
    if not team or not team.behind_best or team.is_tied:
        return []
    return [f"the {choice} of {source} would cost {cost(team.behind_best)}"]


def cost(behind: Estimate) -> str:
    """Return how far a team is behind the best."""
    return f"{behind.value:.3f} of merit ({behind.low:.3f} to {behind.high:.3f})"


def edge(best: int, teams: tuple[TeamResult, ...]) -> list[str]:
    """Return a warning if a larger team than any that was run might be better still."""
    if len(teams) > 1 and best == teams[-1].robots:
        return ["it is the largest team that was run, and a larger one may be better still"]
    return []
