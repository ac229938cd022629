"""A small scenario and a fleet for it, and what tests of fleet files read of them."""

from pathlib import Path

import pytest

from agent_economy import InputError
from agent_economy.live import fleet

SONARS = "".join(
    f"""
[robots.crawler.sensors.sonar_{index}]
kind = "range"
rays = 1
fov_deg = 0
range_m = {6 if index < 5 else 8}
noise_m = 0.02
relative_noise = 0.01
"""
    for index in range(6)
)

SCENARIO = f"""engine = "metric"
summary = "Crawlers drive to waypoints."
merit = "equation-5.2"
[clock]
step_s = 0.1
time_limit_s = 60
[world]
size_m = [40, 30]
origin = {{ latitude_deg = 36.6, longitude_deg = -121.9, declination_deg = 14.5 }}
[robots.crawler]
count = 3
radius_m = 0.4
start = {{ kind = "fixed", at_m = [[5, 5], [5, 15], [5, 25]] }}
drive = {{ max_speed_m_s = 0.6, max_turn_rate_deg_s = 90 }}
[robots.crawler.brain]
rate_hz = 5
behaviours = [
    {{ kind = "cruise" }},
    {{ kind = "correct", waypoints_m = [[30, 15]], within_m = 1 }},
]
[robots.crawler.sensors.gps]
kind = "position"
noise_m = 0.3
[robots.crawler.sensors.compass]
kind = "heading"
noise_deg = 2
{SONARS}
"""

FLEET = """scenario = "crawlers.toml"
[robots."crawler/0"]
driver = "bender"
host = "10.0.0.1"
deadman_s = 1.0
[robots."crawler/0".settings]
range_unit_m = 0.3048
no_echo = 0
forward_m_s_per_unit = 0.02
reverse_m_s_per_unit = 0.02
track_width_m = 0.5
max_forward_value = 200
min_reverse_value = 75
heading_frame = "raw"
[robots."crawler/1"]
driver = "bender"
host = "10.0.0.2"
[robots."crawler/2"]
driver = "bender"
host = "10.0.0.3"
"""

FIRST = 'host = "10.0.0.1"\n'
"""The line of the first robot after which tests add keys; the next line is 5."""


def load(folder: Path, text: str = FLEET) -> fleet.Fleet:
    """Read a fleet from a string."""
    file = folder / "fleet.toml"
    file.write_text(text)
    return fleet.load(file)


def errors(folder: Path, text: str, scenario: str = SCENARIO) -> list[str]:
    """Return the errors of a fleet without the folder, each "FILE:LINE: ..."."""
    (folder / "crawlers.toml").write_text(scenario)
    with pytest.raises(InputError) as error:
        load(folder, text)
    messages = [each["message"] for each in error.value.errors]
    assert str(error.value) == "\n".join(messages)
    return [each.removeprefix(f"{folder}/") for each in messages]


def with_key(line: str) -> str:
    """Return a fleet whose first robot has another key, in line 5."""
    assert FIRST in FLEET
    return FLEET.replace(FIRST, FIRST + line + "\n")


def swapped(old: str, new: str, text: str = FLEET) -> str:
    """Return a string with one part replaced."""
    assert old in text
    return text.replace(old, new, 1)
