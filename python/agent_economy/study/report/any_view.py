"""The view of an answer to any question."""

from agent_economy.study.report.merit_view import MeritView
from agent_economy.study.report.requirement_view import RequirementView

AnyView = MeritView | RequirementView
