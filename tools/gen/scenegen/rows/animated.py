"""A row of spheres in the middle of an animation: posed ones behind, moving ones in front."""

import math
from array import array

from ..gltf import COMPONENTS, FLOAT, UNSIGNED_BYTE
from ..mesh import mapped_sphere
from ..vector import normalize
from . import textures
from .stage import BALL, LOWER, RADIUS, UPPER, Stage

# The posed ones hardly move while the shutter is open, the moving ones move at that time alone.
MOMENT, SHUTTER = 2.0, (0.0, 0.1)
SLOWLY, FAST = (0.0, 4.0), tuple(MOMENT + t for t in SHUTTER)
JOINT_HEIGHTS = (-0.45, -0.15, 0.15)
BODY = (0.5, 1.0, 0.5)  # a sphere becomes a body whose turning shows


def animated():
    """Behind, posed: a step, turned and stretched, along a spline, bent by joints, morphed and dyed by a pointer.
    In front, with motion blur: pushed, turned, along a spline, bent, morphed."""
    stage = Stage()
    bands = stage.texture("bands", textures.color_bands())
    banded = stage.scene.gltf.add_material("banded", roughness=0.6, base_color_texture=bands)
    dyed = stage.scene.gltf.add_material("dyed", roughness=0.6, base_color=(0.0, 0.0, 0.0))
    animation = _Animation(stage.scene.gltf)

    def ball(row, column, name, **node):
        return stage.scene.add_object(name, BALL, banded, translation=stage.place(row, column, RADIUS + 0.01), **node)

    def path(row, column, offsets):
        x, y, z = stage.place(row, column, RADIUS + 0.01)
        return [(x + dx, y + dy, z) for dx, dy in offsets]

    stepping = ball(UPPER, 0, "step")
    animation.add(stepping, "translation", (0.0, 1.0, 3.0), path(UPPER, 0, ((0.0, 0.0), (0.15, 0.3), (0.0, 1.0))),
                  "STEP")
    turned = ball(UPPER, 1, "turned")
    animation.add(turned, "rotation", (0.0, 10.0), (_turn(0.0), _turn(3.1)))
    animation.add(turned, "scale", SLOWLY, ((0.5, 1.0, 0.5), (0.1, 1.0, 0.1)))
    _along_spline(animation, ball(UPPER, 2, "spline"), SLOWLY, path(UPPER, 2, ((-0.2, 0.0), (0.2, 0.0))), rise=0.45)
    # All of this still: what moves however slowly takes another way through the renderer.
    _bent(stage, animation, "bent", stage.place(UPPER, 3, 0.5), banded, SLOWLY, (0.9, 0.9))
    _morphed(stage, animation, "morphed", stage.place(UPPER, 4, RADIUS + 0.01), dyed, SLOWLY, (0.2, 0.8))
    animation.add_pointer(f"/materials/{dyed}/pbrMetallicRoughness/baseColorFactor", SLOWLY,
                          ((0.1, 0.1, 0.9, 1.0), (0.3, 0.9, 0.1, 1.0)))

    animation.add(ball(LOWER, 0, "pushed"), "translation", FAST, path(LOWER, 0, ((-0.35, 0.0), (0.35, 0.1))))
    animation.add(ball(LOWER, 1, "turning", scale=BODY), "rotation", FAST, (_turn(-0.2), _turn(1.8)))
    _along_spline(animation, ball(LOWER, 2, "spline"), FAST, path(LOWER, 2, ((-0.25, 0.0), (0.25, 0.0))), rise=0.5)
    _bent(stage, animation, "bending", stage.place(LOWER, 3, 0.5), banded, FAST, (-0.2, 1.0))
    _morphed(stage, animation, "morphing", stage.place(LOWER, 4, RADIUS + 0.01), banded, FAST, (0.0, 1.0))
    animation.finish("the one that is shown")
    return stage.finish(time_code=MOMENT, shutter=SHUTTER, animation="the one that is shown")


class _Animation:
    """An animation, after another that nobody asks for."""

    def __init__(self, gltf):
        self._gltf = gltf
        self._samplers, self._channels = [], []

    def add(self, node, path, times, values, interpolation="LINEAR"):
        """`values` are vectors, for weights lists of numbers; of splines three for each time."""
        kind = {"rotation": "VEC4", "weights": "SCALAR"}.get(path, "VEC3")
        self._add({"node": node, "path": path}, times, values, kind, interpolation)

    def add_pointer(self, pointer, times, values):
        self._gltf.use_extension("KHR_animation_pointer")
        self._add({"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": pointer}}}, times, values,
                  "VEC4", "LINEAR")

    def finish(self, name):
        decoy = [{**channel, "sampler": 0} for channel in self._channels if channel["target"]["path"] == "translation"]
        self._gltf.add("animations", {"name": "another", "samplers": [self._samplers[0]], "channels": decoy})
        self._gltf.add("animations", {"name": name, "samplers": self._samplers, "channels": self._channels})

    def _add(self, target, times, values, kind, interpolation):
        numbers = array("f", (c for value in values for c in value))
        assert len(numbers) == COMPONENTS[kind] * len(times) * (3 if interpolation == "CUBICSPLINE" else 1)
        self._samplers.append({
            "input": self._gltf.add_accessor(array("f", times), FLOAT, "SCALAR", target=None, with_bounds=True),
            "output": self._gltf.add_accessor(numbers, FLOAT, kind, target=None), "interpolation": interpolation})
        self._channels.append({"sampler": len(self._samplers) - 1, "target": target})


