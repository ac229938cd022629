"""The check of import circles reads the uses among Rust modules."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "scripts"))

from check_cycles import cycles
from rust_modules import Crate, Module


def uses(folder: Path, **files: str) -> dict[Module, set[Module]]:
    """Return the uses among the modules of a crate; file names have __ for a slash."""
    for name, code in files.items():
        file = folder / f"{name.replace('__', '/')}.rs"
        file.parent.mkdir(exist_ok=True)
        file.write_text(code, encoding="utf-8")
    return Crate(folder / "lib.rs").uses()


@pytest.mark.parametrize(
    "code",
    [
        "use crate::b::B; fn f(b: B) {}",
        "use super::b::{self, C}; fn f() -> b::B {}",
        "use super::{b::{B as Other}}; fn f(b: Other) {}",
        "use crate::b; fn f(b: b::B) {}",
        "use crate::b::*; fn f(b: B) {}",
        "fn f(b: crate::b::B) {}",
        "use crate::B; fn f(b: B) {}",
    ],
)
def test_a_use_is_found_in_every_notation(tmp_path: Path, code: str) -> None:
    found = uses(tmp_path, lib="mod a; mod b; pub use b::B;", a=code, b="pub struct B;")
    assert found[("a",)] == {("b",)}


@pytest.mark.parametrize(
    "code",
    [
        "// use crate::b::B;",
        'const TEXT: &str = "crate::b::B";',
        "use std::b::B; fn f(b: B) {}",
        "#[cfg(test)] mod tests { use crate::b::B; fn f(b: B) {} }",
        "pub use crate::b::B;",
    ],
)
def test_comments_strings_tests_and_exports_are_not_uses(tmp_path: Path, code: str) -> None:
    assert not uses(tmp_path, lib="mod a; mod b;", a=code, b="pub struct B;")[("a",)]


def test_a_reexported_name_belongs_to_the_file_that_defines_it(tmp_path: Path) -> None:
    found = uses(
        tmp_path,
        lib="mod a; mod folder;",
        a="use crate::folder::{B, C}; pub fn f(b: B) -> C {}",
        folder__mod="mod b; mod c; pub use b::B; pub use self::c::*;",
        folder__b="use crate::a::f; pub struct B; const _: () = f();",
        folder__c="pub struct C;",
    )
    assert found[("a",)] == {("folder", "b"), ("folder", "c")}
    assert not found[("folder",)]
    assert found[("folder", "b")] == {("a",)}


def test_a_child_that_uses_its_parent_is_in_a_circle_with_it(tmp_path: Path) -> None:
    code = "pub fn a(a: super::Shared) {}"
    found = uses(tmp_path, lib="mod a; pub use a::a; struct Shared;", a=code)
    assert found == {(): set(), ("a",): {()}}
    found = uses(tmp_path, lib="mod a; struct Shared; fn g() { a::a(); }", a=code)
    assert found == {(): {("a",)}, ("a",): {()}}


def test_circles_are_found_without_the_modules_that_only_use_them() -> None:
    graph = {"a": {"b"}, "b": {"c"}, "c": {"a", "d"}, "d": set[str](), "e": {"a"}, "f": {"f"}}
    assert list(cycles(graph)) == [["a", "b", "c"], ["f"]]
    assert not list(cycles({"a": {"b", "c"}, "b": {"c"}, "c": set[str]()}))
