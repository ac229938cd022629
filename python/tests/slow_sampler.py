"""A selection of a slow sampler in a process of its own, which tests kill.

Usage: LOG=FILE RUN_S=SECONDS python slow_sampler.py FOLDER. Each call of the sampler is a line of
the file; without it, the sampler is fast.
"""

import json
import os
import sys
import time
from pathlib import Path

import numpy as np

from agent_economy.study import Selection, select_best
from agent_economy.study.arguments import Floats
from agent_economy.study.selection import Integers

SHARES = np.array([0.3, 0.5, 0.55, 0.4])


def sample(configurations: Integers, first_run: int, runs: int) -> Floats:
    """Return merits of 0 and 1; run r of all configurations shares its uniform number."""
    if "LOG" in os.environ:
        time.sleep(float(os.environ["RUN_S"]) * len(configurations) * runs)
        with Path(os.environ["LOG"]).open("a", encoding="utf-8") as log:
            log.write(json.dumps([configurations.tolist(), first_run, runs]) + "\n")
    uniforms = np.random.Generator(np.random.PCG64(7).advance(first_run)).random(runs)
    return (uniforms < SHARES[configurations][:, np.newaxis]).astype(np.float64)


def selected(out: str | None) -> Selection:
    """Return the selection."""
    return select_best(sample, len(SHARES), bounds=(0, 1), delta=0.02, out=out)


if __name__ == "__main__":
    sys.stdout.write(f"{selected(sys.argv[1])}\n")