def _along_spline(animation, node, times, ends, rise):
    """From one end to the other in an arc of the height `rise`, steeper in the beginning."""
    # Half way, Hermite's curve is above the middle by an eighth of the duration times the tangents' difference.
    steep = 8.0 * rise / (times[1] - times[0])
    still = (0.0, 0.0, 0.0)
    animation.add(node, "translation", times, (still, ends[0], (0.0, 0.7 * steep, 0.0),
                                               (0.0, -0.3 * steep, 0.0), ends[1], still), "CUBICSPLINE")


def _bent(stage, animation, name, place, material, times, angles):
    """An upright body on a chain of three joints, of which the upper two turn from one of the angles to the other."""
    gltf = stage.scene.gltf
    body = _upright_body()
    weights = array("f", (weight for y in body.positions[1::3] for weight in _joint_weights(y)))
    attributes = {"POSITION": gltf.add_accessor(body.positions, FLOAT, "VEC3", with_bounds=True),
                  "NORMAL": gltf.add_accessor(body.normals, FLOAT, "VEC3"),
                  "TEXCOORD_0": gltf.add_accessor(body.uvs, FLOAT, "VEC2"),
                  "JOINTS_0": gltf.add_accessor(array("B", (0, 1, 2, 0) * body.vertex_count), UNSIGNED_BYTE, "VEC4"),
                  "WEIGHTS_0": gltf.add_accessor(weights, FLOAT, "VEC4")}
    x, y, z = place
    apart = JOINT_HEIGHTS[1] - JOINT_HEIGHTS[0]
    top = gltf.add("nodes", {"name": f"{name}, top", "translation": [0.0, apart, 0.0]})
    middle = gltf.add("nodes", {"name": f"{name}, middle", "translation": [0.0, apart, 0.0], "children": [top]})
    foot = gltf.add_node(f"{name}, foot", translation=(x, y + JOINT_HEIGHTS[0], z), children=[middle])
    for joint in (middle, top):
        animation.add(joint, "rotation", times, [_turn(angle) for angle in angles])
    inverse = array("f", (c for h in JOINT_HEIGHTS for c in (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -h, 0, 1)))
    skin = gltf.add("skins", {"joints": [foot, middle, top],
                              "inverseBindMatrices": gltf.add_accessor(inverse, FLOAT, "MAT4", target=None)})
    # Where the node itself is does not count.
    stage.add_primitive(name, body, attributes, material, (0.0, 9.0, 0.0), skin=skin)


def _joint_weights(y):
    """Of the three joints at a height: in straight lines from each to the next, above the top one that alone."""
    t = min(max((y - JOINT_HEIGHTS[0]) / (JOINT_HEIGHTS[1] - JOINT_HEIGHTS[0]), 0.0), 2.0)
    return (max(1.0 - t, 0.0), 1.0 - abs(1.0 - t), max(t - 1.0, 0.0), 0.0)


def _upright_body():
    """An ellipsoid about the origin."""
    body = mapped_sphere(RADIUS, columns=48, rows=48)
    squeeze = 0.4
    for i in range(0, len(body.positions), 3):
        for axis in (0, 2):
            body.positions[i + axis] *= squeeze
        x, y, z = body.normals[i:i + 3]
        body.normals[i:i + 3] = array("f", normalize((x, squeeze * y, z)))
    return body


def _morphed(stage, animation, name, place, material, times, weights):
    """A sphere on the way to a body that is flat above."""
    gltf = stage.scene.gltf
    attributes = {"POSITION": gltf.add_accessor(BALL.positions, FLOAT, "VEC3", with_bounds=True),
                  "NORMAL": gltf.add_accessor(BALL.normals, FLOAT, "VEC3"),
                  "TEXCOORD_0": gltf.add_accessor(BALL.uvs, FLOAT, "VEC2")}
    target = array("f", (c for y in BALL.positions[1::3] for c in (0.0, -1.5 * max(y, 0.0), 0.0)))
    mesh = stage.add_primitive(name, BALL, attributes, material, place)
    mesh["primitives"][0]["targets"] = [{"POSITION": gltf.add_accessor(target, FLOAT, "VEC3", with_bounds=True)}]
    mesh["weights"] = [0.0]
    animation.add(len(gltf.document["nodes"]) - 1, "weights", times, [[weight] for weight in weights])


def _turn(angle):
    """A rotation about the line of sight, clockwise."""
    return (0.0, 0.0, -math.sin(0.5 * angle), math.cos(0.5 * angle))
