"""render.json: what the settings are, and what the exporter of glTF drops of a scene. Takes objects that look like
Blender's, and needs nothing of Blender itself."""

from __future__ import annotations

import math
import struct
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

REC709 = "Linear Rec.709 (sRGB)"
HALF_PI = 0.5 * math.pi
LEAST_SPREAD = math.radians(1.0)
OLD_SHEEN, OLD_SHEEN_ROUGHNESS = 0.2, 0.3

Document = dict[str, Any]


@dataclass
class Written:
    """render.json, an image that its environment needs, and what of the scene it does not say."""

    document: Document = field(default_factory=dict)
    world_image: Any = None
    blended: set[str] = field(default_factory=set)  # materials whose alpha the exporter may drop
    notes: list[str] = field(default_factory=list)


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
        film["filter_radius"] = settings.filter_radius
    if render.pixel_aspect_x != render.pixel_aspect_y:
        film["pixel_aspect"] = render.pixel_aspect_x / render.pixel_aspect_y
    return film


def integrator_settings(settings: Any) -> Document:
    """Only what the chosen integrator looks at."""
    kind = settings.integrator
    result: Document = {"type": kind, "max_depth": settings.max_depth}
    if kind in ("path", "direct"):
        result["light_samples"] = settings.light_samples
    if kind in ("bdpt", "vcm"):
        result["heuristic"] = settings.heuristic
        if settings.connections > 0:
            result["connections"] = f"cache:{settings.connections}"
    if kind == "vcm":
        result |= {"merge": settings.merge, "merge_radius": settings.merge_radius}
    return result


# --- lamps

def emission_of_nodes(light: Any) -> tuple[list[float], float]:
    """Colour and strength of the emission node of a lamp with nodes, by which its power is multiplied."""
    if not getattr(light, "use_nodes", False) or light.node_tree is None:
        return [1.0, 1.0, 1.0], 1.0
    for node in light.node_tree.nodes:
        if node.type == "EMISSION" and not node.inputs["Color"].is_linked and not node.inputs["Strength"].is_linked:
            return list(node.inputs["Color"].default_value)[:3], node.inputs["Strength"].default_value
    return [1.0, 1.0, 1.0], 1.0


def lamp(item: Any, version: Sequence[int]) -> Document:
    """An entry of `lights`, for Blender's `version`. The lamp stands at the node with its object's name, which the exporter leaves in any case."""
    light = item.data
    tint, strength = emission_of_nodes(light)
    power = light.energy * strength * 2.0 ** getattr(light, "exposure", 0.0)
    result: Document = {"color": [a * b for a, b in zip(light.color, tint)]}
    if light.type == "SUN":
        return result | {"irradiance": power, "angle": min(light.angle, math.pi - 1e-3)}
    if light.type in ("POINT", "SPOT"):
        result["power"] = power
        return result | ({"radius": light.shadow_soft_size, **surface(item)} if light.shadow_soft_size > 0.0 else {})
    # Etendue's area lamps have a radiance of power / (pi area), as Cycles' have; before Blender 4.0, it was power / (4 area).
    result |= {"power": power if tuple(version) >= (4,) else power * 0.25 * math.pi, **surface(item)}
    if light.spread < math.pi:
        result["spread"] = max(light.spread, LEAST_SPREAD)
    if light.shape in ("SQUARE", "RECTANGLE"):
        height = light.size if light.shape == "SQUARE" else light.size_y
        return {"type": "rectangle", "width": light.size, "height": height, **result}
    height = light.size if light.shape == "DISK" else light.size_y
    return {"type": "disk", "width": light.size, "height": height, **result}


def surface(item: Any) -> Document:
    """What lamps with a size are for others. In Cycles they stop no light, and are hidden from the camera by default."""
    return {"stops_light": False, **({} if getattr(item, "visible_camera", False) else {"visible_to_camera": False})}


def spot_cones(light: Any) -> tuple[float, float]:
    """Inner and outer angle of a spot, from its axis. Cycles fades by a smooth step of the cosine between the rim and a
    share `spot_blend` of the way to the axis, glTF by a square: over three quarters of that way it fades to as much light."""
    outer = min(0.5 * light.spot_size, HALF_PI)
    rim = math.cos(outer)
    inner = math.acos(min(rim + 0.75 * light.spot_blend * (1.0 - rim), 1.0))
    return min(inner, outer * (1.0 - 1e-4)), outer


# --- the world

def active_output(tree: Any, kind: str) -> Any:
    outputs = [node for node in tree.nodes if node.type == kind]
    return next((node for node in outputs if node.is_active_output), outputs[0] if outputs else None)


