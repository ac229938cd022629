"""Which configurations the charts of a report are scaled to."""

from agent_economy.study.answer.any_answer import AnyAnswer
from agent_economy.study.answer.conclude import Answer
from agent_economy.study.answer.requirement import RequirementAnswer


def contenders(answer: AnyAnswer) -> frozenset[int]:
    """Return the configurations that the answer is about; distant ones would squeeze the scale.

    By merit: the selected one, and those that are not proved to be worse. With a requirement: those
    that are certified or open, and the next cheaper one than the selected one.
    """
    if isinstance(answer, RequirementAnswer):
        return with_requirement(answer)
    return by_merit(answer)


def by_merit(answer: Answer) -> frozenset[int]:
    """Return the contenders by merit; without any other, the next best one."""
    results = answer.results
    possible = [index for index, each in enumerate(results) if each.is_possible]
    near = [index for index in possible if results[index].standing.verdict != "worse"]
    if len(near) > 1:
        return frozenset(near)
    others = sorted(set(possible) - set(near), key=lambda index: -results[index].merit.value)
    return frozenset((*near, *others[:1]))


def with_requirement(answer: RequirementAnswer) -> frozenset[int]:
    """Return the contenders in a study of a requirement."""
    results = answer.results
    known = [index for index, each in enumerate(results) if each.met and each.is_possible]
    known.sort(key=lambda index: results[index].cost)
    end = len(known) if answer.selected is None else known.index(answer.selected)
    in_play = (
        index for index in known if results[index].status in ("selected", "certified", "open")
    )
    return frozenset((*in_play, *known[:end][-1:]))
