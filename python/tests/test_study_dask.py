"""A study on a Dask cluster gives the same bytes."""

from pathlib import Path

import small_study
from dask_cluster import Cluster

from agent_economy import study


def test_a_dask_worker_killed_during_a_study_changes_no_byte(
    cluster: Cluster, tmp_path: Path
) -> None:
    address, (_, victim, _) = cluster
    plan = small_study.plan()

    def kill(now: study.Progress) -> None:
        if now.round == 7:
            victim.kill()

    study.run_plan(plan, tmp_path / "here")
    with plan.engine.on_dask(address) as workers:
        study.run_plan(plan, tmp_path / "dask", compute=workers.columns, on_progress=kill)
    assert victim.wait(10) != 0
    for name in ("answer.json", "study.toml"):
        assert (tmp_path / "dask" / name).read_bytes() == (tmp_path / "here" / name).read_bytes()
    rows = [
        study.open(tmp_path / name).runs().order("configuration, run").fetchall()
        for name in ("here", "dask")
    ]
    assert rows[0] == rows[1]
