"""The window in a notebook: the page, if it is there, on a server of this process."""

from __future__ import annotations

import functools
import html
import os
import threading
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

from ._apertura import Scene

#: What the folder of a page has.
_NEEDED = ("index.html", "start.js")

_servers: dict[tuple[int, Path], ThreadingHTTPServer] = {}
_lock = threading.Lock()


class Shown:
    """The window in a cell of a notebook. `url` is its address, for any browser on this machine."""

    def __init__(self, url: str, height: int) -> None:
        self.url = url
        self.height = height

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
    """Shows the window on a scene in a cell of a notebook. What is changed there stays there: *Copy scene as text* brings it back.

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
    return Shown(f"{_address(find_page())}#{text}", height)


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

    def end_headers(self) -> None:
        self.send_header("Cache-Control", "no-cache")
        super().end_headers()
