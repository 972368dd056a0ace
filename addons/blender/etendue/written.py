"""What is said of a scene beside the exporter's GLB, gathered by all that read the scene."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from .nodes import Seen

Document = dict[str, Any]


@dataclass(frozen=True)
class Texture:
    """Holds an image that is to be a base colour: whether its alpha counts, or darkens its colours, the UV map that
    lays it, "" for the mesh's own, and glTF's KHR_texture_transform and sampler for it."""

    image: Any
    with_alpha: bool = False
    times_alpha: bool = False
    uv_map: str = ""
    transform: Document = field(default_factory=dict)
    sampler: Document = field(default_factory=dict)


@dataclass
class Written:
    """Holds render.json, an image that its environment needs, changes of the GLB's materials by their names, and notes."""

    document: Document = field(default_factory=dict)
    world_image: Any = None
    blended: set[str] = field(default_factory=set)  # whose alpha is coverage, where the exporter drops or cuts it
    alphas: dict[str, float] = field(default_factory=dict)  # multiply what the exporter has
    textures: dict[str, Texture] = field(default_factory=dict)  # base colours that the exporter lacks
    opaque: set[str] = field(default_factory=set)  # whose alpha the exporter takes from an image without alpha
    unbumped: set[str] = field(default_factory=set)  # whose normal map is a height map
    tangents: dict[str, tuple[str, str]] = field(default_factory=dict)  # UV maps of a normal map's image and tangents
    bare: set[str] = field(default_factory=set)  # whose surface the exporter has taken from a shader that is not shown
    dark: set[str] = field(default_factory=set)  # whose light it has taken from such a one
    shown: dict[str, list[Seen]] = field(default_factory=dict)  # the shaders that are read
    left_out: set[str] = field(default_factory=set)  # whose surfaces are not there
    notes: list[str] = field(default_factory=list)

    def note(self, text: str) -> None:
        """Says once what is not brought over."""
        if text not in self.notes:
            self.notes.append(text)
