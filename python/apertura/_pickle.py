"""What pickle calls to make objects of the compiled module again."""

from typing import Any

from ._apertura import Examples, Maps, Method, Radar, Recording, Scene, method as _method
from ._apertura import _maps, _recording


def radar(fields: dict[str, Any]) -> Radar:
    return Radar(**fields)


def scene(toml: str) -> Scene:
    return Scene.from_toml(toml)


def method(fields: dict[str, Any]) -> Method:
    return Method.of_function(**fields) if "function" in fields else _method(**fields)


def maps(fields: dict[str, Any]) -> Maps:
    return _maps(**fields)


def recording(fields: dict[str, Any]) -> Recording:
    return _recording(**fields)


def examples(fields: dict[str, Any]) -> Examples:
    return Examples(**fields)
