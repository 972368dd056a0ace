"""Blender's own exporter of glTF: what it is told, and what is changed in the scene while it works."""

from __future__ import annotations

import importlib
import sys
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import bpy
import numpy

from . import glb, vertex_colors
from .identity import Tree, numbered, take_blocks, tree_of
from .overlooked import SURFACES
from .placement import find_motions, has_motion_blur, straighten
from .viewport import as_rendered, changed, keyed, kept

# Options of the exporter and their names in its versions; those that a version lacks are left out.
OPTIONS: dict[str, Any] = {
    "export_format": "GLB", "export_cameras": True, "export_lights": True, "export_extras": True, "export_yup": True,
    "export_apply": True, "export_materials": "EXPORT", "export_animations": False, "export_current_frame": True,
    "export_skins": False, "export_morph": True, "export_morph_normal": True, "export_texcoords": True, "export_normals": True,
    "export_colors": True, "export_all_vertex_colors": False, "export_draco_mesh_compression_enable": False,
    "export_gn_mesh": False, "export_unused_images": False, "export_image_format": "AUTO", "use_selection": False,
    "use_visible": False, "use_renderable": False, "use_active_collection": False, "use_active_scene": True,
    "convert_lighting_mode": "COMPAT", "export_import_convert_lighting_mode": "COMPAT", "will_save_settings": False,
    "check_existing": False, "export_original_specular": False, "export_hierarchy_full_collections": False,
}


class ExportError(Exception):
    """The scene cannot be exported; the message is for the user."""


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


def foreign_materials(depsgraph: Any) -> list[Any]:
    """Returns, each once, the materials of objects whose modifiers set other materials than the object's own."""
    found: dict[Any, None] = {}
    items: dict[Any, None] = {}
    for instance in depsgraph.object_instances:
        item = instance.instance_object if instance.is_instance else instance.object
        items |= {item.original: None} if item is not None and item.type in SURFACES else {}
    for item in items:
        theirs = [slot.material and slot.material.original for slot in item.evaluated_get(depsgraph).material_slots]
        if theirs != [slot.material for slot in item.material_slots]:
            found |= dict.fromkeys(theirs)
    return [material for material in found if material is not None]


@contextmanager
def carried(materials: list[Any], scene: Any) -> Iterator[None]:
    """Adds an object with these materials to the scene while this lasts: the exporter takes materials from the slots of
    objects alone, not from what modifiers make. The object has no number, so that it is not rendered."""
    if not materials:
        yield
        return
    mesh = bpy.data.meshes.new("carrier")
    item = bpy.data.objects.new("carrier", mesh)
    try:
        corners = range(3 * len(materials))
        places = [(number, number % 2, 0.0) for number in corners]
        mesh.from_pydata(places, [], [corners[at:at + 3] for at in corners[::3]])
        for number, material in enumerate(materials):
            mesh.materials.append(material)
            mesh.polygons[number].material_index = number
        scene.collection.objects.link(item)
        yield
    finally:
        bpy.data.objects.remove(item)
        bpy.data.meshes.remove(mesh)


@contextmanager
def colors_of_corners() -> Iterator[None]:
    """Makes the exporter of Blender 3.4 give each corner of a face its own colour while this lasts: that exporter takes
    the number of the corner's vertex for the number of the corner. Later exporters are right, and have no such
    method."""
    name = "_PrimitiveCreator__get_color_attribute"
    try:
        module = importlib.import_module("io_scene_gltf2.blender.exp.gltf2_blender_gather_primitives_extract")
        creator = module.PrimitiveCreator
        original = getattr(creator, name)
    except (ImportError, AttributeError):
        yield
        return

    def get(self: Any, attribute: dict[str, Any]) -> None:
        if attribute["blender_domain"] != "CORNER":
            original(self, attribute)
            return
        colors = self.blender_mesh.color_attributes
        values = numpy.empty(4 * len(self.blender_mesh.loops), numpy.float32)
        colors[colors.render_color_index].data.foreach_get("color", values)
        for channel in range(4):
            self.dots[f"{attribute['gltf_attribute_name']}{channel}"] = values[channel::4]

    setattr(creator, name, get)
    try:
        yield
    finally:
        setattr(creator, name, original)


