"""Where nodes of the file stand and how they move, by where Blender has their objects."""

from __future__ import annotations

from typing import Any

import bpy
import numpy
from mathutils import Matrix, Quaternion, Vector

from . import glb, scene_settings
from .identity import Tree, makes_instances_of_children
from .overlooked import moves_blurred, said

Y_UP = Matrix(((1, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, 0), (0, 0, 0, 1)))
KEYS = 9  # of motion while the shutter is open
STILL = 0.01  # share of the motion to the frames before and after that is kept without motion blur, for vectors


def moments(scene: Any, blurred: bool) -> tuple[list[float], list[float]]:
    """Frames at which motion is looked at, and their seconds from the opening of the shutter. Without motion blur, they are
    those before and after, and the shutter is open for a share of the time between them."""
    rate = scene.render.fps / scene.render.fps_base
    now = scene.frame_current + scene.frame_subframe
    if not blurred:
        return [now - 1.0, now, now + 1.0], [0.0, STILL / rate, 2.0 * STILL / rate]
    start, end = scene_settings.shutter(scene.render, scene.etendue.shutter_position)
    steps = [index / (KEYS - 1) for index in range(KEYS)]
    offsets = [step * (end - start) for step in steps]
    return [now + start + offset for offset in offsets], [offset / rate for offset in offsets]


Parts = tuple[Vector, Quaternion, Vector]  # a place, a turn and a scale


def shortened(ways: list[Parts]) -> list[Parts]:
    """Returns the motion shortened to the share STILL around its middle, for a shutter open for as small a share."""
    place, turn, scale = ways[1]
    return [(place.lerp(there[0], STILL), turn.slerp(there[1], STILL), scale.lerp(there[2], STILL)) for there in ways]


def has_motion_blur(scene: Any, view_layer: Any) -> bool:
    """Returns whether a view layer is rendered while the shutter is open."""
    return (scene.render.use_motion_blur and scene.render.motion_blur_shutter > 0.0
            and getattr(view_layer, "use_motion_blur", True))


def local_matrix(node: dict[str, Any]) -> Matrix:
    if "matrix" in node:
        return Matrix([node["matrix"][row::4] for row in range(4)])
    x, y, z, w = node.get("rotation", (0.0, 0.0, 0.0, 1.0))
    return Matrix.LocRotScale(Vector(node.get("translation", (0, 0, 0))), Quaternion((w, x, y, z)),
                              Vector(node.get("scale", (1, 1, 1))))


def columns(matrix: Matrix) -> list[float]:
    return [matrix[row][column] for column in range(4) for row in range(4)]


def world_matrices(document: dict[str, Any], tree: Tree) -> list[Matrix]:
    """The matrix of each node in the world of the file."""
    nodes = document.get("nodes", [])
    result = [Matrix.Identity(4) for _ in nodes]
    for number in tree.in_order():
        above = tree.parents.get(number)
        result[number] = (result[above] if above is not None else Matrix.Identity(4)) @ local_matrix(nodes[number])
    return result


def matrix_in_file(item: Any) -> Matrix:
    """The matrix that the object's node has in the world of the file, or in what it is an instance in."""
    if item.type in ("CAMERA", "LIGHT"):
        return Y_UP @ item.matrix_world  # they look along -Z in either world
    offset = Matrix.Identity(4)
    if item.instance_type == "COLLECTION" and item.instance_collection is not None:
        offset = Matrix.Translation(-item.instance_collection.instance_offset)
    return Y_UP @ item.matrix_world @ offset @ Y_UP.inverted()


def differ(one: Matrix, other: Matrix) -> bool:
    """Returns whether matrices differ by more than single precision makes."""
    largest = max(1.0, *(abs(number) for row in other for number in row))
    return any(abs(a - b) > 1e-5 * largest for left, right in zip(one, other) for a, b in zip(left, right))


def is_sheared(matrix: Matrix) -> bool:
    """Returns whether the axes of the matrix are not at right angles."""
    across, up, back = (axis.normalized() for axis in matrix.to_3x3().col)
    return max(abs(across.dot(up)), abs(up.dot(back)), abs(back.dot(across))) > 1e-3


def straighten(document: dict[str, Any], tree: Tree) -> None:
    """Gives nodes the matrices that their objects have. The exporter gives them a place, a turn and a scale, by which
    they lose what shears them: a turn below a scale that is not even."""
    nodes = document.get("nodes", [])
    worlds = [Matrix.Identity(4) for _ in nodes]
    for number in tree.in_order():
        above, item, instancer = tree.parents.get(number), tree.objects[number], tree.instancers[number]
        before = worlds[above] if above is not None else Matrix.Identity(4)
        worlds[number] = before @ local_matrix(nodes[number])
        # What stands on vertices or particles has no matrix of its own.
        if item is None or (instancer is not None and makes_instances_of_children(tree.objects[instancer])):
            continue
        exact = matrix_in_file(item)
        if instancer is not None:
            exact = worlds[instancer] @ exact
        local = before.inverted_safe() @ exact
        # Below a scale of 0, no matrix leads there.
        if differ(worlds[number], exact) and not differ(before @ local, exact):
            for key in ("translation", "rotation", "scale"):
                nodes[number].pop(key, None)
            nodes[number]["matrix"] = columns(local)
            worlds[number] = exact


