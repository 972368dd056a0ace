"""A closed white furnace: inside a surface of albedo ρ = ½ that emits E = ½, radiance is L = E + ρ L = 1 everywhere.

True for every closed shape, so the tessellation takes nothing away as long as each triangle is shaded with its own
normal: hence the flat normals.
"""

from ..generated_scene import GeneratedScene
from ..mesh import flat_inward_sphere
from ..vector import look_at

FREQUENCY = 8


def build():
    scene = GeneratedScene()
    gltf = scene.gltf
    wall = gltf.add_material("wall", base_color=(0.5, 0.5, 0.5), emission=(0.5, 0.5, 0.5))
    gltf.add_node("furnace", mesh=gltf.add_mesh("furnace", flat_inward_sphere(1.0, FREQUENCY), wall))
    # Off the centre, where nothing would hide an error that depends on distance or angle.
    position = (0.3, 0.1, 0.5)
    gltf.add_camera("camera", position, look_at(position, (-0.5, -0.2, -0.6)), yfov=1.2, aspect_ratio=1.0)
    scene.closed_meshes.add("furnace")
    scene.render_json["/materials/wall/diffuse/albedo"] = [0.5, 0.5, 0.5]
    scene.triangles = 20 * FREQUENCY ** 2
    return scene
