"""The room of the Cornell box with a mirror sphere and a glass sphere in place of the blocks."""

from ..mesh import sphere
from .cornell_box import room

SPHERE_FREQUENCY = 39

MIRROR_RADIUS, MIRROR_CENTER = 0.120, (0.392, 0.120, 0.370)
GLASS_RADIUS, GLASS_CENTER = 0.100, (0.178, 0.100, 0.190)


def build():
    scene, _ = room()
    gltf = scene.gltf
    mirror = gltf.add_material("mirror", base_color=(0.91, 0.92, 0.92), metallic=1.0, roughness=0.0)
    glass = gltf.add_material("glass", roughness=0.0, transmission=1.0)
    for name, material, radius, center in (
            ("mirror sphere", mirror, MIRROR_RADIUS, MIRROR_CENTER),
            ("glass sphere", glass, GLASS_RADIUS, GLASS_CENTER)):
        gltf.add_node(name, mesh=gltf.add_mesh(name, sphere(radius, SPHERE_FREQUENCY), material), translation=center)
        scene.closed_meshes.add(name)
    scene.render_json["/materials/mirror/conductor"] = {"metal": "Al", "roughness": 0.0}
    scene.render_json["/materials/glass/dielectric"] = {"ior": 1.5, "roughness": 0.0}
    scene.triangles = 2 * (4 + 1) + 8 + 2 * 20 * SPHERE_FREQUENCY ** 2
    return scene