def field_of_view(camera: Any) -> tuple[float, ...]:
    """Returns what Cycles blurs of a camera beside its place: the focal length and the sensor of a perspective one."""
    return (camera.lens, camera.sensor_width, camera.sensor_height) if camera.type == "PERSP" else ()


def loose_instances(depsgraph: Any) -> dict[Any, list[Matrix]]:
    """Returns where instances stand that have no objects of their own: on vertices, faces and particles, and those of
    geometry nodes; by their instancers, and as seen from these."""
    result: dict[Any, list[Matrix]] = {}
    for instance in depsgraph.object_instances:
        if instance.is_instance and not (instance.parent.is_instancer and instance.parent.instance_type == "COLLECTION"):
            local = instance.parent.matrix_world.inverted_safe() @ instance.matrix_world
            result.setdefault(instance.parent.original, []).append(local)
    return result


def find_motions(scene: Any, document: dict[str, Any], tree: Tree, blurred: bool,
                 notes: list[str]) -> tuple[list[float], dict[int, glb.Motion]]:
    """Finds how nodes move while the shutter is open, by the places that Blender gives their objects at moments in
    between, whatever moves them. Meshes that change their form do not move; of instances that stand still, notes tell."""
    now = world_matrices(document, tree)
    frames, seconds = moments(scene, blurred)
    frame, subframe = scene.frame_current, scene.frame_subframe
    # What stands on vertices or particles has no matrix of its own.
    followed = {number: item for number, item in enumerate(tree.objects) if item is not None and
                (tree.instancers[number] is None or not makes_instances_of_children(tree.objects[tree.instancers[number]]))}
    worlds: list[dict[int, Matrix]] = []
    rest = {number: item.matrix_world.copy() for number, item in followed.items()}
    loose = loose_instances(bpy.context.evaluated_depsgraph_get())
    restless: set[Any] = set()
    camera = scene.camera.data if scene.camera is not None and scene.camera.type == "CAMERA" else None
    views = set()
    try:
        for moment in frames:
            whole = int(numpy.floor(moment))
            scene.frame_set(whole, subframe=moment - whole)
            worlds.append({number: item.matrix_world.copy() for number, item in followed.items()})
            views |= {field_of_view(camera)} if camera is not None else set()
            if loose and moment in (frames[0], frames[-1]):
                there = loose_instances(bpy.context.evaluated_depsgraph_get())
                restless |= {item for item, places in loose.items() if len(places) != len(there.get(item, ()))
                             or any(map(differ, places, there[item]))}
    finally:
        scene.frame_set(frame, subframe=subframe)
    if len(views) > 1:
        notes += said("the focal length of cameras does not change while the shutter is open", [camera])
    notes += said("instances on points, faces or particles do not move while the shutter is open", restless)
    still = {number for number in followed if blurred and not all(
        moves_blurred(tree.objects[at]) for at in (number, tree.top_instancer(number)) if at is not None)}
    turned = Y_UP.inverted()
    moved: list[list[Matrix]] = []
    for world in worlds:
        at = [matrix.copy() for matrix in now]
        for number in tree.in_order():
            if number in still:
                continue
            # Bones and the like go with what is above them, instances with their instancers.
            above, move = tree.parents.get(number), Matrix.Identity(4)
            if number in followed:
                above, move = tree.instancers[number], Y_UP @ world[number] @ rest[number].inverted_safe() @ turned
            if above is not None:
                move = at[above] @ move @ now[above].inverted_safe()
            at[number] = move @ now[number]
        moved.append(at)
    motions: dict[int, glb.Motion] = {}
    for number in followed:
        parent = tree.parents.get(number)
        local = [at[parent].inverted_safe() @ at[number] if parent is not None else at[number] for at in moved]
        # A node with a matrix keeps it, and what is put above it moves.
        if "matrix" in document["nodes"][number]:
            kept = local_matrix(document["nodes"][number]).inverted_safe()
            local = [matrix @ kept for matrix in local]
        parts = [matrix.decompose() for matrix in local]
        for previous, part in zip(parts, parts[1:]):
            if part[1].dot(previous[1]) < 0.0:
                part[1].negate()
        parts = parts if blurred else shortened(parts)
        motion: glb.Motion = {
            "translation": [tuple(place) for place, _, _ in parts],
            "rotation": [(turn.x, turn.y, turn.z, turn.w) for _, turn, _ in parts],
            "scale": [tuple(scale) for _, _, scale in parts]}
        motion = {path: values for path, values in motion.items()
                  if any(abs(a - b) > 1e-6 for value in values for a, b in zip(value, values[0]))}
        if motion:
            motions[number] = motion
    return seconds, motions
