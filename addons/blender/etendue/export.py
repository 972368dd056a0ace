"""A scene of Blender's as a scene directory of the program: what its exporter writes, mended, and what that leaves out."""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import bpy
import numpy

from . import glb, glb_materials, layers, overlooked, passes, scene_settings, textures, vertex_colors
from .exporter import ExportError, Gltf, on_main_thread, read_gltf, sees_groups
from .exr import write_exr
from .identity import Tree, rendered_nodes, unique_names
from .images import image_bytes
from .placement import Y_UP, columns, is_sheared, world_matrices
from .program import known_part
from .rendered import Rendered, rendered_objects
from .surfaces import Surface, materials_of, surfaces_of
from .written import Written


@dataclass
class Exported:
    folder: Path
    arguments: list[str] = field(default_factory=list)
    gltf: dict[str, Any] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    indices: dict[str, dict[str, int]] = field(default_factory=dict)  # pass indices that are not 0, by layer and name


def give_names(gltf: Gltf, objects: Iterable[Any], materials: Iterable[Any]) -> dict[Any, str]:
    """Gives nodes and materials names by which they are told apart, and returns those, and those of these data-blocks."""
    names = {}
    for key, here, others in (("nodes", gltf.tree.objects, objects), ("materials", gltf.materials, materials)):
        names |= unique_names([item for item in (*here, *others) if item is not None])
        for entry, item in zip(gltf.document.get(key, []), here):
            if item is not None:
                entry["name"] = names[item]
    # A bone may be called as the camera, or as a lamp.
    glb.rename(gltf.document, [number for number, item in enumerate(gltf.tree.objects) if item is None], names.values())
    return names


def place_world_image(image: Any, folder: Path, environment: dict[str, Any]) -> list[str]:
    """Has the environment name the image: the file that it is of, or a copy of its pixels. Returns arguments."""
    source = Path(bpy.path.abspath(image.filepath, library=image.library)).resolve() if image.filepath else None
    plain = image.source == "FILE" and not image.packed_file and not image.is_dirty
    linear = image.colorspace_settings.name in textures.LINEAR
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


def bytes_of(image: Any, times_alpha: bool) -> tuple[bytes, str]:
    path = Path(bpy.path.abspath(image.filepath, library=image.library)) if image.filepath else None
    return image_bytes(image, path, times_alpha)


def move_instanced_areas(gltf: Gltf, lights: dict[str, Any], rendered: Rendered, shown: Collection[int],
                         names: dict[Any, str]) -> None:
    """Takes area lamps that stand in instances out of render.json, where each stands in one place, to their nodes."""
    for item in {item for _, item in rendered.instanced if item.type == "LIGHT" and item.data.type == "AREA"}:
        entry = lights.pop(names[item], None)
        if entry is not None:
            glb.add_extras(gltf.document, {number: entry for number in shown if gltf.tree.objects[number] == item})


def scatter(document: dict[str, Any], tree: Tree, rendered: Rendered, meshes: dict[Any, int],
            names: dict[Any, str]) -> set[tuple[Any, Any]]:
    """Adds nodes for instances of geometry nodes, which the exporter drops, below the nodes of their objects. Returns the
    pairs of an instancer and what it instances."""
    nodes = document["nodes"]
    places = {item: number for number, item in tree.own().items()}
    worlds = world_matrices(document, tree)
    added = set()
    for instance in rendered.scattered:
        above = places.get(instance.instancer)
        if instance.source not in meshes or above is None:
            continue
        local = worlds[above].inverted_safe() @ Y_UP @ instance.matrix @ Y_UP.inverted()
        nodes.append({"name": names[instance.source], "mesh": meshes[instance.source], "matrix": columns(local)})
        nodes[above].setdefault("children", []).append(len(nodes) - 1)
        added.add((instance.instancer, instance.source))
    return added


