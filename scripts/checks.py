"""Run the checks of this tree, two at a time, and print the time of each.

Without --quick, every check, as `make test`; with it, those that the changes since main need.

    python scripts/checks.py --quick --crate brain
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BIN = ROOT / ".venv/bin"

AT_ONCE = 2
"""Stages that run at the same time."""

SLOW_TESTS = {"brains", "validation"}
"""Rust test binaries, each of a minute of statistics, that `--quick` leaves to `make test`."""


@dataclass(frozen=True)
class Stage:
    """A command, and the stages that must pass before it.

    One that waits for servers and browsers is interactive: it runs beside batch stages only, which
    leave the processor to it.
    """

    name: str
    command: tuple[str, ...]
    needs: tuple[str, ...] = ()
    is_interactive: bool = False


@dataclass(frozen=True)
class Result:
    """How a stage ended: what it printed, and its costs in seconds."""

    stage: Stage
    status: int
    output: str
    wall_s: float
    cpu_s: float


def make(target: str, *needs: str, is_interactive: bool = False) -> Stage:
    """Return the stage of a target of the Makefile."""
    return Stage(target, ("make", "--no-print-directory", target), needs, is_interactive)


EVERYTHING = [
    make(".venv/packages"),
    make("page-packages"),
    make(".venv/checked", ".venv/packages"),
    make("page-check", "page-packages"),
    make("page-browser", ".venv/checked", "page-packages", is_interactive=True),
    make("rust-build", ".venv/checked"),
    make("rust-lint", "rust-build"),
    make("python-test", ".venv/checked", is_interactive=True),
    make("rust-test", "rust-build"),
    make("wasm", "rust-build"),
    make("python-lint", ".venv/checked", "rust-build"),
]


def main() -> None:
    """Run the checks, print a table of their times, and exit with 1 if one failed."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument("--quick", action="store_true", help="only what the changes need")
    parser.add_argument("--crate", action="append", help="with --quick, check this crate only")
    options = parser.parse_args()
    stages = EVERYTHING
    if options.quick:
        stages = quick([f"crates/{each}/" for each in options.crate or []] or changes())
    started = time.monotonic()
    results = run(stages)
    print_times(results, time.monotonic() - started)
    sys.exit(len(results) < len(stages) or any(each.status for each in results))


def run(stages: list[Stage]) -> list[Result]:
    """Run stages in order, two at a time; those that need a failed one are left out."""
    waiting, results = list(stages), list[Result]()
    running: dict[Future[Result], Stage] = {}
    with ThreadPoolExecutor(AT_ONCE) as pool:
        while waiting or running:
            while stage := next_stage(waiting, list(running.values()), results):
                waiting.remove(stage)
                print(f"--- {stage.name}: started", flush=True)
                running[pool.submit(run_stage, stage)] = stage
            if not running:
                break
            for done in wait(running, return_when=FIRST_COMPLETED).done:
                del running[done]
                results.append(done.result())
                print_result(results[-1])
    for stage in waiting:
        print(f"--- {stage.name}: NOT RUN, it needs a stage that failed")
    return results


def next_stage(waiting: list[Stage], running: list[Stage], results: list[Result]) -> Stage | None:
    """Return the first stage that may start now."""
    if len(running) == AT_ONCE:
        return None
    passed = {each.stage.name for each in results if each.status == 0}
    ready = [each for each in waiting if passed.issuperset(each.needs)]
    if any(each.is_interactive for each in running):
        ready = [each for each in ready if not each.is_interactive]
    return next(iter(ready), None)


def run_stage(stage: Stage) -> Result:
    """Run a command to its end."""
    started = time.monotonic()
    nice = () if stage.is_interactive else ("nice",)
    with tempfile.TemporaryFile("w+", encoding="utf-8", errors="replace") as output:
        process = subprocess.Popen(
            (*nice, *stage.command),
            cwd=ROOT,
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=output,
        )
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        text = output.read()
    wall_s = time.monotonic() - started
    return Result(stage, process.returncode, text, wall_s, usage.ru_utime + usage.ru_stime)


def print_result(result: Result) -> None:
    """Print what a stage printed, and how it ended."""
    print(result.output, end="")
    ended = f"FAILED with {result.status}" if result.status else "passed"
    print(f"--- {result.stage.name}: {ended} in {result.wall_s:.0f} s", flush=True)


