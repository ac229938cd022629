"""Check the words of documents, comments, messages and labels against scripts/prose.toml.

Prose is what people read: Markdown outside code, comments, docstrings, string literals and the text
of Svelte components. Names are all the rest: identifiers, keys, text in backticks. Examples:

    python scripts/check_prose.py
    python scripts/check_prose.py docs crates/brain
    python scripts/check_prose.py --count docs crates/brain
"""

import argparse
import re
import subprocess
import sys
import tomllib
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from fnmatch import fnmatch, translate
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
RULES = ROOT / "scripts/prose.toml"

WORD = re.compile(r"[A-Za-z][\w'-]*")
NAME = re.compile(r"[A-Za-z_]\w*")
BRACES = r"\{(?:[^{}]|\{(?:[^{}]|\{[^{}]*\})*\})*\}"

RUST = re.compile(
    r"""(?P<prose>//[^\n]*|/\*.*?\*/)|(?P<skip>'(?:\\.|[^\\'\n])')"""
    r"""|r(?P<hash>\#*)"(?P<raw>.*?)"(?P=hash)|"(?P<text>(?:\\.|[^"\\])*)\"""",
    re.DOTALL,
)
PYTHON = re.compile(
    r'''(?P<prose>\#[^\n]*)|"""(?P<raw>.*?)"""|"(?P<text>(?:\\.|[^"\\\n])*)"'''
    r"""|'(?P<single>(?:\\.|[^'\\\n])*)'""",
    re.DOTALL,
)
TYPESCRIPT = re.compile(
    r"""(?P<prose>(?<!:)//[^\n]*|/\*.*?\*/)|"(?P<text>(?:\\.|[^"\\\n])*)\""""
    r"""|'(?P<single>(?:\\.|[^'\\\n])*)'|`(?P<template>(?:\\.|[^`\\])*)`""",
    re.DOTALL,
)
TOML = re.compile(r"""(?P<prose>(?m:\#.*$))|"(?P<text>(?:\\.|[^"\\\n])*)\"""")
MAKE = re.compile(r"(?P<prose>(?m:\#.*$))|\"(?P<text>[^\"\n]*)\"")
TAG = re.compile(rf"""<[/A-Za-z](?:[^<>"'{{}}]|"[^"]*"|'[^']*'|{BRACES})*>|{BRACES}""")
STRING = re.compile(r"""(?P<text>"[^"]*")|(?P<single>'[^'\n]*')|(?P<template>`[^`]*`)""")
MARKUP_CODE = re.compile(r"<(script|style)\b.*?</\1>", re.DOTALL)
MARKDOWN_CODE = re.compile(
    r"^(```+).*?^\1|^---\n.*?^---$|(?<!`)(`+)(?!`).*?(?<!`)\2(?!`)|https?://\S+|\]\([^)]*\)|<[^>]*>",
    re.DOTALL | re.MULTILINE,
)
BACKTICKED = re.compile(r"`[^`\n]*`|https?://\S+")
HOLES = re.compile(rf"\$?{BRACES}")
CODE_IN = {"text": re.compile(rf"{BACKTICKED.pattern}|\$?{BRACES}"), "template": HOLES}
CODE_IN["single"] = CODE_IN["text"]
GAP = r"""[\s/*#!"\\]+"""
"""What may stand between two words of a phrase: line breaks with marks of comments and strings."""


@dataclass(frozen=True)
class Finding:
    """A phrase or name that the rules forbid, and where it is."""

    path: str
    line: int
    found: str
    instead: str

    def __str__(self) -> str:
        """Return a line that editors can jump from."""
        return f'{self.path}:{self.line}: "{self.found}": {self.instead}'


@dataclass(frozen=True)
class Phrase:
    """A phrase and what to write instead; nothing, if it is right though a part of it is not."""

    pattern: re.Pattern[str]
    instead: str


