"""A writer of glTF 2.0: scene.gltf, and scene.bin with all of its bulk data."""

import json
import struct
import sys

FLOAT, BYTE, UNSIGNED_BYTE, SHORT, UNSIGNED_SHORT, UNSIGNED_INT = 5126, 5120, 5121, 5122, 5123, 5125
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963
COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


class GltfWriter:
    """Collects one scene. `add_...` returns the index of what was added, for use in other calls."""

    def __init__(self):
        self._bin = bytearray()
        self._geometry = {}
        self._extensions = set()
        self._required = set()
        self.document = {
            "asset": {"version": "2.0", "generator": "etendue tools/gen/make_scenes.py"},
            "scene": 0,
            "scenes": [{"nodes": []}],
            "buffers": [{"uri": "scene.bin", "byteLength": 0}],
        }

    def add_material(self, name, base_color=(1.0, 1.0, 1.0), metallic=0.0, roughness=1.0, emission=None,
                     base_color_texture=None, transmission=0.0, double_sided=False, emissive_texture=None,
                     further_extensions=None):
        """A metallic-roughness material. `emission` is radiance; `transmission` in [0, 1] through a thin wall.

        Textures are indices; the first may also be a whole reference, as in glTF. `further_extensions` are values by
        the extension's name, as in glTF.
        """
        pbr = {"baseColorFactor": [*base_color, 1.0], "metallicFactor": metallic, "roughnessFactor": roughness}
        if base_color_texture is not None:
            reference = base_color_texture
            pbr["baseColorTexture"] = reference if isinstance(reference, dict) else {"index": reference}
        material = {"name": name, "pbrMetallicRoughness": pbr}
        if double_sided:
            material["doubleSided"] = True
        if emissive_texture is not None:
            material["emissiveTexture"] = {"index": emissive_texture}
        extensions = dict(further_extensions or {})
        if emission is not None:
            # The factor is limited to [0, 1]; the rest goes to the extension.
            strength = max(1.0, *emission)
            material["emissiveFactor"] = [c / strength for c in emission]
            extensions["KHR_materials_emissive_strength"] = {"emissiveStrength": strength}
        if transmission > 0.0:
            extensions["KHR_materials_transmission"] = {"transmissionFactor": transmission}
        if extensions:
            material["extensions"] = extensions
            self._extensions.update(extensions)
        return self.add("materials", material)

    def add_mesh(self, name, mesh, material):
        """A mesh of one primitive. The data of the same `mesh` object is stored once, whatever the material."""
        if id(mesh) not in self._geometry:
            # The mesh is kept with its accessors, lest another object gets its id.
            self._geometry[id(mesh)] = (mesh, self._add_geometry(mesh))
        primitive = dict(self._geometry[id(mesh)][1], material=material)
        return self.add("meshes", {"name": name, "primitives": [primitive]})

    def add_node(self, name=None, **properties):
        """A node at the root: mesh, camera, translation, rotation (x, y, z, w), scale, extensions, as in glTF."""
        node = {"name": name} if name else {}
        node.update((key, list(value) if isinstance(value, tuple) else value) for key, value in properties.items())
        index = self.add("nodes", node)
        self.document["scenes"][0]["nodes"].append(index)
        return index

    def add_camera(self, name, position, rotation, yfov, aspect_ratio, near=0.01, far=1000.0):
        """A perspective camera with the vertical field of view `yfov` in radians, and its node."""
        camera = self.add("cameras", {"name": name, "type": "perspective", "perspective": {
            "yfov": yfov, "aspectRatio": aspect_ratio, "znear": near, "zfar": far}})
        return self.add_node(name, camera=camera, translation=position, rotation=rotation)

    def add_directional_light(self, name, color, intensity, rotation):
        """A KHR_lights_punctual light that shines along the local -Z of its node; `intensity` in lux."""
        self._extensions.add("KHR_lights_punctual")
        lights = self.document.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})["lights"]
        lights.append({"name": name, "type": "directional", "color": list(color), "intensity": intensity})
        return self.add_node(name, rotation=rotation, extensions={"KHR_lights_punctual": {"light": len(lights) - 1}})

    def add_image(self, name, data, mime_type="image/png"):
        """The image file `data` (bytes), stored in the buffer."""
        return self.add("images", {"name": name, "mimeType": mime_type, "bufferView": self.add_view(data)})

    def add_texture(self, name, png):
        """A repeating texture of the PNG file `png` (bytes), stored in the buffer."""
        image = self.add_image(name, png)
        sampler = self.add("samplers", {"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497})
        return self.add("textures", {"source": image, "sampler": sampler})

    def use_extension(self, name, required=False):
        """Declares an extension that is written into the document by hand."""
        self._extensions.add(name)
        if required:
            self._required.add(name)

    def finish(self):
        """The two files: the document as a dictionary and the buffer as bytes."""
        self.document["buffers"][0]["byteLength"] = len(self._bin)
        if self._extensions:
            self.document["extensionsUsed"] = sorted(self._extensions)
        if self._required:
            self.document["extensionsRequired"] = sorted(self._required)
        return self.document, bytes(self._bin)

    def add(self, key, value):
        """Appends `value` to the list `key` of the document."""
        values = self.document.setdefault(key, [])
        values.append(value)
        return len(values) - 1

    def _add_geometry(self, mesh):
        attributes = {
            "POSITION": self.add_accessor(mesh.positions, FLOAT, "VEC3", with_bounds=True),
            "NORMAL": self.add_accessor(mesh.normals, FLOAT, "VEC3")}
        if mesh.tangents:
            attributes["TANGENT"] = self.add_accessor(mesh.tangents, FLOAT, "VEC4")
        if mesh.uvs:
            attributes["TEXCOORD_0"] = self.add_accessor(mesh.uvs, FLOAT, "VEC2")
        if mesh.colors:
            attributes["COLOR_0"] = self.add_accessor(mesh.colors, UNSIGNED_BYTE, "VEC4", normalized=True)
        return {"attributes": attributes, "indices": self.add_indices(mesh)}

    def add_indices(self, mesh):
        """An accessor of the mesh's triangles."""
        # 65535 itself is the primitive restart value and not allowed.
        if mesh.vertex_count > 65535:
            return self.add_accessor(mesh.indices, UNSIGNED_INT, "SCALAR", ELEMENT_ARRAY_BUFFER)
        short = struct.pack(f"<{len(mesh.indices)}H", *mesh.indices)
        return self.add_accessor(memoryview(short).cast("H"), UNSIGNED_SHORT, "SCALAR", ELEMENT_ARRAY_BUFFER)

    def add_accessor(self, values, component_type, kind, target=ARRAY_BUFFER, with_bounds=False, normalized=False,
                     stride=None):
        """An accessor of all of `values`, which are padded to one element each `stride` bytes if that is given."""
        assert sys.byteorder == "little", "glTF is little-endian and the arrays are written as they are"
        n = COMPONENTS[kind]
        data = values.tobytes()
        if stride is not None:
            size = n * values.itemsize
            data = b"".join(data[i:i + size].ljust(stride, b"\0") for i in range(0, len(data), size))
        accessor = {"bufferView": self.add_view(data, target, stride), "componentType": component_type,
                    "count": len(values) // n, "type": kind}
        if normalized:
            accessor["normalized"] = True
        if with_bounds:
            accessor["min"] = [min(values[i::n]) for i in range(n)]
            accessor["max"] = [max(values[i::n]) for i in range(n)]
        return self.add("accessors", accessor)

    def add_view(self, data, target=None, stride=None):
        """A view of `data` (bytes), which are appended to the buffer."""
        self._bin.extend(b"\0" * (-len(self._bin) % 4))
        view = {"buffer": 0, "byteOffset": len(self._bin), "byteLength": len(data)}
        if target is not None:
            view["target"] = target
        if stride is not None:
            view["byteStride"] = stride
        self._bin.extend(data)
        return self.add("bufferViews", view)


def to_json(document):
    """Text of the document: one line per entry of each top-level array, so that differences are readable."""
    def dump(value):
        return json.dumps(value, separators=(",", ":"))

    parts = []
    for key, value in document.items():
        if isinstance(value, list) and value and isinstance(value[0], dict):
            parts.append(f"{dump(key)}:[\n" + ",\n".join(map(dump, value)) + "\n]")
        else:
            parts.append(f"{dump(key)}:{dump(value)}")
    return "{" + ",\n".join(parts) + "}\n"
