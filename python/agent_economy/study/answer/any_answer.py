"""The answer of a study of any question."""

from agent_economy.study.answer.conclude import Answer
from agent_economy.study.answer.requirement import RequirementAnswer

AnyAnswer = Answer | RequirementAnswer