@dataclass
class Rules:
    """Forbidden phrases by their first word, forbidden names, and exemptions."""

    phrases: dict[str, list[Phrase]] = field(default_factory=dict)
    names: list[tuple[re.Pattern[str], str]] = field(default_factory=list)
    allow: list[dict[str, str]] = field(default_factory=list)
    skip: list[str] = field(default_factory=list)
    used: set[int] = field(default_factory=set)

    @classmethod
    def load(cls, file: Path = RULES) -> "Rules":
        """Read the rules of a file."""
        table: dict[str, Any] = tomllib.loads(file.read_text(encoding="utf-8"))
        allow = [
            each | {"found": found} for each in table.get("allow", []) for found in each["found"]
        ]
        rules = cls(allow=allow, skip=table.get("skip", []))
        for rule in table.get("phrase", []):
            for words in rule.get("except", []):
                rules.add_phrase(words, "")
            for words in rule["avoid"]:
                rules.add_phrase(words, rule["instead"])
        for same_first_word in rules.phrases.values():
            same_first_word.sort(key=lambda each: -len(each.pattern.pattern))
        for rule in table.get("name", []):
            parts = "|".join(map(translate, rule["avoid"]))
            rules.names.append((re.compile(parts), rule["instead"]))
        return rules

    def add_phrase(self, words: str, instead: str) -> None:
        """Add a forbidden phrase, or with nothing to write instead one that is right."""
        self.phrases.setdefault(words.lower().split()[0], []).append(
            Phrase(literal(words), instead)
        )

    def name_instead(self, name: str) -> str | None:
        """Return what to write instead of a name, None if it is right."""
        words = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()
        return next((instead for avoid, instead in self.names if avoid.match(words)), None)

    def allows(self, finding: Finding) -> bool:
        """Return whether an exemption, which counts as used, covers a finding."""
        for place, each in enumerate(self.allow):
            if fnmatch(finding.path, each["path"]) and each["found"] == finding.found.lower():
                self.used.add(place)
                return True
        return False

    def unused(self) -> Iterator[str]:
        """Yield a line per exemption that covers nothing."""
        for place, each in enumerate(self.allow):
            if place not in self.used:
                yield f'scripts/prose.toml: nothing in {each["path"]} needs "{each["found"]}"'


def literal(phrase: str) -> re.Pattern[str]:
    """Return a pattern of a phrase as whole words, over any white space."""
    words = GAP.join(re.escape(each) for each in phrase.split())
    return re.compile(rf"(?<![\w'-]){words}(?![\w-]|'\w)", re.IGNORECASE)


def main() -> None:
    """Print every finding, or how many a folder has; exit with 1 if there is one."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument("paths", nargs="*", help="files or folders; all if none is given")
    parser.add_argument(
        "--count", action="store_true", help="print the number of findings per path"
    )
    options = parser.parse_args()
    rules = Rules.load()
    findings = [each for file in files(options.paths, rules) for each in check_file(file, rules)]
    if options.count:
        print_counts(findings, options.paths)
    else:
        lines = [*map(str, findings), *([] if options.paths else rules.unused())]
        print("\n".join([*lines, f"check_prose: {len(lines)} findings"]))
        sys.exit(bool(lines))


def print_counts(findings: list[Finding], paths: list[str]) -> None:
    """Print the number of findings of each path, or of each folder."""
    counts = Counter(
        next((path for path in paths if each.path.startswith(path)), top(each.path))
        for each in findings
    )
    for path, count in sorted(counts.items()):
        print(f"{count:6} {path}")


def top(path: str) -> str:
    """Return a path's first two folders."""
    return "/".join(path.split("/")[:3][:-1]) or path


def files(paths: list[str], rules: Rules) -> Iterator[str]:
    """Yield the checked files below paths, relative to the root."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "--", *paths]
    listed = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    for path in listed.splitlines():
        skipped = any(fnmatch(path, each) for each in rules.skip)
        if language(path) and not skipped and (ROOT / path).is_file():
            yield path


def language(path: str) -> str:
    """Return a file's language, "" if it is not checked."""
    name = Path(path).name
    if name == "Makefile":
        return "make"
    return LANGUAGES.get(Path(path).suffix, "")


LANGUAGES = {
    ".md": "markdown",
    ".mjs": "typescript",
    ".py": "python",
    ".pyi": "python",
    ".rs": "rust",
    ".svelte": "svelte",
    ".toml": "toml",
    ".ts": "typescript",
}
PATTERNS = {
    "make": MAKE,
    "python": PYTHON,
    "rust": RUST,
    "toml": TOML,
    "typescript": TYPESCRIPT,
}


