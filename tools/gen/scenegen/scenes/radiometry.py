"""A matte floor from above, under lamps that render.json places: what it shows has closed forms."""

import math

from ..generated_scene import GeneratedScene
from ..mesh import ground


def build():
    scene = GeneratedScene()
    scene.add_object("floor", ground(4.0), scene.add_diffuse("floor", (0.5, 0.5, 0.5)))
    camera = scene.gltf.add("cameras", {"name": "camera", "type": "orthographic", "orthographic": {
        "xmag": 2.0, "ymag": 1.0, "znear": 0.01, "zfar": 10.0}})
    scene.gltf.add_node("camera", camera=camera, translation=(0.0, 0.5, 0.0),
                        rotation=(-math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)))
    return scene
