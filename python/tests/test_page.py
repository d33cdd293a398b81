"""The window in a notebook."""

import urllib.request

import pytest

import apertura as ap

SCENE = ap.Scene.random("2", seed=5)


@pytest.fixture
def page(tmp_path, monkeypatch):
    for name in ("index.html", "start.js", "apertura-page_bg.wasm"):
        (tmp_path / name).write_text(f"this is {name}")
    monkeypatch.setenv("APERTURA_PAGE", str(tmp_path))
    return tmp_path


def test_a_cell_shows_the_page_on_the_scene(page):
    shown = ap.show(SCENE, floor="snr=20", height=500)
    address, text = shown.url.split("#")
    assert text.startswith("apertura:1:") and text == SCENE.to_text(floor="snr=20")
    assert shown.url.split("#")[0] in shown._repr_html_() and 'height="500"' in shown._repr_html_()
    with urllib.request.urlopen(address, timeout=30) as answer:
        assert answer.read() == b"this is index.html"
    with urllib.request.urlopen(address + "apertura-page_bg.wasm", timeout=30) as answer:
        assert answer.headers["Content-Type"] == "application/wasm"


def test_one_server_serves_all_cells(page):
    assert ap.show(SCENE).url.split("#")[0] == ap.show(ap.Scene.preset("street")).url.split("#")[0]


def test_a_missing_page_is_told(tmp_path, monkeypatch):
    monkeypatch.setenv("APERTURA_PAGE", str(tmp_path))
    with pytest.raises(FileNotFoundError, match="scripts/web"):
        ap.show(SCENE)
    monkeypatch.delenv("APERTURA_PAGE")


def test_unusable_names_are_told(page):
    for given, words in (({"floor": "rock"}, "rock"), ({"method": "magic"}, "magic"), ({"normalisation": "x"}, "x")):
        with pytest.raises(ValueError, match=words):
            ap.show(SCENE, **given)
