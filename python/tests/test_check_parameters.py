"""The check of parameters that are anonymous tuples."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "scripts"))

from check_parameters import of_python, of_rust

RUST = """
fn plain(a: (u8, u8), f: impl Fn(u8, u8, u8) -> u8, (b, c): (Map<u8, u8>, [u8; 3])) {}
fn long<T: Fn(u8) -> u8>(&self, x: u8, (a, b, c): &'static mut (u8, Vec<(u8, u8)>, T)) {}
// fn noted(a: (u8, u8, u8)) {}
#[cfg(test)]
mod tests {
    fn tested(a: (u8, u8, u8)) {}
}
"""
PYTHON = """
def plain(a: tuple[int, int], *, b: tuple[int, ...] = (), c: list[tuple[int, int, int]]): ...
async def long(a: tuple[int, tuple[str, ...], int], *, b: tuple[int, int, int]): ...
"""


@pytest.mark.parametrize(
    ("of", "text", "found"),
    [(of_rust, RUST, ["long (a, b, c)"]), (of_python, PYTHON, ["long a", "long b"])],
)
def test_parameters_that_are_tuples_of_three_or_more_are_found(of, text, found) -> None:  # type: ignore[no-untyped-def]
    assert list(of(text)) == found
