"""The prose check finds planted phrases and names, and nothing in good prose."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "scripts"))

from check_prose import Rules, check_text

RULES = Rules.load()

PLANTED = {
    "docs/a.md": "The robot is told where\nit stands.",
    "crates/a/src/a.rs": "/// How it is done, in at most\n/// so many steps.\nfn step() {}",
    "crates/a/src/b.rs": 'let error = format!("{name} must be given in quotes");',
    "python/a.py": 'def step():\n    """Give back the robot\'s state."""',
    "python/b.py": 'text = f"the {brain} has its way"',
    "web/src/a.ts": "/** Whom the robot follows. */",
    "web/src/b.ts": "const label = `${name} for sure`;",
    "web/src/a.svelte": '<p class="note">The study is <b>{count}</b> runs anew.</p>',
    "web/src/b.svelte": '<Slider label="How sure" value={a > b} />',
    "scenarios/a.toml": "# The robot hears nothing.",
    "Makefile": "golden: ## Measure it anew",
}


@pytest.mark.parametrize(("path", "text"), PLANTED.items())
def test_a_planted_phrase_is_found(path: str, text: str) -> None:
    assert len(check_text(text, path, RULES)) == 1


@pytest.mark.parametrize(
    ("path", "text"),
    {
        "docs/a.md": "Set `world.wraps` in metres.",
        "crates/a/src/a.rs": "fn most_noise() {}",
        "python/a.py": "mind = None",
        "web/src/a.ts": "export type SoughtItem = string;",
        "scenarios/a.toml": "cap_s = 20",
    }.items(),
)
def test_a_forbidden_name_is_found(path: str, text: str) -> None:
    assert len(check_text(text, path, RULES)) == 1


@pytest.mark.parametrize(
    ("path", "text"),
    {
        "docs/a.md": "The brain publishes it.\n\n```\n$ say hello\n```\nKeep `say` in mind.",
        "crates/a/src/a.rs": '/// Returns at most `n` items.\nfn items() { panic!("{say}") }',
        "python/a.py": 'verb = "say"  # one word in a string is a name',
        "web/src/a.svelte": '<p class="say">{say(1)}</p>\n<style>p { color: gray; }</style>',
    }.items(),
)
def test_code_and_right_uses_are_no_findings(path: str, text: str) -> None:
    assert not check_text(text, path, RULES)


def test_a_finding_names_its_line_and_the_replacement() -> None:
    (finding,) = check_text("Good.\n\nIt ends for sure.", "docs/a.md", RULES)
    assert str(finding).startswith('docs/a.md:3: "for sure": with 95%')


def test_an_exemption_covers_its_place_only_and_must_be_needed() -> None:
    allow = [{"path": "docs/a.md", "found": "for sure", "reason": "a quotation"}]
    rules = Rules(RULES.phrases, RULES.names, allow)
    assert list(rules.unused())
    (finding,) = check_text("For sure.", "docs/a.md", rules)
    (elsewhere,) = check_text("For sure.", "docs/b.md", rules)
    assert rules.allows(finding)
    assert not rules.allows(elsewhere)
    assert not list(rules.unused())
