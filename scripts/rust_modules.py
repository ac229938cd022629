"""Which module of a Rust crate uses which: `use` items and paths, resolved to what defines a name.

A parent that declares or re-exports its children does not use them; a module that takes a name from
the parent uses the module that defines it: a child, or the parent itself. Test modules are
left out.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

Module = tuple[str, ...]
"""The path of a module from the root of its crate."""

NOISE = re.compile(
    r"""//[^\n]*|/\*.*?\*/|r(\#*)".*?"\1|"(?:\\.|[^"\\])*"|'(?:\\.|[^\\'\n])'""", re.DOTALL
)
INLINE = re.compile(
    r"(#\[cfg\(test\)\]\s*(?:#\[[^\]]*\]\s*)*)?(?:pub(?:\([^)]*\))?\s+)?\bmod\s+(\w+)\s*\{"
)
TEST_FILE = re.compile(r"#\[cfg\(test\)\]\s*(?:pub(?:\([^)]*\))?\s+)?mod\s+(\w+)\s*;")
USE = re.compile(r"(pub(?:\([^)]*\))?\s+)?\buse\s+([^;]+);")
DECLARATION = re.compile(r"\bmod\s+\w+\s*;")
PATH = re.compile(r"(?<![\w:.$])(?:\w+::)+\w+")
ITEM = re.compile(
    r"\b(?:struct|enum|union|trait|type|fn|const|static|macro_rules!)\s+(?:mut\s+)?(\w+)"
)


@dataclass
class Source:
    """What the file of a module contains."""

    code: str
    items: set[str] = field(default_factory=set)
    names: dict[str, Module] = field(default_factory=dict)
    """Names that `use` binds, with their paths from the root."""
    globs: list[Module] = field(default_factory=list)


class Crate:
    """The modules of a crate, by their paths."""

    def __init__(self, root: Path) -> None:
        """Read the files below a crate's root, lib.rs or main.rs."""
        self.files: dict[Module, Path] = {}
        self.sources: dict[Module, Source] = {}
        self._read((), root, root.parent)

    def _read(self, module: Module, file: Path, folder: Path) -> None:
        """Read the file of a module, and those of the modules that it declares."""
        code = without_noise(file.read_text(encoding="utf-8"))
        tests = {each[1] for each in TEST_FILE.finditer(code)}
        self.files[module] = file
        self.sources[module] = Source(without_tests(code))
        for each in re.finditer(r"\bmod\s+(\w+)\s*;", code):
            child = each[1]
            for path in (folder / f"{child}.rs", folder / child / "mod.rs"):
                if child not in tests and path.is_file():
                    self._read((*module, child), path, folder / child)

    def uses(self) -> dict[Module, set[Module]]:
        """Return the modules that each module uses."""
        for module, source in self.sources.items():
            source.items = {each[1] for each in ITEM.finditer(source.code)}
            for statement in USE.finditer(source.code):
                self._bind(module, source, statement[2])
        return {
            module: {used for used in self._used(module) if used != module}
            for module in self.sources
        }

    def _bind(self, module: Module, source: Source, tree: str) -> None:
        """Bind the names of a `use` item."""
        for path, name in leaves(tree):
            absolute = self._absolute(module, path)
            if absolute is None:
                continue
            if name == "*":
                source.globs.append(absolute)
            elif name != "_":
                source.names[name] = absolute

    def _absolute(self, module: Module, path: list[str]) -> Module | None:
        """Return a path from the root, None if it leads out of the crate."""
        if path[0] == "crate":
            return tuple(path[1:])
        base, rest = module, path
        while rest and rest[0] in ("self", "super"):
            base, rest = (base if rest[0] == "self" else base[:-1]), rest[1:]
        if rest != path:
            return (*base, *rest)
        if (*module, path[0]) in self.sources:
            return (*module, *path)
        bound = self.sources[module].names.get(path[0])
        return (*bound, *path[1:]) if bound is not None and len(path) > 1 else None

    def _used(self, module: Module) -> Iterator[Module]:
        """Yield the modules that define what a module uses."""
        source = self.sources[module]
        code = DECLARATION.sub("", USE.sub("", source.code))
        words = set(re.findall(r"\w+", code))
        for name, path in source.names.items():
            if name in words and path not in self.sources:
                yield self.definer(path)
        for target in source.globs:
            known = self.sources.get(target)
            for name in words & (known.items | known.names.keys() if known else set()):
                yield self.definer((*target, name))
        for each in PATH.finditer(code):
            absolute = self._absolute(module, each[0].split("::"))
            if absolute is not None:
                yield self.definer(absolute)

    def definer(self, path: Module, depth: int = 0) -> Module:
        """Return the module that defines what a path names, through re-exports."""
        module: Module = ()
        for place, name in enumerate(path):
            if (*module, name) in self.sources:
                module = (*module, name)
                continue
            source = self.sources[module]
            if name in source.items or depth > len(self.sources):
                return module
            if name in source.names:
                return self.definer((*source.names[name], *path[place + 1 :]), depth + 1)
            for target in source.globs:
                known = self.sources.get(target)
                if known and (name in known.items or name in known.names):
                    return self.definer((*target, *path[place:]), depth + 1)
            return module
        return module


def without_noise(text: str) -> str:
    """Return code without comments and literals."""
    return NOISE.sub(" ", text)


def without_tests(code: str) -> str:
    """Return code without its inline test modules; other inline modules are read as their file."""
    kept, start = [], 0
    for each in INLINE.finditer(code):
        if each[1] and each.start() >= start:
            kept.append(code[start : each.start()])
            start = closing(code, each.end())
    return "".join([*kept, code[start:]])


def closing(code: str, start: int) -> int:
    """Return where the block that is open at a place ends."""
    depth = 1
    for brace in re.compile(r"[{}]").finditer(code, start):
        depth += 1 if brace[0] == "{" else -1
        if depth == 0:
            return brace.end()
    return len(code)


def leaves(tree: str, before: tuple[str, ...] = ()) -> Iterator[tuple[list[str], str]]:
    """Yield the paths of a `use` tree, and the name that each binds; "*" for all names."""
    for branch in branches(tree):
        head, brace, rest = branch.partition("{")
        path = [*before, *(part.strip() for part in head.split("::") if part.strip())]
        if brace:
            yield from leaves(rest[: rest.rindex("}")], tuple(path))
            continue
        *front, last = path
        last, _, alias = (part.strip() for part in last.partition(" as "))
        if last == "*":
            yield front, "*"
        elif last == "self" and front:
            yield front, alias or front[-1]
        else:
            yield [*front, last], alias or last


def branches(tree: str) -> Iterator[str]:
    """Yield the parts of a `use` tree between commas of the top level."""
    depth, start = 0, 0
    for place, char in enumerate(tree):
        depth += (char == "{") - (char == "}")
        if char == "," and depth == 0:
            yield tree[start:place]
            start = place + 1
    if tree[start:].strip():
        yield tree[start:]