def print_times(results: list[Result], wall_s: float) -> None:
    """Print a table of the times of stages."""
    print(f"\n{'stage':18}{'wall s':>8}{'cpu s':>8}")
    for each in results:
        failed = "  FAILED" if each.status else ""
        print(f"{each.stage.name:18}{each.wall_s:8.1f}{each.cpu_s:8.1f}{failed}")
    print(f"{'total':18}{wall_s:8.1f}{sum(each.cpu_s for each in results):8.1f}")


def changes() -> list[str]:
    """Return the files that differ from the branch main, or are new."""
    base = git("merge-base", "HEAD", "main") or ["HEAD"]
    listed = git("diff", "--name-only", base[0]) + git("ls-files", "--others", "--exclude-standard")
    return sorted(set(listed))


def git(*arguments: str) -> list[str]:
    """Return the lines that git prints; none if it fails."""
    command = ["git", *arguments]
    done = subprocess.run(command, cwd=ROOT, check=False, capture_output=True, text=True)
    return done.stdout.splitlines() if done.returncode == 0 else []


def quick(changed: list[str]) -> list[Stage]:
    """Return the stages that changed files need."""
    crates = sorted({each.split("/")[1] for each in changed if each.startswith("crates/")})
    modules = [each for each in changed if each.endswith(".py")]
    stages = [
        Stage("tree", (python("python"), "scripts/check_tree.py")),
        Stage("prose", (python("python"), "scripts/check_prose.py")),
    ]
    for crate in crates:
        stages += rust_stages(crate)
    if modules:
        stages += python_stages(modules)
    if any(each.startswith("web/") for each in changed):
        stages.append(make("page-check"))
    return stages


def rust_stages(crate: str) -> list[Stage]:
    """Return the stages of a crate."""
    package = f"agent-economy-{crate}"
    lint = ("cargo", "clippy", "--locked", "-p", package, "--all-targets", "--", "-D", "warnings")
    stages = [
        Stage(f"{crate} format", ("cargo", "fmt", "-p", package, "--check")),
        Stage(f"{crate} lint", lint),
    ]
    if crate != "py":  # The extension module needs a Python to link against.
        tests = [each.stem for each in (ROOT / "crates" / crate / "tests").glob("*")]
        names = [each for each in sorted(set(tests) - SLOW_TESTS) if is_test(crate, each)]
        chosen = ["--lib", *(part for each in names for part in ("--test", each))]
        test = ("cargo", "test", "--locked", "-p", package, *chosen)
        stages.append(Stage(f"{crate} test", test))
    return stages


def is_test(crate: str, name: str) -> bool:
    """Return whether cargo makes a test binary of a file or folder of this name."""
    folder = ROOT / "crates" / crate / "tests"
    return (folder / f"{name}.rs").is_file() or (folder / name / "main.rs").is_file()


def python_stages(files: list[str]) -> list[Stage]:
    """Return the stages of Python files; of tests, those that changed or name a changed module."""
    stages = [
        Stage("python format", (python("ruff"), "format", "--check", *existing(files))),
        Stage("python lint", (python("ruff"), "check", *existing(files))),
        Stage("python types", (python("mypy"),)),
        Stage("python layers", (python("lint-imports"), "--no-cache")),
    ]
    names = [Path(each).with_suffix("").as_posix().replace("/", ".") for each in files]
    modules = {each.removeprefix("python.").removesuffix(".__init__") for each in names}
    tests = [
        str(each.relative_to(ROOT))
        for each in sorted((ROOT / "python/tests").glob("test_*.py"))
        if str(each.relative_to(ROOT)) in files or names_one(each, modules)
    ]
    if tests:
        stages.append(Stage("python test", (python("pytest"), "-q", "-n2", *tests)))
    return stages


def existing(files: list[str]) -> list[str]:
    """Return the files that have not been removed."""
    return [each for each in files if (ROOT / each).is_file()]


def names_one(test: Path, modules: set[str]) -> bool:
    """Return whether a test imports one of the modules by its whole name."""
    words = set(test.read_text(encoding="utf-8").split())
    return not words.isdisjoint(modules)


def python(program: str) -> str:
    """Return the path of a program of the environment."""
    return str(BIN / program)


if __name__ == "__main__":
    main()