def source_of(socket: Any) -> Any:
    """The node whose output is linked to the socket; reroutes are passed."""
    while socket is not None and socket.is_linked:
        node = socket.links[0].from_node
        if node.type != "REROUTE":
            return node
        socket = node.inputs[0]
    return None


def environment(world: Any, transparent: bool, written: Written) -> Document | None:
    """The entry `environment`; its image is put into `written`."""
    if world is None:
        return None
    visible = not transparent and world_is_visible(world)
    result: Document = {} if visible else {"visible_to_camera": False}
    if not world.use_nodes or world.node_tree is None:
        return result | {"color": list(world.color)[:3]}
    output = active_output(world.node_tree, "OUTPUT_WORLD")
    if output is None:
        return None
    if source_of(output.inputs["Volume"]) is not None:
        written.notes.append("the volume of the world is not brought over")
    background = source_of(output.inputs["Surface"])
    if background is None:
        return None
    if background.type != "BACKGROUND":
        written.notes.append(f"the world's node '{background.name}' is not brought over: only Background is")
        return None
    strength = background.inputs["Strength"]
    if strength.is_linked:
        written.notes.append("what is linked to the strength of the world is not brought over")
    result["scale"] = strength.default_value
    color = background.inputs["Color"]
    texture = source_of(color)
    if texture is None:
        return result | {"color": list(color.default_value)[:3]}
    if texture.type != "TEX_ENVIRONMENT" or texture.image is None or texture.projection != "EQUIRECTANGULAR":
        written.notes.append(f"the world's node '{texture.name}' is not brought over: only equirectangular images are")
        return result | {"color": [0.0, 0.0, 0.0]}
    written.world_image = texture.image
    return result | {"image": "world.exr", "rotation": -HALF_PI - turn(texture, written)}


def world_is_visible(world: Any) -> bool:
    """Returns whether the camera sees it: Blender has the switch in one place or the other."""
    if hasattr(world, "visible_camera"):
        return world.visible_camera
    return getattr(getattr(world, "cycles_visibility", None), "camera", True)


def mist(settings: Any) -> Document:
    return {"start": settings.start, "depth": max(settings.depth, 1e-6),
            "falloff": settings.falloff.lower().replace("_", "-")}


def turn(texture: Any, written: Written) -> float:
    """Rotation about Z of the Mapping node before the texture."""
    mapping = source_of(texture.inputs["Vector"])
    if mapping is None or mapping.type == "TEX_COORD":
        return 0.0
    if mapping.type != "MAPPING":
        written.notes.append(f"the world's node '{mapping.name}' is not brought over: only Mapping is")
        return 0.0
    rotation = list(mapping.inputs["Rotation"].default_value)
    if any(abs(angle) > 1e-6 for angle in rotation[:2]):
        written.notes.append("of the rotation of the world, only that about Z is brought over")
    return -rotation[2] if mapping.vector_type == "TEXTURE" else rotation[2]


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
    """Along the axis of the camera, also where an object says it."""
    target = camera.dof.focus_object
    if target is None:
        return max(camera.dof.focus_distance, 1e-6)
    length = math.sqrt(sum(matrix[r][2] ** 2 for r in range(3))) or 1.0
    distance = -sum((target.matrix_world[r][3] - matrix[r][3]) * matrix[r][2] for r in range(3)) / length
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
        kind = camera_setting(camera, "panorama_type", "EQUIRECTANGULAR")
        if kind == "EQUIRECTANGULAR":
            result["type"] = "equirectangular"
        elif kind == "FISHEYE_EQUIDISTANT":
            result |= {"type": "fisheye", "fov": camera_setting(camera, "fisheye_fov", math.pi)}
        elif kind == "FISHEYE_EQUISOLID":
            result |= {"type": "fisheye", "mapping": "equisolid", "fov": camera_setting(camera, "fisheye_fov", math.pi),
                       "focal_length": camera_setting(camera, "fisheye_lens", 10.5), "sensor_width": camera.sensor_width}
        else:
            written.notes.append(f"cameras of the kind {kind} are not brought over: shown as a panorama")
            result["type"] = "equirectangular"
    return result


# --- materials

def value_of(node: Any, *names: str, default: Any = None) -> Any:
    """The value of the first input with one of these names, None where something is linked to it."""
    for name in names:
        socket = node.inputs.get(name)
        if socket is not None:
            if socket.is_linked:
                return None
            value = socket.default_value
            return list(value)[:3] if hasattr(value, "__len__") else value
    return default


