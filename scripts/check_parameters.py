"""Check that no parameter itself is an anonymous tuple of three values: a struct names them.

Those that there are stand in `scripts/tuple_parameters.txt`, which may only get shorter. The script
also prints how many files name the kind of a mission: a new one should touch one file per crate.

Example: python scripts/check_parameters.py
"""

import ast
import re
import sys
from collections.abc import Iterator
from pathlib import Path

from rust_modules import without_noise, without_tests

ROOT = Path(__file__).resolve().parent.parent
KNOWN = ROOT / "scripts/tuple_parameters.txt"

MAX_VALUES = 2
"""Values of a tuple that a parameter may be."""

MISSIONS = {"the mined lane": re.compile(r"(?<![a-z])lane|clearance", re.IGNORECASE)}
"""Words by which code names the kind of a mission."""

FUNCTION = re.compile(r"\bfn\s+(\w+)")
REFERENCE = re.compile(r"^(?:&\s*(?:'\w+\s*)?|mut\s+)*")
OPENING, CLOSING = "([{<", ")]}>"


def main() -> None:
    """Print every error and the numbers of files, and exit with 1 if there is an error."""
    found = sorted(set(tuples()))
    known = KNOWN.read_text(encoding="utf-8").splitlines()
    errors = [
        f"{each}: is a tuple of three values or more: make it a struct"
        for each in found
        if each not in known
    ]
    errors += [
        f"{each}: is no such tuple any more: remove it from {KNOWN.relative_to(ROOT)}"
        for each in known
        if each not in found
    ]
    for error in errors:
        print(error)
    for mission, words in MISSIONS.items():
        files = sum(1 for file in product() if words.search(file.read_text(encoding="utf-8")))
        print(f"check_parameters: {files} files name {mission}")
    print(f"check_parameters: {len(errors)} errors, {len(known)} tuples left")
    sys.exit(bool(errors))


def product() -> Iterator[Path]:
    """Yield the files of product code."""
    for top, kinds in {
        "crates": ["*/src/**/*.rs"],
        "python/agent_economy": ["**/*.py"],
        "web/src": ["**/*.ts", "**/*.svelte"],
    }.items():
        for kind in kinds:
            yield from sorted((ROOT / top).glob(kind))


def tuples() -> Iterator[str]:
    """Yield the parameters of product code that are such tuples: file, function and name."""
    for file in product():
        is_test = file.stem == "tests" or "tests" in file.parts
        of = {".rs": of_rust, ".py": of_python}.get(file.suffix)
        if of and not is_test:
            found = of(file.read_text(encoding="utf-8"))
            yield from (f"{file.relative_to(ROOT)} {parameter}" for parameter in found)


def of_rust(text: str) -> Iterator[str]:
    """Yield the parameters of functions in Rust that are such tuples, except those of tests."""
    code = without_tests(without_noise(text))
    for function in FUNCTION.finditer(code):
        start = code.index("(", after_generics(code, function.end()))
        for parameter in parts(code[start + 1 : closing(code, start)]):
            name, _, kind = parameter.partition(":")
            kind = REFERENCE.sub("", kind.strip(), count=1)
            if kind.startswith("(") and len(parts(kind[1 : closing(kind, 0)])) > MAX_VALUES:
                yield f"{function[1]} {' '.join(name.split())}"


def of_python(text: str) -> Iterator[str]:
    """Yield the parameters of functions in Python that are such tuples."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            for each in [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]:
                if is_long_tuple(each.annotation):
                    yield f"{node.name} {each.arg}"


def after_generics(code: str, at: int) -> int:
    """Return the end of the generic parameters of a function, if it has any."""
    return closing(code, at) + 1 if code[at : at + 1] == "<" else at


def closing(code: str, start: int) -> int:
    """Return where the bracket at `start` is closed."""
    depth = 0
    for at in range(start, len(code)):
        if code[at] in OPENING:
            depth += 1
        elif code[at] in CLOSING and code[at - 1 : at + 1] not in {"->", "=>"}:
            depth -= 1
            if depth == 0:
                return at
    return len(code)


def parts(code: str) -> list[str]:
    """Return what commas outside of brackets separate."""
    found, start, at = [], 0, 0
    while at < len(code):
        if code[at] in OPENING:
            at = closing(code, at)
        elif code[at] == ",":
            found.append(code[start:at])
            start = at + 1
        at += 1
    return [each for each in [*found, code[start:]] if each.strip()]


def is_long_tuple(annotation: ast.expr | None) -> bool:
    """Return whether an annotation is a tuple of a fixed number of values, more than allowed."""
    match annotation:
        case ast.Subscript(ast.Name("tuple"), ast.Tuple(values)):
            is_endless = any(isinstance(x, ast.Constant) and x.value is ... for x in values)
            return not is_endless and len(values) > MAX_VALUES
    return False


if __name__ == "__main__":
    main()
