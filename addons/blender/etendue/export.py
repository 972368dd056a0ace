"""A scene of Blender's as a scene directory of the program: Blender's own exporter, and what it leaves out."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import bpy
import numpy
from mathutils import Matrix, Quaternion, Vector

from . import glb, glb_materials, overlooked, passes, scene_settings
from .exr import write_exr
from .images import image_bytes
from .overlooked import SURFACES
from .program import known_part

Y_UP = Matrix(((1, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, 0), (0, 0, 0, 1)))
KEYS = 9  # of motion while the shutter is open
# Options of the exporter and their names in its versions; those that a version lacks are left out.
OPTIONS: dict[str, Any] = {
    "export_format": "GLB", "export_cameras": True, "export_lights": True, "export_extras": True, "export_yup": True,
    "export_apply": True, "export_materials": "EXPORT", "export_animations": False, "export_current_frame": True,
    "export_skins": False, "export_morph": True, "export_morph_normal": True, "export_texcoords": True, "export_normals": True,
    "export_colors": True, "export_all_vertex_colors": False, "export_draco_mesh_compression_enable": False,
    "export_gn_mesh": True, "export_unused_images": False, "export_image_format": "AUTO", "use_selection": False,
    "use_visible": False, "use_renderable": False, "use_active_collection": False, "use_active_scene": True,
    "convert_lighting_mode": "COMPAT", "export_import_convert_lighting_mode": "COMPAT", "will_save_settings": False,
    "check_existing": False, "export_original_specular": False, "export_hierarchy_full_collections": False,
}


class ExportError(Exception):
    """The scene cannot be exported; the message is for the user."""


@dataclass
class Exported:
    folder: Path
    arguments: list[str] = field(default_factory=list)
    gltf: dict[str, Any] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)


def on_main_thread(function: Callable[[], Any], is_stopped: Callable[[], bool]) -> Any:
    """The function's result, or its exception. F12 renders in a thread of its own, in which operators must not run."""
    if bpy.app.background or threading.current_thread() is threading.main_thread():
        return function()
    done, outcome = threading.Event(), {}

    def call() -> None:
        try:
            if not outcome.get("given up"):
                outcome["result"] = function()
        except Exception as error:  # pylint: disable=broad-except
            outcome["error"] = error
        done.set()

    bpy.app.timers.register(call, first_interval=0.0)
    while not done.wait(0.05):
        if is_stopped():
            outcome["given up"] = True
            raise ExportError("cancelled")
    if "error" in outcome:
        raise outcome["error"]
    return outcome["result"]


@contextmanager
def modifiers_as_rendered(scene: Any) -> Iterator[None]:
    """The exporter takes modifiers as viewports show them: while this lasts, these show them as renders do."""
    kept = []
    for item in scene.objects:
        for modifier in item.modifiers:
            changes = {"show_viewport": modifier.show_render}
            if hasattr(modifier, "render_levels"):
                changes["levels"] = modifier.render_levels
            for name, value in changes.items():
                if getattr(modifier, name) != value:
                    kept.append((modifier, name, getattr(modifier, name)))
                    setattr(modifier, name, value)
    try:
        yield
    finally:
        for modifier, name, value in kept:
            setattr(modifier, name, value)


@contextmanager
def context_of(scene: Any, view_layer: Any) -> Iterator[None]:
    """The scene and the view layer as what the exporter takes for the current ones."""
    window = bpy.context.window or next((window for manager in bpy.data.window_managers for window in manager.windows), None)
    if window is None:
        raise ExportError("there is no window, not even an unseen one, which Blender's glTF exporter needs")
    before = window.scene, window.view_layer
    show_in(window, scene, view_layer)
    try:
        with bpy.context.temp_override(window=window, scene=scene, view_layer=view_layer):
            yield
    finally:
        show_in(window, *before)


def show_in(window: Any, scene: Any, view_layer: Any) -> None:
    if window.scene != scene:
        window.scene = scene
    if window.view_layer != view_layer:
        window.view_layer = view_layer


