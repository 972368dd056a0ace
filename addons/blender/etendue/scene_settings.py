"""render.json: what the settings are, and what the exporter of glTF drops of a scene. Takes objects that look like
Blender's, and needs nothing of Blender itself."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from .lamps import is_portal, lamp, spot_cones
from .materials import anisotropy, material
from .worlds import environment, mist
from .written import Document, Written

__all__ = ["Document", "Written", "anisotropy", "environment", "lamp", "material", "mist", "spot_cones", "write"]

REC709 = "Linear Rec.709 (sRGB)"
LEAST_SIZE = 1e-4  # metres of the side of a lamp


# --- the image

def image_size(render: Any) -> tuple[int, int]:
    """Width and height in pixels, as Blender computes them."""
    return tuple(max(1, int(side * render.resolution_percentage / 100)) for side in (render.resolution_x, render.resolution_y))


def border(render: Any) -> tuple[int, int, int, int] | None:
    """The render border as x0, y0, x1, y1 with y down from the top, cut as Blender does, in single precision."""
    if not render.use_border:
        return None
    width, height = image_size(render)
    x0, x1 = (int(single(x * width)) for x in (render.border_min_x, render.border_max_x))
    y0, y1 = (height - int(single(y * height)) for y in (render.border_max_y, render.border_min_y))
    return (x0, y0, max(x1, x0 + 1), max(y1, y0 + 1))


def single(value: float) -> float:
    return struct.unpack("<f", struct.pack("<f", value))[0]


def shutter(render: Any, position: str) -> tuple[float, float]:
    """Returns when the shutter opens and closes, in frames from the current one."""
    length = render.motion_blur_shutter
    start = {"START": 0.0, "CENTER": -0.5 * length, "END": -length}[position]
    return start, start + length


def film_settings(render: Any, settings: Any) -> Document:
    film: Document = {"filter": settings.filter}
    if settings.filter_radius > 0.0:
        film["filter_radius"] = max(settings.filter_radius, 0.1)
    if render.pixel_aspect_x != render.pixel_aspect_y:
        film["pixel_aspect"] = render.pixel_aspect_x / render.pixel_aspect_y
    return film


def integrator_settings(settings: Any) -> Document:
    """Returns the settings that the chosen integrator reads; with 'auto', those of bdpt and vcm, too."""
    kind = settings.integrator
    result: Document = {"type": kind, "max_depth": settings.max_depth}
    if kind in ("path", "direct"):
        result["light_samples"] = settings.light_samples
    if kind in ("auto", "bdpt", "vcm"):
        result["heuristic"] = settings.heuristic
        if settings.connections > 0:
            result["connections"] = f"cache:{settings.connections}"
    if kind in ("auto", "vcm"):
        result |= {"merge": settings.merge, "merge_radius": settings.merge_radius}
    return result


# --- the camera

def camera_setting(camera: Any, name: str, default: Any = None) -> Any:
    """A setting that Blender has at the camera, or at its `cycles` in earlier versions."""
    if hasattr(camera, name):
        return getattr(camera, name)
    return getattr(getattr(camera, "cycles", None), name, default)


def view_size(render: Any) -> tuple[float, float]:
    """Width and height of the image as it is shown, in any unit."""
    width, height = image_size(render)
    return width * render.pixel_aspect_x, height * render.pixel_aspect_y


def fitted_side(camera: Any, width: float, height: float) -> float:
    """The side of the image, of these two, that the sensor, an orthographic scale and shifts are meant for."""
    by_width = camera.sensor_fit == "HORIZONTAL" or (camera.sensor_fit == "AUTO" and width >= height)
    return width if by_width else height


def orthographic_halves(camera: Any, width: float, height: float) -> tuple[float, float]:
    """Half the width and half the height that an orthographic camera sees, metres."""
    scale = 0.5 * camera.ortho_scale / fitted_side(camera, width, height)
    return scale * width, scale * height


def sensor_of_longer_side(camera: Any, width: float, height: float) -> float:
    """Millimetres of the longer side of the image on the sensor that the focal length is meant for."""
    sensor = camera.sensor_height if camera.sensor_fit == "VERTICAL" else camera.sensor_width
    return sensor * max(width, height) / fitted_side(camera, width, height)


def focus_distance(camera: Any, matrix: Sequence[Sequence[float]]) -> float:
    """Along the axis of the camera, also where an object or a bone of it says it."""
    target = camera.dof.focus_object
    if target is None:
        return max(camera.dof.focus_distance, 1e-6)
    bones = getattr(getattr(target, "pose", None), "bones", {})
    bone = bones.get(getattr(camera.dof, "focus_subtarget", ""))
    place = [bone.matrix[r][3] for r in range(4)] if bone is not None else [0.0, 0.0, 0.0, 1.0]
    there = [sum(a * b for a, b in zip(row, place)) for row in target.matrix_world]
    length = math.sqrt(sum(matrix[r][2] ** 2 for r in range(3))) or 1.0
    distance = -sum((there[r] - matrix[r][3]) * matrix[r][2] for r in range(3)) / length
    return max(abs(distance), 1e-6)


def lens(camera: Any, matrix: Sequence[Sequence[float]], width: float, height: float) -> Document:
    """Depth of field, for whichever camera is chosen."""
    dof = camera.dof
    if not dof.use_dof or camera.type == "PANO":
        return {}
    stop = max(dof.aperture_fstop, 1e-5)
    result: Document = {"focus_distance": focus_distance(camera, matrix)}
    if camera.type == "ORTHO":
        return result | {"lens_radius": 0.5 / stop}  # as Cycles has it
    return result | {"f_stop": stop, "sensor_width": sensor_of_longer_side(camera, width, height)}


def camera_settings(camera: Any, written: Written, width: float, height: float) -> Document:
    """The entry of `cameras` for a view of this size: what glTF has no place for."""
    result: Document = {}
    if camera.shift_x or camera.shift_y:
        share = fitted_side(camera, width, height) / max(width, height)
        result["shift"] = [camera.shift_x * share, camera.shift_y * share]
    result |= {"clip_start": camera.clip_start, "clip_end": camera.clip_end}
    if camera.dof.use_dof and camera.type != "PANO":
        if camera.dof.aperture_blades >= 3:
            result |= {"blades": camera.dof.aperture_blades, "blade_rotation": camera.dof.aperture_rotation}
        if camera.dof.aperture_ratio != 1.0:
            result["aperture_ratio"] = camera.dof.aperture_ratio
    if camera.type == "PANO":
        if camera.dof.use_dof:
            written.note("panoramas have no depth of field")
        kind = camera_setting(camera, "panorama_type", "EQUIRECTANGULAR")
        if kind == "EQUIRECTANGULAR":
            result["type"] = "equirectangular"
        elif kind == "FISHEYE_EQUIDISTANT":
            result |= {"type": "fisheye", "fov": camera_setting(camera, "fisheye_fov", math.pi)}
        elif kind == "FISHEYE_EQUISOLID":
            result |= {"type": "fisheye", "mapping": "equisolid", "fov": camera_setting(camera, "fisheye_fov", math.pi),
                       "focal_length": camera_setting(camera, "fisheye_lens", 10.5), "sensor_width": camera.sensor_width}
        else:
            written.note(f"cameras of the kind {kind} are not brought over: shown as a panorama")
            result["type"] = "equirectangular"
        limits = [abs(camera_setting(camera, f"{name}_{end}", whole)) - whole for name, whole in
                  (("latitude", 0.5 * math.pi), ("longitude", math.pi)) for end in ("min", "max")]
        if result["type"] == "equirectangular" and any(abs(limit) > 1e-4 for limit in limits):
            written.note("limits of latitude and longitude are not brought over: panoramas show all around")
    return result


# --- all of it

def clamp(entry: Document, what: str, written: Written) -> None:
    """Brings a world's strength below 0 and lamps' sizes of 0, which Blender has, into what the program takes."""
    for key, least in (("scale", 0.0), ("width", LEAST_SIZE), ("height", LEAST_SIZE)):
        if entry.get(key, least) < least:
            written.notes.append(f"{what}: its {key} of {entry[key]:g} is brought over as {least:g}")
            entry[key] = least


def write(scene: Any, objects: Iterable[Any], materials: Iterable[tuple[Any, bool]], aovs: Sequence[str],
          moving: tuple[float, float] | None = None, camera: Any = None, version: Sequence[int] = (3, 4, 0),
          view_layer: Any = None, name_of: Callable[[Any], str] = lambda item: item.name, override_seen: bool = False,
          with_groups: bool = False) -> Written:
    """render.json for a scene of Blender's `version`: `objects` are those that are rendered, `materials` theirs, each with
    whether all meshes that have it are closed, `moving` the seconds in which the shutter is open. `name_of` gives the names
    that the file has; `override_seen`: it has the material that overrides all others, `with_groups`: the exporter sees
    what groups of nodes have."""
    written = Written()
    render, settings = scene.render, scene.etendue
    camera, world = camera or scene.camera, getattr(view_layer, "world_override", None) or scene.world
    width, height = image_size(render)
    document: Document = {
        "scene": "scene.glb", "size": [width, height], "seed": settings.seed,
        "spp": getattr(view_layer, "samples", 0) or settings.samples, "integrator": integrator_settings(settings),
        "film": film_settings(render, settings),
        "color": {"working_space": REC709 if settings.working_space == "REC709" else "ACEScg", "output_space": REC709,
                  "view": "Un-tone-mapped", "exposure": 0.0},
        "camera": name_of(camera)}
    window = border(render)
    if window is not None:
        document["crop"] = list(window)
    if settings.time > 0.0:
        document["time"] = settings.time
    if settings.error > 0.0:
        document |= {"error": settings.error, "adaptive": settings.adaptive, "min_spp": settings.min_samples}
    if settings.clamp_indirect > 0.0:
        document["clamp_indirect"] = settings.clamp_indirect
    if settings.robust > 1:
        document["robust"] = f"mon:{settings.robust | 1}"
    if aovs:
        document["aovs"] = list(aovs)
    if "mist" in aovs and world is not None:
        document["mist"] = mist(world.mist_settings)
    if moving is not None:
        # The layer `vector` is in frames.
        document |= {"time_code": 0.0, "shutter": list(moving), "fps": render.fps / render.fps_base}
    matrix = camera.matrix_world
    document |= lens(camera.data, matrix, *view_size(render))
    document["cameras"] = {name_of(camera): camera_settings(camera.data, written, *view_size(render))}
    lit = getattr(view_layer, "use_sky", True)
    given = environment(world, render.film_transparent, written) if lit else None
    if given is not None:
        document["environment"] = given
    else:
        document["studio"] = False  # a scene without light is black in Blender
    lights = {name_of(item): lamp(item, version, written) for item in objects
              if item.type == "LIGHT" and not is_portal(item.data)}
    if lights:
        document["lights"] = lights
    override = getattr(view_layer, "material_override", None)
    entries = {name_of(item): material(item, closed, written, item == override and not override_seen, name_of(item), with_groups)
               for item, closed in materials}
    entries = {name: entry for name, entry in entries.items() if entry}
    if entries:
        document["materials"] = entries
    clamp(document.get("environment", {}), "the world", written)
    for name, entry in document.get("lights", {}).items():
        clamp(entry, f"lamp '{name}'", written)
    written.document = document
    return written