@contextmanager
def first_tiles(images: Any, trees: Iterable[Any], notes: list[str]) -> Iterator[None]:
    """Puts the first tile in the place of images with UDIM tiles, by which the exporter fails, while this lasts."""
    tiles: dict[Any, Any] = {}
    try:
        for image in [image for image in images if image.source == "TILED" and image.users > 0]:
            number = image.tiles[0].number
            path = bpy.path.abspath(image.filepath, library=image.library).replace("<UDIM>", str(number))
            path = path.replace("<UVTILE>", f"u{(number - 1001) % 10 + 1}_v{(number - 1001) // 10 + 1}")
            try:
                tiles[image] = images.load(path)
            except RuntimeError:
                raise ExportError(f"the image '{image.name}' has UDIM tiles, and the first, {path}, cannot be read") from None
            tiles[image].colorspace_settings.name = image.colorspace_settings.name
            tiles[image].alpha_mode = image.alpha_mode
        users = [node for tree in trees for node in tree.nodes if getattr(node, "image", None) in tiles]
        notes += [f"image '{image.name}': of its UDIM tiles, only the first is brought over" for image in tiles
                  if any(node.image == image for node in users)]
        with changed((node, "image", tiles[node.image]) for node in users):
            yield
    finally:
        for tile in tiles.values():
            images.remove(tile)


@contextmanager
def context_of(scene: Any, view_layer: Any) -> Iterator[None]:
    """The scene and the view layer as what the exporter takes for the current ones."""
    window = bpy.context.window or next((window for manager in bpy.data.window_managers for window in manager.windows), None)
    if window is None:
        raise ExportError("there is no window, not even an unseen one, which Blender's glTF exporter needs")
    before, active = (window.scene, window.view_layer), window.view_layer.objects.active
    mode = active.mode if active is not None else "OBJECT"
    show_in(window, scene, view_layer)
    try:
        with bpy.context.temp_override(window=window, scene=scene, view_layer=view_layer):
            yield
    finally:
        show_in(window, *before)
        # The exporter takes it out of the mode in which the user has it.
        if active is not None and active.mode != mode:
            with bpy.context.temp_override(window=window):
                bpy.ops.object.mode_set(mode=mode)


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


def sees_groups() -> bool:
    """Returns whether the exporter, which has run, looks into groups of nodes: newer ones do."""
    return any(name.startswith("io_scene_gltf2.") and hasattr(module, "get_material_nodes")
               for name, module in list(sys.modules.items()))


def reason_of(message: str) -> str:
    """Returns the line of an operator's error that says what is wrong: no place in Blender's Python."""
    lines = [line.strip() for line in message.splitlines()]
    said = [line for line in lines if line and not line.startswith(("Location:", "File ", "Traceback", "Error: Python:"))
            and not line.endswith("... truncated") and line.strip("^~ ")]
    return said[-1].removeprefix("Error: ") if said else "the console shows where"


def write_gltf(path: Path) -> None:
    operator = exporter()
    known = {item.identifier for item in operator.get_rna_type().properties}
    options = {name: value for name, value in OPTIONS.items() if name in known}
    try:
        operator("EXEC_DEFAULT", filepath=str(path), **options)
    except RuntimeError as error:
        raise ExportError(f"Blender's glTF exporter failed: {reason_of(str(error))}") from None
    if not path.exists():
        raise ExportError("Blender's glTF exporter has written no file")


@dataclass
class Gltf:
    """Blender's export, with the objects of its nodes and the materials of its materials; and how nodes move."""

    document: dict[str, Any]
    binary: bytes
    tree: Tree
    materials: list[Any]
    notes: list[str]
    times: list[float] = field(default_factory=list)
    motions: dict[int, glb.Motion] = field(default_factory=dict)


def read_gltf(scene: Any, view_layer: Any, path: Path) -> Gltf:
    """Has Blender export the scene to the path, and reads that."""
    objects, materials, notes = list(bpy.data.objects), list(bpy.data.materials), []
    trees = [material.node_tree for material in materials if material.node_tree is not None] + list(bpy.data.node_groups)
    owners = [*objects, *materials, *trees, *bpy.data.cameras, *bpy.data.lights, *bpy.data.shape_keys, *bpy.data.worlds]
    with context_of(scene, view_layer), kept(keyed(owners)), as_rendered(scene, view_layer, bpy.data):
        with first_tiles(bpy.data.images, trees, notes), changed(vertex_colors.choices(bpy.data.meshes)):
            scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)
            foreign = foreign_materials(bpy.context.evaluated_depsgraph_get())
            with carried(foreign, scene), colors_of_corners(), numbered(objects), numbered(materials):
                write_gltf(path)
        document, binary = glb.read_glb(path)
        nodes = document.get("nodes", [])
        tree = tree_of(nodes, take_blocks(nodes, objects))
        result = Gltf(document, binary, tree, take_blocks(document.get("materials", []), materials, True), notes)
        straighten(document, tree)
        blurred = has_motion_blur(scene, view_layer)
        if blurred or view_layer.use_pass_vector:
            result.times, result.motions = find_motions(scene, document, tree, blurred, notes)
    return result
