"""What a scene's module hands over."""

from dataclasses import dataclass, field

from .gltf import GltfWriter, to_json


@dataclass
class GeneratedScene:
    """A scene in memory, and what must be true of it."""

    gltf: GltfWriter = field(default_factory=GltfWriter)
    #: Other files of the directory, by name.
    files: dict[str, bytes] = field(default_factory=dict)
    #: Values that the hand-written render.json must agree with, by JSON pointer.
    render_json: dict[str, object] = field(default_factory=dict)
    #: Triangles of all meshes, each mesh counted once.
    triangles: int = 0
    #: Names of the meshes that must be watertight.
    closed_meshes: set[str] = field(default_factory=set)

    def contents(self):
        """Every file of the directory that is generated, as bytes by name."""
        document, binary = self.gltf.finish()
        return {"scene.gltf": to_json(document).encode(), "scene.bin": binary, **self.files}
