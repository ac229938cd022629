"""The answer of a study of any question."""

from agent_economy._core import InputError
from agent_economy.study.answer.best import Answer
from agent_economy.study.answer.requirement import RequirementAnswer
from agent_economy.study.answer.requirement_results import RequirementResult
from agent_economy.study.answer.results import Result

AnyAnswer = Answer | RequirementAnswer
AnyResult = Result | RequirementResult


def expect_best(answer: AnyAnswer) -> Answer:
    """Return an answer about the best configuration by merit, as it is.

    Raises:
        InputError: If it is about a requirement.
    """
    if isinstance(answer, Answer):
        return answer
    message = "the answer is about a requirement: must be about the best configuration by merit"
    raise InputError(message)
