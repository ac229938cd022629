"""What operators requested since the last turn of the warden."""

from dataclasses import dataclass, field

from agent_economy.live.rules import Mode, Requests


@dataclass
class Operator:
    """What has been requested since the last turn."""

    stop: bool = False
    release: bool = False
    hold: bool = False
    resume: bool = False
    arm: set[str] = field(default_factory=set)
    mode: dict[str, Mode] = field(default_factory=dict)
    navigate: dict[str, bool] = field(default_factory=dict)
    confirm: dict[str, set[str]] = field(default_factory=dict)

    def take(self) -> Requests:
        """Return the requests, and forget them."""
        taken = Requests(
            stop=self.stop,
            release=self.release,
            arm=frozenset(self.arm),
            mode=self.mode,
            hold=self.hold,
            resume=self.resume,
            navigate=self.navigate,
            confirm=self.confirm,
        )
        self.stop = self.release = self.hold = self.resume = False
        self.arm, self.mode, self.navigate, self.confirm = set(), {}, {}, {}
        return taken
