"""Measure other simulators beside ours, in turns on one machine, and print tables in Markdown.

Ours is measured before and after each of them, so each ratio is of neighbours in time. Needs
cargo; Python packages are installed in `benchmarks/.venv`. What cannot be installed is named and
left out.

Example: python benchmarks/peers/run.py
"""

import json
import os
import platform
import subprocess
import sys
import tempfile
import venv
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

PEERS = Path(__file__).resolve().parent
ROOT = PEERS.parent.parent
SPEED = ROOT / "target/release/speed"
KRABMAGA = ROOT / "target/peers/release/agent-economy-peer-krabmaga"
PYTHON = PEERS.parent / ".venv/bin/python"
BIRDS = (1_000, 10_000, 100_000)
QUIET = {**os.environ, "MPLBACKEND": "Agg", "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


@dataclass(frozen=True)
class Peer:
    """Another simulator.

    Attributes:
        name: for people.
        install: commands that put it where it is run; they may run again.
        works: for each work a command, which gets the file of the field after its first words.
        flocks: commands that measure flocks, by how many birds these have.
    """

    name: str
    install: list[list[str]]
    works: list[list[str]]
    flocks: dict[int, list[str]] = field(default_factory=dict)


def main() -> None:
    """Install, measure and print."""
    run(["cargo", "build", "--release", "--locked", "-p", "agent-economy-benchmarks"])
    if not PYTHON.exists():
        venv.create(PEERS.parent / ".venv", with_pip=True)
    installed = [peer for peer in peers() if is_installed(peer)]
    print(f"\n{machine()}\n")
    measure_team([work for peer in installed for work in peer.works])
    measure_flocks([flock for peer in installed for flock in peer.flocks.items()])


def measure_team(works: list[list[str]]) -> None:
    """Print how fast the sensing team is in each."""
    print("| simulator | version | work per robot update | updates/s | ours, alternating | ratio |")
    print("|---|---|---|---|---|---|", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "field.json"
        file.write_text(output([str(SPEED), "field"]), encoding="utf-8")
        before = ours()
        for work in works:
            measured = theirs([each.format(field=file) for each in work])
            after = ours()
            if measured:
                print(row(measured, (before + after) / 2), flush=True)
            before = after


def measure_flocks(flocks: list[tuple[int, list[str]]]) -> None:
    """Print how fast flocks are in each."""
    print("\n| birds | simulator | version | remarks | updates/s | ours, alternating | ratio |")
    print("|---|---|---|---|---|---|---|", flush=True)
    for birds, command in sorted(flocks):
        before = our_flock(birds)
        measured = theirs(command)
        if measured:
            print(f"| {birds} {row(measured, (before + our_flock(birds)) / 2)}", flush=True)


def peers() -> list[Peer]:
    """Return all that are measured."""
    manifest = ["--manifest-path", str(PEERS / "krabmaga/Cargo.toml")]
    target = ["--target-dir", str(ROOT / "target/peers")]
    build = ["cargo", "build", "--release", "--locked", *manifest, *target]
    works = [[str(KRABMAGA), "{field}", work] for work in ("neighbours", "rays")]
    return [
        Peer("krABMaga", [build], works, flocks([str(KRABMAGA), "flock"], BIRDS)),
        python_peer("navground", "navground_team.py", ["lidar", "HL", "ORCA"]),
        python_peer("ir-sim", "irsim_team.py", [""]),
        mesa(),
    ]


def mesa() -> Peer:
    """Return Mesa, whose flocks are small for its sake."""
    peer = python_peer("mesa", "mesa_team.py", [""])
    script = str(PEERS / "mesa_flock.py")
    return Peer(peer.name, peer.install, peer.works, flocks([str(PYTHON), script], BIRDS[:2]))


def flocks(command: list[str], sizes: tuple[int, ...]) -> dict[int, list[str]]:
    """Return a command for each size of flock."""
    return {birds: [*command, str(birds)] for birds in sizes}


def python_peer(package: str, script: str, works: list[str]) -> Peer:
    """Return a package of Python, in the version that is locked."""
    pip = [str(PYTHON), "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    lock = ["--constraint", str(PEERS / "requirements.lock")]
    start = [str(PYTHON), str(PEERS / script), "{field}"]
    return Peer(package, [[*pip, *lock, package]], [[*start, work] for work in works])


def is_installed(peer: Peer) -> bool:
    """Install a peer; say so if that fails."""
    try:
        for command in peer.install:
            run(command)
    except (OSError, subprocess.CalledProcessError) as error:
        print(f"LEFT OUT: {peer.name} cannot be installed here: {error}", file=sys.stderr)
        return False
    return True


def theirs(command: list[str]) -> dict[str, Any] | None:
    """Return what a peer prints last, or say that it failed."""
    try:
        found: dict[str, Any] = json.loads(output(command).splitlines()[-1])
    except (OSError, subprocess.CalledProcessError, IndexError, ValueError) as error:
        print(f"LEFT OUT: {' '.join(command)}: {error}", file=sys.stderr)
        return None
    return found


def ours() -> float:
    """Return how many robots our simulator updates in a second: a hundred, with everything on."""
    table = output([str(SPEED), "team", "100"]).splitlines()
    cells = next(line for line in table if line.startswith("| 100 ")).split("|")
    return float(cells[2]) * 1e6


def our_flock(birds: int) -> float:
    """Return how many birds our simulator updates in a second, on one thread."""
    table = output([str(SPEED), "flock", str(birds)]).splitlines()
    cells = next(line for line in table if line.startswith(f"| {birds} | 1 ")).split("|")
    return float(cells[3]) * 1e6


def row(measured: dict[str, Any], ours_per_s: float) -> str:
    """Return a line of the table."""
    rate = measured["updates_per_s"]
    cells = [measured["peer"], measured["version"], measured["work"], rounded(rate)]
    return f"| {' | '.join(cells)} | {rounded(ours_per_s)} | {rounded(ours_per_s / rate)} |"


def rounded(number: float) -> str:
    """Return a number with three digits that count."""
    return f"{number:.3g}" if number < 100 else f"{float(f'{number:.3g}'):,.0f}"  # noqa: PLR2004


def machine() -> str:
    """Return what it runs on."""
    names = [line for line in cpu_lines() if line.startswith("model name")]
    cpu = names[0].split(":")[1].strip() if names else platform.processor()
    rust = output(["rustc", "--version"]).split()[1]
    return f"{cpu}, {os.cpu_count()} cores; Rust {rust}, Python {platform.python_version()}"


def cpu_lines() -> list[str]:
    """Return what Linux says of its processors."""
    file = Path("/proc/cpuinfo")
    return file.read_text(encoding="utf-8").splitlines() if file.exists() else []


def run(command: list[str]) -> None:
    """Run a command to its end; what it prints is for people."""
    subprocess.run(command, cwd=ROOT, check=True, stdout=sys.stderr)


def output(command: list[str]) -> str:
    """Return what a command prints."""
    done = subprocess.run(command, cwd=ROOT, check=True, env=QUIET, capture_output=True, text=True)
    return done.stdout


if __name__ == "__main__":
    main()