def exporter() -> Any:
    """The operator of Blender's glTF exporter, an add-on that users can turn off."""
    try:
        bpy.ops.export_scene.gltf.get_rna_type()
    except (AttributeError, KeyError):
        raise ExportError("Blender's add-on 'glTF 2.0 format' is needed and is turned off: Edit > Preferences > Add-ons"
                          ) from None
    return bpy.ops.export_scene.gltf


def write_gltf(scene: Any, view_layer: Any, path: Path) -> None:
    operator = exporter()
    known = {item.identifier for item in operator.get_rna_type().properties}
    options = {name: value for name, value in OPTIONS.items() if name in known}
    with context_of(scene, view_layer), modifiers_as_rendered(scene):
        scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)
        try:
            operator("EXEC_DEFAULT", filepath=str(path), **options)
        except RuntimeError as error:
            raise ExportError(f"Blender's glTF exporter failed: {str(error).strip().splitlines()[-1]}") from None
    if not path.exists():
        raise ExportError("Blender's glTF exporter has written no file")


def moments(scene: Any) -> tuple[list[float], list[float]]:
    """Frames at which motion is looked at, and their seconds from the opening of the shutter."""
    start, end = scene_settings.shutter(scene.render, scene.etendue.shutter_position)
    rate = scene.render.fps / scene.render.fps_base
    steps = [index / (KEYS - 1) for index in range(KEYS)]
    offsets = [step * (end - start) for step in steps]
    return [scene.frame_current + start + offset for offset in offsets], [offset / rate for offset in offsets]


def world_matrices(document: dict[str, Any]) -> list[Matrix]:
    """The matrix of each node in the world of the file."""
    nodes = document.get("nodes", [])
    result = [Matrix.Identity(4) for _ in nodes]
    parents = {child: number for number, node in enumerate(nodes) for child in node.get("children", ())}

    def of(number: int) -> Matrix:
        node = nodes[number]
        if "matrix" in node:
            own = Matrix([node["matrix"][row::4] for row in range(4)])
        else:
            x, y, z, w = node.get("rotation", (0.0, 0.0, 0.0, 1.0))
            own = Matrix.LocRotScale(Vector(node.get("translation", (0, 0, 0))), Quaternion((w, x, y, z)),
                                     Vector(node.get("scale", (1, 1, 1))))
        return of(parents[number]) @ own if number in parents else own

    for number in range(len(nodes)):
        result[number] = of(number)
    return result


def find_motions(scene: Any, view_layer: Any, document: dict[str, Any]) -> tuple[list[float], dict[int, glb.Motion]]:
    """Finds how nodes move while the shutter is open, by the places that Blender gives their objects at moments in
    between, whatever moves them. Meshes that change their form do not move."""
    nodes = document.get("nodes", [])
    names: dict[str, list[int]] = {}
    for number, node in enumerate(nodes):
        names.setdefault(node.get("name", ""), []).append(number)
    single = {name: numbers[0] for name, numbers in names.items() if len(numbers) == 1 and name in scene.objects}
    now = world_matrices(document)
    parents = {child: number for number, node in enumerate(nodes) for child in node.get("children", ())}
    frames, seconds = moments(scene)
    frame, subframe = scene.frame_current, scene.frame_subframe
    worlds: list[dict[str, Matrix]] = []
    with context_of(scene, view_layer):
        try:
            rest = {name: scene.objects[name].matrix_world.copy() for name in single}
            for moment in frames:
                whole = int(numpy.floor(moment))
                scene.frame_set(whole, subframe=moment - whole)
                worlds.append({name: scene.objects[name].matrix_world.copy() for name in single})
        finally:
            scene.frame_set(frame, subframe=subframe)
    turned = Y_UP.inverted()
    moved: list[dict[int, Matrix]] = [
        {single[name]: Y_UP @ world[name] @ rest[name].inverted_safe() @ turned @ now[single[name]] for name in single}
        for world in worlds]
    motions: dict[int, glb.Motion] = {}
    for number in single.values():
        parent = parents.get(number)
        # A node whose parent is a bone or an instance goes with it.
        if parent is not None and parent not in moved[0]:
            continue
        parts = [(at[parent].inverted_safe() @ at[number] if parent is not None else at[number]).decompose() for at in moved]
        for previous, part in zip(parts, parts[1:]):
            part[1].make_compatible(previous[1])
        motion: glb.Motion = {
            "translation": [tuple(place) for place, _, _ in parts],
            "rotation": [(turn.x, turn.y, turn.z, turn.w) for _, turn, _ in parts],
            "scale": [tuple(scale) for _, _, scale in parts]}
        motion = {path: values for path, values in motion.items()
                  if any(abs(a - b) > 1e-6 for value in values for a, b in zip(value, values[0]))}
        if motion:
            motions[number] = motion
    return seconds, motions