def material(material: Any, closed: bool, written: Written) -> Document:
    """The entry of `materials`: what the exporter drops of the Principled BSDF, and simple shaders in its place. `closed`:
    all meshes that have it bound a volume."""
    if not material.use_nodes or material.node_tree is None:
        return {"diffuse": {"albedo": [min(max(channel, 0.0), 1.0) for channel in list(material.diffuse_color)[:3]]}}
    output = active_output(material.node_tree, "OUTPUT_MATERIAL")
    shader = source_of(output.inputs["Surface"]) if output is not None else None
    if output is not None and source_of(output.inputs["Displacement"]) is not None:
        written.notes.append(f"material '{material.name}': its displacement is not brought over")
    if shader is None:
        return {}
    if shader.type == "BSDF_PRINCIPLED":
        return principled(material, shader, closed, written)
    simple = simple_shader(shader, closed)
    if simple is None and shader.type not in ("EMISSION", "GROUP"):
        written.notes.append(f"material '{material.name}': the exporter knows its node '{shader.name}' in part at most")
    return simple or {}


def simple_shader(shader: Any, closed: bool) -> Document | None:
    """Factors for a shader of one lobe without textures; None for others."""
    color, rough = value_of(shader, "Color"), value_of(shader, "Roughness", default=0.0)
    if color is None or rough is None:
        return None
    color = [min(max(channel, 0.0), 1.0) for channel in color]
    if shader.type == "BSDF_DIFFUSE":
        return {"diffuse": {"albedo": color, **({"roughness": min(rough, 1.0)} if rough > 0.0 else {})}}
    if getattr(shader, "distribution", "") == "SHARP":
        rough = 0.0
    if shader.type in ("BSDF_GLOSSY", "BSDF_ANISOTROPIC"):
        return {"base_color": color, "metallic": 1.0, "roughness": rough}
    if shader.type == "BSDF_GLASS":
        ior = value_of(shader, "IOR", default=1.5)
        if ior is None or ior < 1.0:
            return None
        return {"base_color": color, "metallic": 0.0, "roughness": rough, "transmission": 1.0, "ior": ior,
                **({"solid": True} if closed else {})}
    return None


def principled(material: Any, shader: Any, closed: bool, written: Written) -> Document:
    alpha = value_of(shader, "Alpha", default=1.0)
    if alpha is None or alpha < 1.0:
        written.blended.add(material.name)
    body = subsurface(material, shader, closed, written)
    if body is not None:
        return body
    result: Document = {}
    transmission = value_of(shader, "Transmission Weight", "Transmission", default=0.0)
    if transmission is None or transmission > 0.0:
        if closed:
            result["solid"] = True
        ior = value_of(shader, "IOR", default=1.45)
        if ior is not None:
            result["ior"] = max(ior, 1.0)
        color = value_of(shader, "Base Color")
        # Since Blender 4.0, light has the colour once it has passed two of its surfaces.
        if closed and transmission == 1.0 and color and shader.inputs.get("Transmission Weight") is not None:
            result["base_color"] = [math.sqrt(min(max(channel, 0.0), 1.0)) for channel in color]
    coat = value_of(shader, "Clearcoat", default=0.0)
    if coat:
        result["clearcoat"] = 0.25 * min(coat, 1.0)  # which is what Blender before 4.0 shows of it
    film = value_of(shader, "Thin Film Thickness", default=0.0)
    if film:
        result |= {"iridescence": 1.0, "iridescence_ior": max(value_of(shader, "Thin Film IOR", default=1.33) or 1.33, 1.0),
                   "iridescence_thickness_minimum": film, "iridescence_thickness_maximum": film}
    result |= sheen(shader)
    stretch = value_of(shader, "Anisotropic", default=0.0)
    rough = value_of(shader, "Roughness", default=0.5)
    if stretch is None or (stretch and rough is None):
        written.notes.append(f"material '{material.name}': anisotropy by textures is not brought over")
    elif stretch > 0.0:
        result |= anisotropy(stretch, rough, value_of(shader, "Anisotropic Rotation", default=0.0) or 0.0)
    return result


def anisotropy(stretch: float, roughness: float, rotation: float) -> Document:
    """glTF's factors with the two widths that Cycles' lobe has: r² / a and r² a, where a = sqrt(1 - 0.9 stretch)."""
    aspect = math.sqrt(1.0 - 0.9 * min(stretch, 1.0))
    wide, narrow = min(roughness ** 2 / aspect, 1.0), min(roughness ** 2 * aspect, 1.0)
    strength = math.sqrt((wide - narrow) / (1.0 - narrow)) if narrow < 1.0 else 0.0
    return {"roughness": math.sqrt(narrow), "anisotropy_strength": strength, "anisotropy_rotation": 2.0 * math.pi * rotation}


