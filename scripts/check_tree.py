"""Check what no linter does: crate layers, file lengths, and that documents name what exists.

Example: python scripts/check_tree.py
"""

import json
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

CRATE_USES = {
    "agent-economy-base": set[str](),
    "agent-economy-classic": {"agent-economy-base"},
    "agent-economy-py": {"agent-economy-base", "agent-economy-classic"},
}
"""Which of our crates each may use; a new crate is added here on purpose."""

CODE = {".rs", ".py", ".pyi"}
MAX_LINES = 600
DOCUMENTS = ("README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "docs")


def main() -> None:
    """Print every fault and exit with 1 if there is one."""
    faults = [*crate_faults(), *length_faults(), *document_faults()]
    for fault in faults:
        print(fault)
    print(f"check_tree: {len(faults)} faults")
    sys.exit(bool(faults))


def crate_faults() -> list[str]:
    """Return uses of one crate by another that the layers do not allow."""
    command = ["cargo", "metadata", "--format-version=1", "--no-deps", "--locked"]
    output = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    faults = []
    for package in json.loads(output)["packages"]:
        name = package["name"]
        if name not in CRATE_USES:
            faults.append(f"crate {name} has no place among the layers in {__file__}")
            continue
        used = {each["name"] for each in package["dependencies"]} & CRATE_USES.keys()
        faults += [f"crate {name} must not use {each}" for each in used - CRATE_USES[name]]
    return faults


def length_faults() -> list[str]:
    """Return code files that have grown too long."""
    lengths = {
        file: len(file.read_text().splitlines()) for file in tracked() if file.suffix in CODE
    }
    return [
        f"{file.relative_to(ROOT)} has {lines} lines, more than {MAX_LINES}: split it by meaning"
        for file, lines in lengths.items()
        if lines > MAX_LINES
    ]


def document_faults() -> list[str]:
    """Return paths of this tree that a document names and that do not exist."""
    path = re.compile(r"`((?:crates|python|scenarios|scripts|docs|benchmarks)/[^`\s*<>]*)`")
    faults = []
    for file in tracked():
        name = file.relative_to(ROOT).as_posix()
        if file.suffix == ".md" and name.startswith(DOCUMENTS):
            named = path.findall(file.read_text())
            faults += [
                f"{name} names {each}, which is not there"
                for each in named
                if not (ROOT / each).exists()
            ]
    return faults


def tracked() -> list[Path]:
    """Return the files that git tracks, or would."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard"]
    output = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    return [ROOT / line for line in output.splitlines() if (ROOT / line).is_file()]


if __name__ == "__main__":
    main()
