"""What each scene of the gallery is built on: a scene with its render.json, textured materials and many copies."""

import math

from ..generated_scene import GeneratedScene
from ..vector import look_at


class Stage(GeneratedScene):
    """A generated scene that writes its own render.json, whose keys are in `render_json` by JSON pointer."""

    def textured(self, name, texture=None, normal=None, roughness_texture=None, normal_scale=1.0, **material):
        """A material with textures by index; the rest as of GltfWriter.add_material."""
        index = self.gltf.add_material(name, base_color_texture=texture, **material)
        values = self.gltf.document["materials"][index]
        if normal is not None:
            values["normalTexture"] = {"index": normal, "scale": normal_scale}
        if roughness_texture is not None:
            values["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {"index": roughness_texture}
        return index

    def copies(self, name, mesh, material, places):
        """The mesh in many places, each a dictionary of glTF: translation, rotation, scale."""
        self.triangles += mesh.triangle_count
        index = self.gltf.add_mesh(name, mesh, material)
        for i, place in enumerate(places):
            self.gltf.add_node(f"{name} {i + 1}", mesh=index, **place)

    def camera(self, position, target, degrees, aspect_ratio=16.0 / 9.0):
        """A camera whose vertical field of view is given in degrees."""
        self.gltf.add_camera("camera", position, look_at(position, target), math.radians(degrees), aspect_ratio)

    def settings(self):
        """render.json as an object."""
        result = {}
        for pointer, value in self.render_json.items():
            *parents, last = pointer.strip("/").split("/")
            place = result
            for key in parents:
                place = place.setdefault(key, {})
            place[last] = value
        return result


def turned(axis, degrees):
    """A quaternion about a unit axis."""
    half = 0.5 * math.radians(degrees)
    return [*(math.sin(half) * c for c in axis), math.cos(half)]