def mend_nodes(gltf: Gltf, rendered: Rendered, camera: Any, render: Any, lights: dict[str, Any],
               names: dict[Any, str]) -> set[tuple[Any, Any]]:
    """Makes the nodes those that are rendered, with their cameras and lamps. Returns the pairs of an instancer and what it
    instances."""
    document, tree, name = gltf.document, gltf.tree, names[camera.original]
    glb.ensure_camera(document, name, columns(Y_UP @ camera.matrix_world))
    glb.give_nodes_their_own(document)
    if camera.data.type == "ORTHO":
        # The exporter takes the scale to be that of the longer side, whatever the sensor fits.
        glb.set_orthographic(document, name, scene_settings.orthographic_halves(camera.data, *scene_settings.view_size(render)))
    shown = rendered_nodes(tree, rendered.single, rendered.instanced)
    meshes = {item: document["nodes"][number]["mesh"] for number, item in enumerate(tree.objects)
              if item is not None and "mesh" in document["nodes"][number]}
    glb.leave_out(document, shown)
    glb.set_spots(document, {names[original]: scene_settings.spot_cones(item.data) for original, item in rendered.items.items()
                             if item.type == "LIGHT" and item.data.type == "SPOT"})
    move_instanced_areas(gltf, lights, rendered, shown, names)
    return tree.pairs(shown) | scatter(document, tree, rendered, meshes, names)


def change_materials(document: dict[str, Any], written: Written, names: Collection[str], suffix: str,
                     change: dict[str, Any]) -> dict[str, str]:
    """Gives the meshes of these objects materials of their own, whose entries in render.json have a change. Returns which
    material each is a copy of."""
    origins = glb.give_own_materials(document, names, suffix)
    entries = written.document.setdefault("materials", {}) if origins else {}
    for name, origin in origins.items():
        entries[name] = {**entries.get(origin, {}), **change}
    return origins


def own_materials(document: dict[str, Any], written: Written, rendered: Rendered, view_layer: Any, integrator: str,
                  names: dict[Any, str]) -> dict[str, str]:
    """Gives materials of their own to holdouts, to what catches shadows and to what the camera is not to see. Returns which
    material each is a copy of."""
    items = rendered.items.values()
    replaced = overlooked.replaced(items, view_layer, integrator, written.note)
    holdouts = {names[item.original] for item in replaced if overlooked.is_holdout(item, view_layer)}
    catchers = {names[item.original] for item in replaced} - holdouts
    hidden = {names[item.original] for item in items if overlooked.is_hidden(item, view_layer)}
    return (change_materials(document, written, holdouts, "that is a holdout", {"holdout": True})
            | change_materials(document, written, catchers, "that catches shadows", {"shadow_catcher": True})
            | change_materials(document, written, hidden, "hidden from the camera", {"visible_to_camera": False}))


def give_parts(gltf: Gltf, written: Written, surfaces: dict[Any, Surface]) -> None:
    """Gives the parts of meshes the materials that they are rendered with, where modifiers set others than the exporter
    has."""
    objects, nodes = gltf.tree.objects, gltf.document.get("nodes", [])
    parts = {number: surfaces[item].parts for number, item in enumerate(objects)
             if item in surfaces and "mesh" in nodes[number]}
    failed = [objects[number] for number in glb_materials.give_parts(gltf.document, parts, gltf.materials)]
    written.notes += overlooked.said("materials that modifiers set are not brought over", failed)


def mend_surfaces(gltf: Gltf, written: Written, override: Any, names: dict[Any, str]) -> None:
    """Gives surfaces the vertex colours that they are rendered with, and the material that overrides theirs, if any."""
    document = gltf.document
    if override is not None:
        glb_materials.override(document, names[override])
        if len(document["materials"]) > len(gltf.materials):
            gltf.materials.append(override)

    def attributes(item: Any) -> tuple[list[str], list[str]]:
        shown = written.shown.get(names.get(item))
        return vertex_colors.attributes_of(item) if shown is None else vertex_colors.attributes_at(shown)

    uses = [tuple(map(bool, attributes(item))) if item is not None else (False, False) for item in gltf.materials]
    for number in glb.keep_vertex_colors(document, uses):
        written.note(f"material '{document['materials'][number]['name']}': the alpha of vertex colours is brought over with their "
                     "colour alone")
    glb.give_all_materials(document)