def rendered_objects(depsgraph: Any) -> tuple[dict[str, Any], set[str]]:
    """The objects that are rendered, by name, those of instances too; and the names of those that stand in the view layer
    themselves."""
    items, single = {}, set()
    for instance in depsgraph.object_instances:
        if not instance.show_self:
            continue
        item = instance.instance_object if instance.is_instance else instance.object
        if item is None:
            continue
        items[item.name] = item.original.evaluated_get(depsgraph)
        if not instance.is_instance:
            single.add(item.name)
    return items, single


def is_closed(mesh: Any) -> bool:
    """Returns whether every edge is between two faces."""
    if len(mesh.polygons) == 0:
        return False
    edges = numpy.empty(len(mesh.loops), numpy.int32)
    mesh.loops.foreach_get("edge_index", edges)
    return bool(numpy.all(numpy.bincount(edges, minlength=len(mesh.edges)) == 2))


def materials_of(items: dict[str, Any]) -> list[tuple[Any, bool]]:
    """Each material that is used, with whether all meshes that have it are closed."""
    found: dict[str, tuple[Any, bool]] = {}
    for item in items.values():
        if item.type not in SURFACES:
            continue
        used = [slot.material for slot in item.material_slots if slot.material is not None]
        if not used:
            continue
        closed = item.type == "MESH" and is_closed(item.data)
        for material in used:
            before = found.get(material.name, (material, True))
            found[material.name] = (material, before[1] and closed)
    return list(found.values())


def place_world_image(image: Any, folder: Path, environment: dict[str, Any]) -> list[str]:
    """Has the environment name the image: the file that it is of, or a copy of its pixels. Returns arguments."""
    source = Path(bpy.path.abspath(image.filepath, library=image.library)).resolve() if image.filepath else None
    plain = image.source == "FILE" and not image.packed_file and not image.is_dirty
    linear = image.colorspace_settings.name in ("Linear", "Linear Rec.709", "Non-Color", "Raw")
    if plain and linear and source is not None and source.suffix.lower() in (".exr", ".hdr") and source.is_file():
        environment["image"] = str(source)
        return ["--assets", str(source.parent)]
    width, height = image.size
    if width == 0 or height == 0:
        raise ExportError(f"the image '{image.name}' of the world cannot be read")
    flat = numpy.empty(width * height * image.channels, numpy.float32)
    image.pixels.foreach_get(flat)
    pixels = flat.reshape(height, width, image.channels)[::-1]
    pixels = numpy.repeat(pixels[..., :1], 3, axis=2) if image.channels < 3 else pixels[..., :3]
    # Blender's pixels of 8 bits are as the file has them, those of floats are linear.
    if not image.is_float and not linear:
        pixels = numpy.where(pixels <= 0.04045, pixels / 12.92, ((pixels + 0.055) / 1.055) ** 2.4)
    write_exr(folder / "world.exr", pixels.astype(numpy.float32))
    return []


def add_entries(document: dict[str, Any], origins: dict[str, str], change: dict[str, Any]) -> None:
    """The entries of materials that are copies of others with a change."""
    entries = document.setdefault("materials", {}) if origins else {}
    for name, origin in origins.items():
        entries[name] = {**entries.get(origin, {}), **change}


