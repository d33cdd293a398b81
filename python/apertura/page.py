"""The window in a notebook: the page, if it is there, on a server of this process."""

from __future__ import annotations

import functools
import html
import os
import secrets
import threading
import weakref
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

from ._apertura import Scene

#: What the folder of a page has.
_NEEDED = ("index.html", "start.js")

#: Where pages send their scenes, and the most bytes of one.
_CELLS = "/cell/"
_MOST_BYTES = 16 << 20

#: What lets the browser lend threads to a page in a tab of its own, and another origin embed it.
_HEADERS = {
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Embedder-Policy": "require-corp",
    "Cross-Origin-Resource-Policy": "cross-origin",
    "Cache-Control": "no-cache",
}

#: Each cell's scene file, as its page sent it last; None before.
_scenes: dict[str, str | None] = {}
_servers: dict[tuple[int, Path], ThreadingHTTPServer] = {}
_lock = threading.Lock()


class Shown:
    """The window in a cell of a notebook. `url` is its address, for any browser on this machine."""

    def __init__(self, url: str, height: int, scene: Scene, cell: str) -> None:
        self.url = url
        self.height = height
        self._scene = scene
        self._cell = cell
        _scenes[cell] = None
        weakref.finalize(self, _scenes.pop, cell, None)

    @property
    def scene(self) -> Scene:
        """The scene as it was changed in the window, a moment ago; the one that was shown where nothing was changed.

        Raises:
            ValueError: The page sent no scene file.
        """
        text = _scenes.get(self._cell)
        return Scene.from_toml(_without_document(text)) if text else self._scene

    def _repr_html_(self) -> str:
        return f'<iframe src="{html.escape(self.url)}" width="100%" height="{self.height}" style="border: 0" allow="clipboard-write"></iframe>'

    def __repr__(self) -> str:
        return f"<the window at {self.url}>"


def find_page() -> Path:
    """Folder of the page: $APERTURA_PAGE, or beside this module.

    Raises:
        FileNotFoundError: It is in neither; the message says how to get it.
    """
    given = os.environ.get("APERTURA_PAGE")
    folder = Path(given) if given else Path(__file__).parent / "page"
    missing = [name for name in _NEEDED if not (folder / name).is_file()]
    if missing:
        raise FileNotFoundError(
            f"{folder} has no {missing[0]}: the page is not there. `scripts/web` in the repository of apertura makes it in target/web; set "
            "APERTURA_PAGE to that folder. A wheel of a release has it inside"
        )
    return folder.resolve()


def show(scene: Scene, *, floor: str = "thesis", normalisation: str = "min-max", method: str = "live", height: int = 720) -> Shown:
    """Shows the window on a scene in a cell of a notebook. What is changed there is read back as `show(scene).scene`.

    The page is served on this machine alone, until this process ends.

    Args:
        scene: The scene.
        floor: What lies beneath it.
        normalisation: How maps are normalised.
        method: The method that is shown.
        height: Of the cell, pixels.

    Raises:
        FileNotFoundError: The page is not there.
        ValueError: A name is unknown, or the scene is too large for an address.
        OSError: No server can be started.
    """
    text = scene.to_text(floor=floor, normalisation=normalisation, method=method)
    cell = secrets.token_urlsafe(16)
    return Shown(f"{_address(find_page())}?cell={cell}#{text}", height, scene, cell)


def _without_document(text: str) -> str:
    """The scene file within the window's copy of a document: that has a last table more, which says where the document belongs."""
    scene, table, _ = text.rpartition("[document]\n")
    return scene if table else text


def _address(folder: Path) -> str:
    # A forked process has no thread of its parent's.
    key = (os.getpid(), folder)
    with _lock:
        server = _servers.get(key)
        if server is None:
            server = ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(_Files, directory=str(folder)))
            server.daemon_threads = True
            threading.Thread(target=server.serve_forever, name="the page of apertura", daemon=True).start()
            _servers[key] = server
    return f"http://127.0.0.1:{server.server_address[1]}/"


class _Files(SimpleHTTPRequestHandler):
    extensions_map = {**SimpleHTTPRequestHandler.extensions_map, ".wasm": "application/wasm", ".js": "text/javascript", ".html": "text/html"}

    def log_message(self, format: str, *values: object) -> None:
        """A notebook is no log."""

    def do_POST(self) -> None:
        """A page sends its scene. No other page knows the name of its cell."""
        cell = self.path.removeprefix(_CELLS)
        length = self.headers.get("Content-Length", "")
        if not self.path.startswith(_CELLS) or cell not in _scenes:
            return self.send_error(404, "no such cell")
        if not length.isdecimal() or int(length) > _MOST_BYTES:
            return self.send_error(413, f"expected a scene of at most {_MOST_BYTES} bytes")
        _scenes[cell] = self.rfile.read(int(length)).decode("utf-8", "replace")
        self.send_response(204)
        self.end_headers()

    def end_headers(self) -> None:
        for name, value in _HEADERS.items():
            self.send_header(name, value)
        super().end_headers()
