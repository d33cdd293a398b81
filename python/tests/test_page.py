"""The window in a notebook."""

import gc
import os
import shutil
import time
import urllib.error
import urllib.request
from pathlib import Path

import pytest

import apertura as ap

SCENE = ap.Scene.random("2", seed=5)
#: A page that was built, if there is one: `scripts/test-python` names it.
BUILT = Path(os.environ.get("PAGE_FOLDER", "none"))


@pytest.fixture
def page(tmp_path, monkeypatch):
    for name in ("index.html", "start.js", "apertura-page_bg.wasm"):
        (tmp_path / name).write_text(f"this is {name}")
    monkeypatch.setenv("APERTURA_PAGE", str(tmp_path))
    return tmp_path


def test_a_cell_shows_the_page_on_the_scene(page):
    shown = ap.show(SCENE, floor="snr=20", height=500)
    address, text = shown.url.split("#")
    address = address.split("?")[0]
    assert text.startswith("apertura:1:") and text == SCENE.to_text(floor="snr=20")
    assert shown.url.split("#")[0] in shown._repr_html_() and 'height="500"' in shown._repr_html_()
    with urllib.request.urlopen(address, timeout=30) as answer:
        assert answer.read() == b"this is index.html"
    with urllib.request.urlopen(address + "apertura-page_bg.wasm", timeout=30) as answer:
        assert answer.headers["Content-Type"] == "application/wasm"


def test_one_server_serves_all_cells(page):
    assert ap.show(SCENE).url.split("?")[0] == ap.show(ap.Scene.preset("street")).url.split("?")[0]


def _send(shown, body, cell=None):
    address, rest = shown.url.split("?cell=")
    to = f"{address}cell/{cell or rest.split('#')[0]}"
    with urllib.request.urlopen(urllib.request.Request(to, data=body), timeout=30) as answer:
        return answer.status


def test_a_scene_that_the_page_sends_is_read_back(page):
    shown, other = ap.show(SCENE), ap.show(SCENE)
    changed = ap.Scene.of_points([(1.0, 12.0)])
    assert shown.scene == SCENE
    assert _send(shown, (changed.to_toml() + "\n[document]\n").encode()) == 204
    assert shown.scene == changed and other.scene == SCENE
    assert _send(shown, b"") == 204
    assert shown.scene == SCENE


def test_what_is_no_scene_is_refused(page):
    shown = ap.show(SCENE)
    with pytest.raises(urllib.error.HTTPError, match="404"):
        _send(shown, b"", cell="another")
    _send(shown, b"smell = 1")
    with pytest.raises(ValueError, match="smell"):
        _ = shown.scene
    gone = shown.url
    del shown
    gc.collect()
    with pytest.raises(urllib.error.HTTPError, match="404"):
        _send(ap.show(SCENE), b"", cell=gone.split("?cell=")[1].split("#")[0])


@pytest.mark.skipif(not (BUILT / "index.html").is_file() or not shutil.which("chromium"), reason="needs a page that was built (PAGE_FOLDER or target/web) and chromium")
def test_a_scene_of_python_comes_back_as_it_was_dragged_in_the_page(monkeypatch):
    playwright = pytest.importorskip("playwright.sync_api")
    monkeypatch.setenv("APERTURA_PAGE", str(BUILT))
    # Unlike the scene that a page opens by itself, but for the place of one point.
    given = ap.Scene([ap.Point(-9.0, 30.0, 0.81), ap.Point(1.5, 8.0, 0.37)], name="of Python", noise_seed=77)
    shown = ap.show(given, floor="snr=20", method="capon", height=900)
    quiet = ["--no-sandbox", "--enable-unsafe-swiftshader", "--use-gl=angle", "--use-angle=swiftshader"]
    with playwright.sync_playwright() as p:
        browser = p.chromium.launch(executable_path=shutil.which("chromium"), args=quiet)
        notebook = browser.new_page(viewport={"width": 1440, "height": 900})
        notebook.set_content(f"<style>body {{ margin: 0 }}</style>{shown._repr_html_()}")
        cell = notebook.frames[1]
        # A function, since the page forbids to evaluate text.
        cell.wait_for_function("() => document.getElementById('cover')?.hidden", timeout=120_000)
        notebook.wait_for_timeout(5000)
        # The point at (1.5, 8) m.
        notebook.mouse.move(263, 291)
        notebook.mouse.down()
        for step in range(1, 6):
            notebook.mouse.move(263 + 57 * step / 5, 291 - 31 * step / 5)
            notebook.wait_for_timeout(300)
        notebook.mouse.up()
        deadline = time.monotonic() + 60
        while shown.scene == given and time.monotonic() < deadline:
            notebook.wait_for_timeout(500)
        browser.close()
    found = shown.scene
    assert (found.name, found.noise_seed, found.radar) == ("of Python", 77, given.radar)
    still, moved = found.objects
    assert still == given.objects[0] and moved.reflectivity == 0.37
    assert moved.x_metres > 2.5 and moved.y_metres > 9.0


def test_a_missing_page_is_told(tmp_path, monkeypatch):
    monkeypatch.setenv("APERTURA_PAGE", str(tmp_path))
    with pytest.raises(FileNotFoundError, match="scripts/web"):
        ap.show(SCENE)
    monkeypatch.delenv("APERTURA_PAGE")


def test_unusable_names_are_told(page):
    for given, words in (({"floor": "rock"}, "rock"), ({"method": "magic"}, "magic"), ({"normalisation": "x"}, "x")):
        with pytest.raises(ValueError, match=words):
            ap.show(SCENE, **given)