def check_file(path: str, rules: Rules) -> list[Finding]:
    """Return what the rules forbid in a file, sorted by line."""
    text = (ROOT / path).read_text(encoding="utf-8")
    found = check_text(text, path, rules)
    return [each for each in found if not rules.allows(each)]


def check_text(text: str, path: str, rules: Rules) -> list[Finding]:
    """Return what the rules forbid in the text of a path."""
    spans = list(prose_spans(text, language(path)))
    prose, code = masked(text, spans)
    found = [*phrase_findings(prose, rules), *name_findings(code, rules)]
    return [
        Finding(path, text.count("\n", 0, start) + 1, " ".join(words.split()), instead)
        for start, words, instead in sorted(found)
    ]


def masked(text: str, spans: list[tuple[int, int]]) -> tuple[str, str]:
    """Return prose and code, each with white space for the other."""
    prose, code, end = [], [], 0
    for start, stop in spans:
        prose += [blank(text[end:start]), text[start:stop]]
        code += [text[end:start], blank(text[start:stop])]
        end = stop
    prose.append(blank(text[end:]))
    code.append(text[end:])
    return "".join(prose), "".join(code)


def blank(text: str) -> str:
    """Return white space with the same lines, which no phrase spans."""
    return re.sub(r"\S", "\x00", text)


def prose_spans(text: str, kind: str) -> Iterator[tuple[int, int]]:
    """Yield the start and end of all prose, in order."""
    if kind == "markdown":
        yield from without(text, MARKDOWN_CODE, 0, len(text))
    elif kind == "svelte":
        yield from svelte_spans(text)
    else:
        yield from literal_spans(text, PATTERNS[kind], 0, len(text))


def svelte_spans(text: str) -> Iterator[tuple[int, int]]:
    """Yield the prose of scripts, text nodes and strings of tags."""
    end = 0
    for each in MARKUP_CODE.finditer(text):
        yield from markup_spans(text, end, each.start())
        if each[1] == "script":
            yield from literal_spans(text, TYPESCRIPT, each.start(), each.end())
        end = each.end()
    yield from markup_spans(text, end, len(text))


def markup_spans(text: str, start: int, stop: int) -> Iterator[tuple[int, int]]:
    """Yield the prose between tags, and of the strings in them."""
    for tag in TAG.finditer(text, start, stop):
        yield start, tag.start()
        yield from literal_spans(text, STRING, tag.start(), tag.end())
        start = tag.end()
    yield start, stop


def literal_spans(
    text: str, pattern: re.Pattern[str], start: int, stop: int
) -> Iterator[tuple[int, int]]:
    """Yield the prose of comments and strings; a string that is one name is none."""
    for each in pattern.finditer(text, start, stop):
        group = each.lastgroup
        if group in (None, "skip") or (group != "prose" and not re.search(r"\w\s+\w", each[0])):
            continue
        yield from without(text, CODE_IN.get(group, BACKTICKED), each.start(), each.end())


def without(text: str, code: re.Pattern[str], start: int, stop: int) -> Iterator[tuple[int, int]]:
    """Yield what of a span is not code."""
    for each in code.finditer(text, start, stop):
        yield start, each.start()
        start = each.end()
    yield start, stop


def phrase_findings(prose: str, rules: Rules) -> Iterator[tuple[int, str, str]]:
    """Yield the forbidden phrases of prose: where, what, and what to write instead."""
    end = 0
    for word in WORD.finditer(prose):
        if word.start() < end:
            continue
        for phrase in rules.phrases.get(word[0].lower(), []):
            if found := phrase.pattern.match(prose, word.start()):
                end = found.end()
                if phrase.instead:
                    yield found.start(), found[0], phrase.instead
                break


def name_findings(code: str, rules: Rules) -> Iterator[tuple[int, str, str]]:
    """Yield the first use of each forbidden name: where, what, and what to write instead."""
    first = {name[0]: name.start() for name in reversed(list(NAME.finditer(code)))}
    for name, start in first.items():
        if instead := rules.name_instead(name):
            yield start, name, instead


if __name__ == "__main__":
    main()
