"""What pickle calls to make scenes and radars again."""

from typing import Any

from ._apertura import Radar, Scene


def radar(fields: dict[str, Any]) -> Radar:
    return Radar(**fields)


def scene(toml: str) -> Scene:
    return Scene.from_toml(toml)
