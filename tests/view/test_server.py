"""Who gets what from the local server: its own pages all, others nothing."""

from __future__ import annotations

import http.client
import json
import re
from base64 import b64encode
from collections.abc import Iterator
from hashlib import sha256
from pathlib import Path
from typing import Any

import pytest
from view.test_following import CRANK

import mechkin_cli as mk
from mechkin_cli.view import Follower, LiveServer, Wish


@pytest.fixture
def server(tmp_path: Path) -> Iterator[LiveServer]:
    path = tmp_path / "crank.yaml"
    path.write_text(CRANK)
    follower = Follower(
        path, lambda text, name, at: mk.loads(text, name, folder=at), Wish(modes=False)
    )
    found = LiveServer(follower)
    follower.start()
    found.start()
    assert follower.wait(0, 20.0)
    yield found
    found.close()


def answer(
    server: LiveServer, path: str, method: str = "GET", body: Any = None, **headers: str
) -> tuple[int, str, dict[str, str]]:
    """Code, content and headers for a request; `_` in the name of a header stands for a dash."""
    link = http.client.HTTPConnection(server.place, timeout=20)
    given = {name.replace("_", "-"): value for name, value in headers.items()}
    text = body if body is None or isinstance(body, str) else json.dumps(body)
    link.request(method, path, text, given)
    found = link.getresponse()
    content = found.read().decode()
    link.close()
    return found.status, content, {name.lower(): value for name, value in found.getheaders()}


def test_a_page_gets_what_it_needs(server: LiveServer) -> None:
    home = f"/{server.token}/"
    code, shell, headers = answer(server, home)
    assert code == 200
    policy = headers["content-security-policy"]
    for kind in ("style", "script"):
        (text,) = re.findall(f"<{kind}>(.*?)</{kind}>", shell, re.DOTALL)
        digest = b64encode(sha256(text.encode()).digest()).decode()
        assert f"{kind}-src 'sha256-{digest}'" in policy
    assert "default-src 'none'" in policy
    code, frame, headers = answer(server, home + "frame")
    assert code == 200
    assert '<script type="application/json" id="mechkin-data">null</script>' in frame
    assert headers["content-security-policy"].startswith("sandbox allow-scripts")
    assert "allow-same-origin" not in headers["content-security-policy"]
    picture = server.follower.seen.picture
    assert picture is not None
    code, data, _ = answer(server, f"{home}data/{picture.number}")
    assert (code, json.loads(data)["name"]) == (200, "crank")
    assert answer(server, f"{home}data/999")[:2] == (204, "")
    for path in ("nothing", "data", "data/1/2", "parameters", "../frame"):
        assert answer(server, home + path)[0] == 404


def test_others_get_nothing(server: LiveServer) -> None:
    home, port = f"/{server.token}/", server.server_address[1]
    other = "y" if server.token.endswith("x") else "x"
    refused = [
        answer(server, "/"),
        answer(server, "/frame"),
        answer(server, f"/{server.token[:-1]}{other}/"),
        answer(server, f"/{server.token}"),
        answer(server, home, Host=f"evil.example:{port}"),
        answer(server, home, Host=f"localhost:{port}"),
        answer(server, home, Origin="http://evil.example"),
        answer(server, home, Origin="null"),
        answer(server, home + "news", Sec_Fetch_Site="cross-site"),
        answer(server, home + "parameters", "POST", {}),
        answer(server, home + "parameters", "POST", {}, Origin="null"),
        answer(server, home + "parameters", "POST", {}, Origin=f"http://localhost:{port}"),
    ]
    assert {code for code, _, _ in refused} <= {403, 421}
    assert all("mechkin-data" not in content for _, content, _ in refused)
    for method in ("PUT", "DELETE", "OPTIONS", "HEAD"):
        assert answer(server, home, method)[0] == 501


def test_news_come_as_they_are_seen_and_end(server: LiveServer) -> None:
    link = http.client.HTTPConnection(server.place, timeout=20)
    link.request("GET", f"/{server.token}/news")
    stream = link.getresponse()
    assert stream.getheader("Content-Type") == "text/event-stream"

    def next_news() -> Any:
        while True:
            line = stream.readline()
            assert line
            if line.startswith(b"data: "):
                return json.loads(line[6:])

    first = next_news()
    # parameters, and numbers that are written as such
    places = {"joints.O.point.x", "joints.O.point.y", "joints.O.point.z", "points.tip.at.z"}
    assert first["picture"]["parameters"] == {"r": 40, "e": 20, **dict.fromkeys(places, 0)}
    assert first["faults"] == []
    server.follower.path.write_text(CRANK.replace("parameters", "<b>"))
    second = next_news()
    assert second["faults"][0]["line"] == 4
    assert second["picture"] == first["picture"]
    server.close()
    assert next_news()["ended"] is True
    assert stream.readline() == b"\n"
    assert stream.read() == b""


def test_values_are_written(server: LiveServer) -> None:
    path = f"/{server.token}/parameters"
    origin = {"Origin": f"http://{server.place}"}
    asked = {"hash": server.follower.seen.hash, "values": {"r": 44, "e": 21}}
    code, text, _ = answer(server, path, "POST", asked, **origin)
    assert code == 200
    assert json.loads(text)["written"] == {"r": "44 mm"}
    assert json.loads(text)["expressions"] == {"e": "r/2"}
    assert server.follower.path.read_text() == CRANK.replace("40 mm", "44 mm")
    code, text, _ = answer(server, path, "POST", asked, **origin)
    assert (code, "has changed since" in text) == (409, True)


@pytest.mark.parametrize(
    ("body", "code", "words"),
    [
        ("{", 400, "not what a page asks"),
        ("[]", 400, "no hash"),
        ('{"hash": 1}', 400, "no hash"),
        ('{"hash": "x", "values": []}', 400, "no values"),
        ('{"hash": "x", "values": {"r": "44 mm\\nlinks: {}"}}', 400, "not a number"),
        ('{"hash": "x", "values": {"r": true}}', 400, "not a number"),
        ('{"hash": "x", "values": {"r": NaN}}', 400, "not a number"),
        ('{"hash": "x", "values": {"r": 1e999}}', 400, "not a number"),
        ('{"hash": "x", "values": {"r": ' + "9" * 400 + "}}", 400, "not what"),
        ("[" * 60_000, 400, "not what"),
        ('"' + "x" * 70_000 + '"', 400, "limit 65536 bytes"),
        ('{"hash": "x", "values": {"r": 1}, "replace": [1]}', 400, "not a text"),
        ('{"hash": "x", "values": {"r": 1}}', 409, "has changed since"),
    ],
)
def test_what_no_page_asks_is_refused(server: LiveServer, body: str, code: int, words: str) -> None:
    path = f"/{server.token}/parameters"
    found, text, _ = answer(server, path, "POST", body, Origin=f"http://{server.place}")
    assert (found, words in text) == (code, True), text
    assert server.follower.path.read_text() == CRANK