def sheen(shader: Any) -> Document:
    weight = value_of(shader, "Sheen Weight", "Sheen", default=0.0)
    if not weight:
        return {}
    tint = value_of(shader, "Sheen Tint", default=0.0)
    if isinstance(tint, list):  # a colour, since Blender 4.0
        color, rough = tint, value_of(shader, "Sheen Roughness", default=0.5)
    else:
        base = value_of(shader, "Base Color") or [1.0, 1.0, 1.0]
        luminance = 0.2126 * base[0] + 0.7152 * base[1] + 0.0722 * base[2]
        hue = [channel / luminance if luminance > 0.0 else 1.0 for channel in base]
        # Disney's sheen, which is that of Blender before 4.0, adds a fifth as much light as glTF's: the means of a ball
        # under an even sky are then alike.
        color, rough = [OLD_SHEEN * (1.0 + (tint or 0.0) * (channel - 1.0)) for channel in hue], OLD_SHEEN_ROUGHNESS
    return {"sheen_color": [min(max(weight * channel, 0.0), 1.0) for channel in color],
            "sheen_roughness": 0.5 if rough is None else min(rough, 1.0)}


def subsurface(material: Any, shader: Any, closed: bool, written: Written) -> Document | None:
    """A translucent body in place of the material, from a weight of one half on; None below that."""
    weight = value_of(shader, "Subsurface Weight", "Subsurface", default=0.0)
    if weight is not None and weight == 0.0:
        return None
    old = shader.inputs.get("Subsurface Color") is not None
    albedo = value_of(shader, "Subsurface Color" if old else "Base Color")
    radius = value_of(shader, "Subsurface Radius")
    # Blender before 4.0 scales the radius by the weight.
    scale = weight if old else value_of(shader, "Subsurface Scale", default=1.0)
    if weight is None or weight < 0.5 or not closed or albedo is None or radius is None or scale is None:
        written.notes.append(f"material '{material.name}': subsurface scattering is brought over from a weight of 0.5 on, "
                             "without textures, on closed meshes")
        return None
    rough, ior = value_of(shader, "Roughness", default=0.5), value_of(shader, "IOR", "Subsurface IOR", default=1.4)
    return {"subsurface": {"albedo": [min(max(channel, 0.0), 1.0) for channel in albedo],
                           "radius": [max(length * scale, 1e-5) for length in radius],
                           "anisotropy": value_of(shader, "Subsurface Anisotropy", default=0.0) or 0.0,
                           "roughness": 0.5 if rough is None else rough,
                           "ior": min(max(1.4 if ior is None else ior, 1.0), 3.0)}}


# --- all of it

def write(scene: Any, objects: Iterable[Any], materials: Iterable[tuple[Any, bool]], aovs: Sequence[str],
          moving: tuple[float, float] | None = None, camera: Any = None, version: Sequence[int] = (3, 4, 0)) -> Written:
    """render.json for a scene of Blender's `version`: `objects` are those that are rendered, `materials` theirs, each with
    whether all meshes that have it are closed, `moving` the seconds in which the shutter is open."""
    written = Written()
    render, settings = scene.render, scene.etendue
    camera = camera or scene.camera
    width, height = image_size(render)
    document: Document = {
        "scene": "scene.glb", "size": [width, height], "spp": settings.samples, "seed": settings.seed,
        "integrator": integrator_settings(settings), "film": film_settings(render, settings),
        "color": {"working_space": REC709 if settings.working_space == "REC709" else "ACEScg", "output_space": REC709,
                  "view": "Un-tone-mapped", "exposure": 0.0},
        "camera": camera.name}
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
    if "mist" in aovs and scene.world is not None:
        document["mist"] = mist(scene.world.mist_settings)
    if moving is not None:
        document |= {"time_code": 0.0, "shutter": list(moving)}
    matrix = camera.matrix_world
    document |= lens(camera.data, matrix, *view_size(render))
    document["cameras"] = {camera.name: camera_settings(camera.data, written, *view_size(render))}
    given = environment(scene.world, render.film_transparent, written)
    if given is not None:
        document["environment"] = given
    else:
        document["studio"] = False  # a scene without light is black in Blender
    lights = {item.name: lamp(item, version) for item in objects if item.type == "LIGHT"}
    if lights:
        document["lights"] = lights
    entries = {item.name: material(item, closed, written) for item, closed in materials}
    entries = {name: entry for name, entry in entries.items() if entry}
    if entries:
        document["materials"] = entries
    written.document = document
    return written
