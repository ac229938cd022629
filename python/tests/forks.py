"""Processes that tests start and kill by the hundred, from one that has loaded all they need."""

import multiprocessing

FORKS = multiprocessing.get_context("forkserver")
# Each process loads the main module, which is pytest's, again; here it is loaded already.
FORKS.set_forkserver_preload(["made_up", "pytest", "small"])
