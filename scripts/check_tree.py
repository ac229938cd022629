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

CODE = {"crates": ["*.rs"], "python": ["*.py", "*.pyi"], "scripts": ["*.py"]}
MAX_LINES = 600


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
    files = [file for top in CODE for kind in CODE[top] for file in (ROOT / top).rglob(kind)]
    lengths = {file: len(file.read_text(encoding="utf-8").splitlines()) for file in files}
    return [
        f"{file.relative_to(ROOT)} has {lines} lines, more than {MAX_LINES}: split it by meaning"
        for file, lines in lengths.items()
        if lines > MAX_LINES
    ]


def document_faults() -> list[str]:
    """Return paths of this tree that a document names or links and that do not exist."""
    named = re.compile(r"`((?:crates|python|scenarios|scripts|docs)/[^`\s*<>]*)`")
    linked = re.compile(r"\]\((?!https?:|#)([^)\s#]+)")
    faults = []
    for file in [*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md")]:
        text = file.read_text(encoding="utf-8")
        paths = [ROOT / path for path in named.findall(text)]
        paths += [file.parent / path for path in linked.findall(text)]
        name = file.relative_to(ROOT)
        faults += [
            f"{name} names {path}, which is not there" for path in paths if not path.exists()
        ]
    return faults


if __name__ == "__main__":
    main()
