"""Built distributions contain the page and all bundled files."""

import os
import shutil
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

needs_npm = pytest.mark.skipif(
    shutil.which("npm") is None and "CI" not in os.environ, reason="the page is built by npm"
)


def built(kind: str, folder: Path) -> Path:
    """Build a distribution of this clone, with the compiled module as it is installed for tests."""
    settings = {"build-args": "--profile dev"} if kind == "wheel" else None
    code = f"import backend, sys; backend.build_{kind}(sys.argv[1], {settings})"
    done = subprocess.run(
        [sys.executable, "-c", code, str(folder)],
        cwd=ROOT,
        env=os.environ | {"PYTHONPATH": "packaging"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr[-2000:]
    (made,) = folder.iterdir()
    return made


def check_page(index: str, names: set[str], inside: str) -> None:
    """Check that all files to which the page refers are present, and their compressed forms."""
    referenced = [part.split('"')[0] for part in index.split('="./')[1:]]
    assert any(name.endswith(".js") for name in referenced)
    assert {f"{inside}/{name}" for name in referenced} <= names
    in_assets = [name for name in names if name.startswith(f"{inside}/assets/")]
    hashed = [name for name in in_assets if name.endswith((".js", ".css"))]
    assert {f"{name}{ending}" for name in hashed for ending in (".br", ".gz")} <= names


def check_bundled(names: set[str], inside: str) -> None:
    """Check that all bundled scenarios, fleets and schemas are present."""
    package = ROOT / "python/agent_economy"
    for folder in ("scenarios", "fleets", "schemas"):
        bundled = [file.name for file in (package / folder).iterdir()]
        assert bundled
        assert {f"{inside}/{folder}/{name}" for name in bundled} <= names


@needs_npm
def test_a_wheel_contains_the_built_page_and_all_bundled_files(tmp_path: Path) -> None:
    with zipfile.ZipFile(built("wheel", tmp_path)) as wheel:
        index = wheel.read("agent_economy/web/index.html").decode()
        check_page(index, set(wheel.namelist()), "agent_economy/web")
        check_bundled(set(wheel.namelist()), "agent_economy")


@needs_npm
def test_an_sdist_contains_the_built_page_and_all_bundled_files(tmp_path: Path) -> None:
    with tarfile.open(built("sdist", tmp_path)) as sdist:
        names = set(sdist.getnames())
        root = min(names, key=len).split("/")[0]
        inside = f"{root}/python/agent_economy/web"
        index = sdist.extractfile(f"{inside}/index.html")
        assert index is not None
        check_page(index.read().decode(), names, inside)
        check_bundled(names, f"{root}/python/agent_economy")
