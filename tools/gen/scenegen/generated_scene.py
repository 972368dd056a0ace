"""What a scene's module hands over."""

from dataclasses import dataclass, field

from .gltf import GltfWriter, to_json
from .vector import look_at


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

    def add_object(self, name, mesh, material, closed=False, **node):
        """A mesh with its material, placed once in a node whose index is returned; `node` as of
        GltfWriter.add_node."""
        self.triangles += mesh.triangle_count
        if closed:
            self.closed_meshes.add(name)
        return self.gltf.add_node(name, mesh=self.gltf.add_mesh(name, mesh, material), **node)

    def add_diffuse(self, name, albedo, **material):
        """A material that render.json has to make Lambert's; `material` as of GltfWriter.add_material."""
        self.render_json[f"/materials/{name}/diffuse/albedo"] = list(albedo)
        return self.gltf.add_material(name, base_color=albedo, **material)

    def add_glass(self, name, index, thickness, dispersion=None, **volume):
        """A smooth clear material for closed bodies; `volume` are further members of KHR_materials_volume."""
        extensions = {"KHR_materials_ior": {"ior": index},
                      "KHR_materials_volume": {"thicknessFactor": thickness, **volume}}
        if dispersion is not None:
            extensions["KHR_materials_dispersion"] = {"dispersion": dispersion}
        return self.gltf.add_material(name, roughness=0.0, transmission=1.0, further_extensions=extensions)

    def add_lamp(self, name, mesh, radiance, closed=False, **node):
        """An object that emits on its front and reflects nothing, so that lamps do not show each other."""
        material = self.add_diffuse(name, (0.0, 0.0, 0.0), emission=radiance)
        self.add_object(name, mesh, material, closed, **node)

    def add_daylight(self, sky, width):
        """The sun as a directional light, and the rest of the sky as an image of that width."""
        color, intensity = sky.sun_color_and_intensity()
        self.gltf.add_directional_light("sun", color, intensity, look_at(sky.sun_direction, (0.0, 0.0, 0.0)))
        self.files["sky.exr"] = sky.environment(width)
        self.render_json["/environment/image"] = "sky.exr"

    def contents(self):
        """Every file of the directory that is generated, as bytes by name."""
        document, binary = self.gltf.finish()
        return {"scene.gltf": to_json(document).encode(), "scene.bin": binary, **self.files}