def take_unknown(given: dict[str, Any], document: dict[str, Any]) -> None:
    """Takes the entries out of render.json whose names the file has not, which are errors."""
    for key, owner in (("materials", "materials"), ("lights", "nodes")):
        in_file = {entry.get("name") for entry in document.get(owner, [])}
        for name in set(given.get(key, {})) - in_file:
            del given[key][name]


def pass_indices(rendered: Rendered, materials: Iterable[Any], origins: dict[str, str],
                 names: dict[Any, str]) -> dict[str, dict[str, int]]:
    """The pass indices that are not 0, by layer and name; copies of materials have those of their origins."""
    result = {layer: {names[item]: item.pass_index for item in blocks if item.pass_index != 0}
              for layer, blocks in (("object_id", rendered.items), ("material_id", materials))}
    own = result["material_id"]
    own |= {name: own[origin] for name, origin in origins.items() if origin in own}
    return result


def export_scene(scene: Any, view_layer: Any, depsgraph: Any, folder: Path, program: Path,
                 is_stopped: Callable[[], bool] = lambda: False, camera: Any = None) -> Exported:
    """Writes scene.glb and render.json into the folder. `scene` and `view_layer` are Blender's originals, `depsgraph` has
    what is rendered; `camera` is for that of the scene."""
    camera = camera or scene.camera
    if camera is None:
        raise ExportError("the scene has no camera")
    if camera.type != "CAMERA":
        raise ExportError(f"'{camera.name}', by which the scene is seen, is no camera")
    camera = camera.original.evaluated_get(depsgraph)
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / "scene.glb"
    gltf = on_main_thread(lambda: read_gltf(scene, view_layer, file), is_stopped)
    evaluated, override, document = depsgraph.scene_eval, view_layer.material_override, gltf.document
    rendered = rendered_objects(depsgraph, bpy.data.objects)
    surfaces = surfaces_of(rendered.items)
    materials = materials_of(rendered.items, surfaces, override)
    names = give_names(gltf, [*rendered.items, camera.original], [item for item, _ in materials])
    written = scene_settings.write(evaluated, rendered.items.values(), materials,
                                   passes.sources(passes.wanted(view_layer), scene.etendue.denoise),
                                   (gltf.times[0], gltf.times[-1]) if gltf.motions else None, camera, bpy.app.version,
                                   view_layer, lambda item: names[item.original], override in gltf.materials, sees_groups())
    written.notes += gltf.notes
    if is_sheared(camera.matrix_world):
        written.note(f"camera '{camera.name}': that it is sheared by what it hangs below is not brought over")
    if override is None:
        give_parts(gltf, written, surfaces)
    brought = mend_nodes(gltf, rendered, camera, evaluated.render, written.document.get("lights", {}), names)
    written.notes += overlooked.lost(scene, document, gltf.tree, rendered, surfaces, brought)
    written.notes += overlooked.notes(rendered.items.values(), view_layer)
    mend_surfaces(gltf, written, override, names)
    meshes = layers.users(rendered.items.values(), names, override)
    uv_set = layers.uv_sets(meshes, written)
    written.notes += [*layers.missing(meshes, written), *layers.tangents(written, uv_set)]
    binary = glb_materials.mend(document, gltf.binary, written, bytes_of, uv_set)
    origins = own_materials(document, written, rendered, view_layer, scene.etendue.integrator, names)
    glb.write_glb(file, document, glb.add_motion(document, binary, gltf.times, gltf.motions))
    result = Exported(folder, gltf=document, notes=written.notes,
                      indices=pass_indices(rendered, [item for item, _ in materials], origins, names))
    if written.world_image is not None:
        result.arguments += place_world_image(written.world_image, folder, written.document["environment"])
    take_unknown(written.document, document)
    known, dropped = known_part(program, written.document)
    result.notes += [f"this version of the program does not know {name}, which is left out" for name in dropped]
    (folder / "render.json").write_text(json.dumps(known, indent=1), encoding="utf-8")
    return result
