"""A drive on the wire: a fault stops its robot and no other, whichever process fails."""

from contextlib import ExitStack
from pathlib import Path

import process_faults
from bare_timer import repeated_if_late
from live_bench import driving, emulated, fleet_text
from wire_faults import CHOSEN, FAULTS, Evidence, finding_of, inject, lanes

from agent_economy.live.clock import now_s

LOOSE_S = 5.0
"""A bound for a machine that is busy with other tests; `make safety` measures."""


@repeated_if_late
def test_every_fault_of_a_robot_stops_it_and_no_other(tmp_path: Path) -> None:
    assert len(FAULTS) == len(CHOSEN)
    healthy, fenced = len(FAULTS), len(FAULTS) + 1
    robots = len(FAULTS) + 2
    scenario = lanes(tmp_path, robots)
    fleet = tmp_path / "fleet.toml"
    with emulated(tmp_path, robots, arguments=("--scenario", str(scenario))) as bench:
        fence = f"fence_m = [[0, 0], [9, 0], [9, {8 * robots + 10}], [0, {8 * robots + 10}]]"
        keys = {f"bender/{fenced}": fence}
        fleet.write_text(fleet_text(bench, scenario=str(scenario), keys=keys), encoding="utf-8")
        with driving(fleet) as drive:
            for robot in range(robots):
                drive.wait_until_moving(f"bender/{robot}")
            bench.wait_for_motion(robots)
            inject(bench, FAULTS)
            for robot, fault in enumerate(FAULTS):
                drive.wait_for_fault(f"bender/{robot}", finding_of(fault).name)
            drive.wait_for_fault(f"bender/{fenced}", "outside_fence")
            broken = [f"bender/{robot}" for robot in range(len(FAULTS))]
            drive.wait_until_latched([*broken, f"bender/{fenced}"])
            bench.fault(0, "motors", "runaway", 10)
            drive.wait_for_fault("bender/0", "moves_while_stopped")
            assert bench.moves_after(healthy, now_s() - 1)
            stopped_s = drive.stop()
            assert drive.wait() == 3
            assert bench.stops_after(healthy, stopped_s)
            evidence = Evidence.of(bench, drive.record)
    for robot, fault in enumerate(FAULTS):
        delay_s = evidence.stop_delay_s(robot, fault)
        assert -0.02 <= delay_s < LOOSE_S + finding_of(fault).limit_s, fault.name


@repeated_if_late
def test_a_robot_stops_when_a_process_of_its_drive_fails(tmp_path: Path) -> None:
    scenario = lanes(tmp_path, len(process_faults.FAULTS))
    with ExitStack() as stack:
        arguments = ("--scenario", str(scenario))
        bench = stack.enter_context(
            emulated(tmp_path, len(process_faults.FAULTS), arguments=arguments)
        )
        drives = process_faults.Drives(bench, scenario, tmp_path, stack)
        drives.inject()
        for robot, fault in enumerate(process_faults.FAULTS):
            delay_s = drives.stop_delay_s(robot)
            assert -0.5 <= delay_s < LOOSE_S, fault.name
            assert drives.drives[robot].wait() == fault.exit_code, fault.name
