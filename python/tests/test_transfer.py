"""How the page and its data are transferred: what is compressed, and what browsers keep."""

import gzip
from pathlib import Path

import pytest
from starlette.applications import Starlette
from starlette.routing import Mount
from starlette.testclient import TestClient

from agent_economy.server.transfer import PageFiles, preferred

TEXT = b"const robots = 1;\n" * 100
CODINGS = ["br", "gzip"]


@pytest.fixture
def files(tmp_path: Path) -> TestClient:
    """Return a client of a built page; its Brotli file is none, and is never unpacked."""
    (tmp_path / "assets").mkdir()
    (tmp_path / "assets" / "index-1.js").write_bytes(TEXT)
    (tmp_path / "assets" / "index-1.js.gz").write_bytes(gzip.compress(TEXT))
    (tmp_path / "assets" / "index-1.js.br").write_bytes(b"brotli")
    (tmp_path / "favicon.svg").write_bytes(b"<svg/>")
    page = Starlette(routes=[Mount("/", PageFiles(directory=tmp_path))])
    return TestClient(page)


@pytest.mark.parametrize(
    ("accepted", "expected"),
    [
        ("gzip, deflate, br, zstd", "br"),
        ("gzip", "gzip"),
        ("GZIP", "gzip"),
        ("br;q=0.5, gzip;q=0.9", "gzip"),
        ("br;q=0, gzip;q=0", None),
        ("*", "br"),
        ("br;q=0, *;q=0.1", "gzip"),
        ("identity", None),
        ("", None),
        ("gzip;q=high, br;level=3", None),
        (";;, =;q", None),
    ],
)
def test_the_coding_with_the_highest_weight_is_selected(
    accepted: str, expected: str | None
) -> None:
    assert preferred(accepted, CODINGS) == expected


def test_a_script_is_sent_compressed_with_its_own_media_type(files: TestClient) -> None:
    response = files.get("/assets/index-1.js", headers={"accept-encoding": "gzip"})
    assert response.headers["content-encoding"] == "gzip"
    assert response.headers["content-type"].startswith("text/javascript")
    assert response.content == TEXT
    assert int(response.headers["content-length"]) < len(TEXT)


def test_a_client_that_accepts_no_coding_gets_the_file_itself(files: TestClient) -> None:
    response = files.get("/assets/index-1.js", headers={"accept-encoding": "identity"})
    assert "content-encoding" not in response.headers
    assert response.content == TEXT


def test_caches_keep_the_forms_of_a_file_apart(files: TestClient) -> None:
    tags = set()
    for accepted in ("gzip", "br", "identity"):
        headers = {"accept-encoding": accepted}
        with files.stream("GET", "/assets/index-1.js", headers=headers) as response:
            assert response.headers["vary"] == "Accept-Encoding"
            tags.add(response.headers["etag"])
    assert len(tags) == 3


def test_files_with_a_hash_in_their_name_are_kept_forever_and_others_revalidated(
    files: TestClient,
) -> None:
    hashed = files.get("/assets/index-1.js", headers={"accept-encoding": "gzip"})
    assert hashed.headers["cache-control"] == "public, max-age=31536000, immutable"
    assert files.get("/favicon.svg").headers["cache-control"] == "no-cache"
    assert "cache-control" not in files.get("/assets/index-2.js").headers


def test_a_file_that_has_not_changed_is_not_sent_again(files: TestClient) -> None:
    headers = {"accept-encoding": "gzip"}
    tag = files.get("/assets/index-1.js", headers=headers).headers["etag"]
    again = files.get("/assets/index-1.js", headers={**headers, "if-none-match": tag})
    assert (again.status_code, again.content) == (304, b"")


def test_pictures_are_compressed_for_clients_that_accept_it(client: TestClient) -> None:
    address = "/api/pictures?scenario=flock"
    small = client.get(address, headers={"accept-encoding": "gzip"})
    assert small.headers["content-encoding"] == "gzip"
    plain = client.get(address, headers={"accept-encoding": "gzip;q=0"})
    assert "content-encoding" not in plain.headers
    assert plain.content == small.content
    assert int(small.headers["content-length"]) < len(plain.content) / 2
