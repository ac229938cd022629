"""Check what no linter does: crate layers, file lengths, and that documents name what exists.

Example: python scripts/check_tree.py
"""

import json
import re
import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent

CRATE_USES = {
    "agent-economy-base": set[str](),
    "agent-economy-benchmarks": {
        "agent-economy-base",
        "agent-economy-brain",
        "agent-economy-classic",
        "agent-economy-sim",
    },
    "agent-economy-brain": {"agent-economy-base"},
    "agent-economy-classic": {"agent-economy-base"},
    "agent-economy-py": {
        "agent-economy-base",
        "agent-economy-brain",
        "agent-economy-classic",
        "agent-economy-select",
        "agent-economy-sim",
    },
    "agent-economy-select": {"agent-economy-base"},
    "agent-economy-sim": {"agent-economy-base", "agent-economy-brain"},
}
"""Which of our crates each may use; a new crate is added here on purpose."""

BRAIN_USES = {"agent-economy-base", "libm", "schemars", "serde"}
"""All that the crate brain may use: nothing with a clock, a file, a thread or a random stream."""

NO_STD = "#![cfg_attr(not(test), no_std)]"
"""What keeps the standard library, and with it the outside world, out of the crate brain."""

CODE = {
    "benchmarks/peers": ["*.py", "*.rs"],
    "benchmarks/benches": ["*.rs"],
    "benchmarks/src": ["*.rs"],
    "crates": ["*.rs"],
    "examples": ["*.py", "*.rs"],
    "packaging": ["*.py"],
    "python": ["*.py", "*.pyi"],
    "scripts": ["*.py"],
    "web/src": ["*.svelte", "*.ts"],
}
MAX_LINES = 600


def main() -> None:
    """Print every error and exit with 1 if there is one."""
    errors = [*crate_errors(), *brain_errors(), *length_errors(), *document_errors()]
    for error in errors:
        print(error)
    print(f"check_tree: {len(errors)} errors")
    sys.exit(bool(errors))


def crate_errors() -> list[str]:
    """Return uses of one crate by another that the layers do not allow."""
    errors = []
    for package in packages():
        name = package["name"]
        if name not in CRATE_USES:
            errors.append(f"crate {name} has no place among the layers in {__file__}")
            continue
        used = {each["name"] for each in package["dependencies"]} & CRATE_USES.keys()
        errors += [f"crate {name} must not use {each}" for each in used - CRATE_USES[name]]
    return errors


def brain_errors() -> list[str]:
    """Return ways by which more than percepts could enter a brain."""
    errors = []
    library = ROOT / "crates/brain/src/lib.rs"
    if NO_STD not in library.read_text(encoding="utf-8"):
        errors.append(f"crate brain must have {NO_STD}")
    errors += [
        f"{file.relative_to(ROOT)}: a brain must not use std"
        for file in library.parent.rglob("*.rs")
        if re.search(r"\bextern crate std\b", file.read_text(encoding="utf-8"))
    ]
    brain = next(each for each in packages() if each["name"] == "agent-economy-brain")
    used = {each["name"] for each in brain["dependencies"] if each["kind"] != "dev"}
    return errors + [f"crate brain must not use {each}" for each in used - BRAIN_USES]


@cache
def packages() -> list[dict[str, Any]]:
    """Return what cargo knows of our crates."""
    command = ["cargo", "metadata", "--format-version=1", "--no-deps", "--locked"]
    output = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    found: list[dict[str, Any]] = json.loads(output)["packages"]
    return found


def length_errors() -> list[str]:
    """Return code files that have grown too long."""
    files = [file for top in CODE for kind in CODE[top] for file in (ROOT / top).rglob(kind)]
    lengths = {file: len(file.read_text(encoding="utf-8").splitlines()) for file in files}
    return [
        f"{file.relative_to(ROOT)} has {lines} lines, more than {MAX_LINES}: split it by meaning"
        for file, lines in lengths.items()
        if lines > MAX_LINES
    ]


def document_errors() -> list[str]:
    """Return paths of this tree that a document names or links and that do not exist."""
    named = re.compile(
        r"`((?:benchmarks|crates|examples|packaging|python|scenarios|scripts|docs|web)/[^`\s*<>]*)`"
    )
    linked = re.compile(r"\]\((?!https?:|#)([^)\s#]+)")
    errors = []
    for file in [*ROOT.glob("*.md"), *ROOT.glob("docs/*.md"), *ROOT.glob("examples/*.md")]:
        text = file.read_text(encoding="utf-8")
        paths = [ROOT / path for path in named.findall(text)]
        paths += [file.parent / path for path in linked.findall(text)]
        name = file.relative_to(ROOT)
        errors += [
            f"{name} names {path}, which is not there" for path in paths if not path.exists()
        ]
    return errors


if __name__ == "__main__":
    main()
