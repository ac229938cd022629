"""Check that no modules import each other in a circle, in Rust or in Python.

Example: python scripts/check_cycles.py
"""

import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

import grimp
from rust_modules import Crate

ROOT = Path(__file__).resolve().parent.parent
ROOTS = ["crates/*/src/lib.rs", "crates/*/examples/*/main.rs", "benchmarks/src/main.rs"]
PACKAGE = "agent_economy"


def main() -> None:
    """Print every circle and exit with 1 if there is one."""
    roots = sorted(root for each in ROOTS for root in ROOT.glob(each))
    found = [each for root in roots for each in rust_cycles(root)] + python_cycles()
    for each in found:
        print(each)
    print(f"check_cycles: {len(found)} circles of imports")
    sys.exit(bool(found))


def rust_cycles(root: Path) -> list[str]:
    """Return a description of each circle in a crate, given its lib.rs or main.rs."""
    crate = Crate(root)
    names = {module: str(file.relative_to(ROOT)) for module, file in crate.files.items()}
    uses = {names[module]: {names[each] for each in used} for module, used in crate.uses().items()}
    return [described(each, uses) for each in cycles(uses)]


def python_cycles() -> list[str]:
    """Return a description of each circle among the modules of the package."""
    graph = grimp.build_graph(PACKAGE)
    uses = {each: graph.find_modules_directly_imported_by(each) for each in sorted(graph.modules)}
    # The package imports its public names when they are used, and for type checkers.
    graph = grimp.build_graph(PACKAGE, exclude_type_checking_imports=True)
    uses[PACKAGE] = graph.find_modules_directly_imported_by(PACKAGE)
    return [described(each, uses) for each in cycles(uses)]


def cycles(uses: Mapping[str, set[str]]) -> Iterator[list[str]]:
    """Yield the largest groups of modules that each use all the others, directly or not."""
    reach = {module: reachable(module, uses) for module in uses}
    done: set[str] = set()
    for module in uses:
        if module in reach[module] and module not in done:
            group = sorted(each for each in reach[module] if module in reach[each])
            done.update(group)
            yield group


def reachable(start: str, uses: Mapping[str, set[str]]) -> set[str]:
    """Return all that a module uses, directly or not."""
    found: set[str] = set()
    ahead = [start]
    while ahead:
        new = uses.get(ahead.pop(), set()) - found
        found |= new
        ahead += new
    return found


def described(group: list[str], uses: Mapping[str, set[str]]) -> str:
    """Return a circle's modules, each with those of the circle that it uses."""
    lines = [f"  {each} -> {', '.join(sorted(uses[each] & set(group)))}" for each in group]
    return "\n".join([f"{len(group)} modules import each other in a circle:", *lines])


if __name__ == "__main__":
    main()