def bytes_of(image: Any) -> tuple[bytes, str]:
    return image_bytes(image, Path(bpy.path.abspath(image.filepath, library=image.library)) if image.filepath else None)


def export_scene(scene: Any, view_layer: Any, depsgraph: Any, folder: Path, program: Path,
                 is_stopped: Callable[[], bool] = lambda: False) -> Exported:
    """Writes scene.glb and render.json into the folder. `scene` and `view_layer` are Blender's originals, `depsgraph` has
    what is rendered."""
    if scene.camera is None:
        raise ExportError("the scene has no camera")
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / "scene.glb"
    moves = scene.render.use_motion_blur and scene.render.motion_blur_shutter > 0.0
    times: list[float] = []

    def operators() -> tuple[list[float], dict[int, glb.Motion]]:
        write_gltf(scene, view_layer, file)
        return find_motions(scene, view_layer, glb.read_glb(file)[0]) if moves else ([], {})

    times, motions = on_main_thread(operators, is_stopped)
    items, single = rendered_objects(depsgraph)
    evaluated = depsgraph.scene_eval
    camera = evaluated.camera
    materials = materials_of(items)
    override = view_layer.material_override
    if override is not None:
        materials = [(override, all(closed for _, closed in materials))]
    lamps = [item for name, item in items.items() if item.type == "LIGHT" and name in single]
    written = scene_settings.write(evaluated, lamps, materials,
                                   passes.sources(passes.wanted(view_layer), scene.etendue.denoise),
                                   (times[0], times[-1]) if motions else None, camera, bpy.app.version, view_layer)
    document, binary = glb.read_glb(file)
    glb.ensure_camera(document, camera.name)
    glb.give_nodes_their_own(document)
    if camera.data.type == "ORTHO":
        # The exporter takes the scale to be that of the longer side, whatever the sensor fits.
        glb.set_orthographic(document, camera.name,
                             scene_settings.orthographic_halves(camera.data, *scene_settings.view_size(evaluated.render)))
    glb.leave_out(document, items)
    glb.set_spots(document, {item.name: scene_settings.spot_cones(item.data) for item in items.values()
                             if item.type == "LIGHT" and item.data.type == "SPOT"})
    glb.give_all_materials(document)
    if override is not None:
        glb_materials.override(document, override.name)
    binary = glb_materials.mend(document, binary, written, bytes_of)
    catchers = set(overlooked.shadow_catchers(items.values(), scene.etendue.integrator, written.note))
    add_entries(written.document, glb.give_own_materials(document, catchers, "that catches shadows"), {"shadow_catcher": True})
    hidden = {name for name, item in items.items() if item.type in SURFACES
              and (not getattr(item, "visible_camera", True) or overlooked.is_indirect_only(item, view_layer))}
    add_entries(written.document, glb.give_own_materials(document, hidden, "hidden from the camera"), {"visible_to_camera": False})
    motions = {number: motion for number, motion in motions.items()
               if overlooked.moves_blurred(items.get(document["nodes"][number].get("name")))}
    binary = glb.add_motion(document, binary, times, motions)
    glb.write_glb(file, document, binary)
    result = Exported(folder, gltf=document, notes=written.notes + overlooked.notes(items.values(), view_layer))
    result.notes += [f"lamp '{item.name}': area lamps in instances are not brought over" for name, item in items.items()
                     if item.type == "LIGHT" and item.data.type == "AREA" and name not in single]
    if written.world_image is not None:
        result.arguments += place_world_image(written.world_image, folder, written.document["environment"])
    # Names that the file has not are errors.
    in_file = {material.get("name") for material in document.get("materials", [])}
    for name in set(written.document.get("materials", {})) - in_file:
        del written.document["materials"][name]
    nodes = {node.get("name") for node in document.get("nodes", [])}
    for name in set(written.document.get("lights", {})) - nodes:
        del written.document["lights"][name]
    known, dropped = known_part(program, written.document)
    result.notes += [f"this version of the program does not know {name}, which is left out" for name in dropped]
    (folder / "render.json").write_text(json.dumps(known, indent=1), encoding="utf-8")
    return result
