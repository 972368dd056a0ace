"""Runs inside Blender: imports a scene as tools/lab/compare-cycles planned it, and renders it with Cycles as it is told.

    blender --background --factory-startup --python blender_scene.py -- PLAN.json ANSWERS

Reads one JSON object per line from standard input, {"spp", "seed", "output"}, renders to that EXR, and writes
{"cpu", "wall"} in seconds to the file descriptor ANSWERS, the first line when the scene is ready."""

import json
import math
import os
import sys
import time
from pathlib import Path

import bpy
import numpy
from mathutils import Matrix, Vector

# What importer of Blender 3.4 calls bool; NumPy 1.24 took the name away.
numpy.bool = bool


MOST_LAMPS = 64
FEWEST_CORNERS_OF_SPHERE = 400  # fewer would be a sphere of another size


def to_blender(vector):
    """glTF's axes have +Y up, Blender's +Z."""
    x, y, z = vector
    return Vector((x, -z, y))


def import_gltf(path):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    # COMPAT: candela and lux enter as watts per steradian and square metre, one to one.
    bpy.ops.import_scene.gltf(filepath=path, convert_lighting_mode="COMPAT")


class Nodes:
    """A material's tree, made anew. What the importer linked to the base colour is kept."""

    def __init__(self, material):
        material.use_nodes = True
        self.tree = material.node_tree
        principled = next((node for node in self.tree.nodes if node.type == "BSDF_PRINCIPLED"), None)
        self.base, self.base_color = None, (1.0, 1.0, 1.0, 1.0)
        if principled is not None:
            socket = principled.inputs["Base Color"]
            self.base = socket.links[0].from_socket if socket.is_linked else None
            self.base_color = tuple(socket.default_value)
        for node in list(self.tree.nodes):
            if node.type in ("BSDF_PRINCIPLED", "OUTPUT_MATERIAL", "VOLUME_ABSORPTION", "EMISSION", "ADD_SHADER",
                             "MIX_SHADER"):
                self.tree.nodes.remove(node)
        self.output = self.add("ShaderNodeOutputMaterial")

    def add(self, kind, **properties):
        node = self.tree.nodes.new(kind)
        for name, value in properties.items():
            setattr(node, name, value)
        return node

    def link(self, source, target):
        self.tree.links.new(source, target)

    def curve(self, rows):
        """The colour that `rows` of 1 - cosine and r, g, b have at the surface's angle to the eye."""
        weight = self.add("ShaderNodeLayerWeight")
        weight.inputs["Blend"].default_value = 0.5  # 'Facing' is then 1 - cosine
        node = self.add("ShaderNodeRGBCurve")
        node.mapping.use_clip = False
        for channel in range(3):
            points = node.mapping.curves[channel].points
            while len(points) < len(rows):
                points.new(0.5, 0.5)
            for point, row in zip(points, rows):
                point.location = (row[0], row[1 + channel])
                point.handle_type = "VECTOR"
        node.mapping.update()
        self.link(weight.outputs["Facing"], node.inputs["Color"])
        return node.outputs["Color"]

    def shader(self, kind, color, **properties):
        node = self.add(kind, **properties)
        if isinstance(color, bpy.types.NodeSocket):
            self.link(color, node.inputs["Color"])
        else:
            node.inputs["Color"].default_value = (*color[:3], 1.0)
        return node

    def glossy(self, plan):
        rough = plan["roughness"]
        node = self.shader("ShaderNodeBsdfGlossy", self.curve(plan["curve"]), distribution="GGX" if rough else "SHARP")
        node.inputs["Roughness"].default_value = rough
        return node.outputs["BSDF"]

    def sum(self, a, b):
        node = self.add("ShaderNodeAddShader")
        self.link(a, node.inputs[0])
        self.link(b, node.inputs[1])
        return node.outputs[0]

    def plastic(self, plan):
        passed = plan["passed"]
        if self.base is None:
            color = self.curve([[row[0], *(v * c for v, c in zip(row[1:], self.base_color))] for row in passed])
        else:
            product = self.add("ShaderNodeMixRGB", blend_type="MULTIPLY")
            product.inputs["Fac"].default_value = 1.0
            self.link(self.base, product.inputs["Color1"])
            self.link(self.curve(passed), product.inputs["Color2"])
            color = product.outputs["Color"]
        diffuse = self.shader("ShaderNodeBsdfDiffuse", color)
        return self.sum(diffuse.outputs["BSDF"], self.glossy(plan))

    def surface(self, plan):
        kind = plan["kind"]
        if kind == "diffuse":
            # Black scatters nothing; without the node Cycles need not find that out.
            return self.shader("ShaderNodeBsdfDiffuse", plan["color"]).outputs["BSDF"] if any(plan["color"]) else None
        if kind == "glass":
            node = self.shader("ShaderNodeBsdfGlass", (1.0, 1.0, 1.0), distribution="SHARP")
            node.inputs["IOR"].default_value = plan["ior"]
            return node.outputs["BSDF"]
        return self.glossy(plan) if kind == "metal" else self.plastic(plan)

    def emission(self, radiance, front_only):
        strength = max(radiance)
        node = self.shader("ShaderNodeEmission", [channel / strength for channel in radiance])
        node.inputs["Strength"].default_value = strength
        if not front_only:
            return node.outputs[0]
        mix = self.add("ShaderNodeMixShader")
        self.link(self.add("ShaderNodeNewGeometry").outputs["Backfacing"], mix.inputs["Fac"])
        self.link(node.outputs[0], mix.inputs[1])
        return mix.outputs[0]

    def absorption(self, coefficients):
        """Cycles absorbs density (1 - colour) per metre."""
        density = max(coefficients)
        node = self.shader("ShaderNodeVolumeAbsorption", [1.0 - c / density for c in coefficients])
        node.inputs["Density"].default_value = density
        self.link(node.outputs["Volume"], self.output.inputs["Volume"])


def is_closed(mesh):
    """Whether no back of its faces can be seen from outside: every edge has a neighbour that runs against it. Vertices
    at one place are one."""
    numbers, edges = {}, set()
    places = [numbers.setdefault(tuple(round(c, 7) for c in vertex.co), len(numbers)) for vertex in mesh.vertices]
    for polygon in mesh.polygons:
        corners = [places[i] for i in polygon.vertices]
        edges.update(zip(corners, corners[1:] + corners[:1]))
    return all((b, a) in edges for a, b in edges)


def make_material(material, plan):
    nodes = Nodes(material)
    surface = nodes.surface(plan)
    if any(plan["emission"]):
        users = [mesh for mesh in bpy.data.meshes if material.name in mesh.materials]
        front_only = not plan["double_sided"] and not all(is_closed(mesh) for mesh in users)
        light = nodes.emission(plan["emission"], front_only)
        surface = nodes.sum(surface, light) if surface is not None else light
    if surface is not None:
        nodes.link(surface, nodes.output.inputs["Surface"])
    if plan.get("absorption"):
        nodes.absorption(plan["absorption"])
    material.cycles.sample_as_light = True


def places_of(item):
    """Distinct vertices of an object in the world."""
    return [Vector(place) for place in {tuple(round(c, 6) for c in item.matrix_world @ vertex.co)
                                        for vertex in item.data.vertices}]


def lamp_shape(item):
    """The kind of lamp that has the shape of a mesh, with its properties, its area and its frame; or None."""
    places = places_of(item)
    middle = sum(places, Vector()) / len(places)
    radii = [(place - middle).length for place in places]
    radius = max(radii)
    even = min(radii) > 0.999 * radius
    normals = [item.matrix_world.to_3x3() @ polygon.normal for polygon in item.data.polygons]
    normal = normals[0].normalized()
    if any(normal.dot(other.normalized()) < 0.9999 for other in normals):
        return ("POINT", {"shadow_soft_size": radius}, None, Matrix.Translation(middle)) if (
            even and len(places) >= FEWEST_CORNERS_OF_SPHERE and is_closed(item.data)) else None
    rim = [place for place, r in zip(places, radii) if r > 0.999 * radius]
    if len(places) == 4 and even:
        a, b, c = (place - places[0] for place in places[1:])
        u, v = sorted((a, b, c), key=lambda side: side.length)[:2]
        properties, area = {"shape": "RECTANGLE", "size": u.length, "size_y": v.length}, u.length * v.length
    elif len(rim) >= len(places) - 1 and len(rim) >= 12:
        # A disc of as much area as the polygon.
        area = sum(polygon.area for polygon in item.data.polygons) * item.matrix_world.to_scale()[0] ** 2
        properties, u = {"shape": "DISK", "size": 2.0 * math.sqrt(area / math.pi)}, rim[0] - middle
    else:
        return None
    x, z = u.normalized(), -normal  # a lamp shines along its -Z
    return "AREA", properties, area, Matrix.Translation(middle) @ Matrix((x, z.cross(x), z)).transposed().to_4x4()


def make_lamp(scene, item, radiance, shape):
    """A lamp for all rays but those of the camera, in place of an object that glows on its front."""
    kind, properties, area, frame = shape
    light = bpy.data.lights.new(item.name, kind)
    for name, value in properties.items():
        setattr(light, name, value)
    brightest = max(radiance)
    light.color = [channel / brightest for channel in radiance]
    # Radiance is the watts over 4 areas; of a sphere, over 4 pi times the disc that one sees.
    light.energy = brightest * 4.0 * (area if kind == "AREA" else (math.pi * light.shadow_soft_size) ** 2)
    light.cycles.use_multiple_importance_sampling = True
    lamp = bpy.data.objects.new(item.name, light)
    lamp.matrix_world = frame
    scene.collection.objects.link(lamp)
    # What is behind a lamp shines through it. For the eye, the object stays.
    lamp.visible_camera = False
    item.visible_diffuse = item.visible_glossy = item.visible_transmission = False
    item.visible_volume_scatter = item.visible_shadow = False
    item.data.materials[0].cycles.sample_as_light = False


def make_lamps(scene, plan):
    """Where several rectangles, discs and spheres glow and nothing else does, lamps in their place: Cycles 3.4 chooses
    among lamps evenly, but among triangles by area, however bright they are. Returns how many."""
    found = []
    for item in scene.objects:
        for material in item.data.materials if item.type == "MESH" else ():
            given = plan["materials"].get(material.name)
            if given is None or any(given["emission"]):
                found.append((item, given))
    if not 2 <= len(found) <= MOST_LAMPS:
        return 0
    shapes = [lamp_shape(item) if given and not given["double_sided"] and len(item.data.materials) == 1 else None
              for item, given in found]
    if any(shape is None for shape in shapes):
        return 0
    for (item, given), shape in zip(found, shapes):
        make_lamp(scene, item, given["emission"], shape)
    return len(found)


def make_camera(scene, plan, size):
    given = plan["camera"]
    if "name" in given:
        camera = next(item for item in bpy.data.objects if item.type == "CAMERA" and item.data.name == given["name"])
    else:
        camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
        scene.collection.objects.link(camera)
        position = to_blender(given["position"])
        back = (position - to_blender(given["look_at"])).normalized()
        right = to_blender(given["up"]).cross(back).normalized()
        frame = Matrix((right, back.cross(right), back)).transposed().to_4x4()
        camera.matrix_world = Matrix.Translation(position) @ frame
    data = camera.data
    data.type, data.sensor_fit, data.sensor_height = "PERSP", "VERTICAL", 24.0
    data.lens_unit, data.lens = "MILLIMETERS", 12.0 / math.tan(0.5 * given["yfov"])
    data.clip_start, data.clip_end = 1e-4, 1e6
    data.shift_x = data.shift_y = 0.0
    data.dof.use_dof = False
    scene.camera = camera
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.render.pixel_aspect_x = scene.render.pixel_aspect_y = 1.0


def make_lights(plan):
    for light in bpy.data.lights:
        given = plan["lights"][light.name]
        light.color = given["color"]
        # A point light of P watts has P / 4 pi watts per steradian, a sun's strength is its irradiance.
        light.energy = given["intensity"] * (1.0 if given["type"] == "directional" else 4.0 * math.pi)
        if given["type"] == "directional":
            light.angle = 0.0
        else:
            light.shadow_soft_size = 0.0
        light.cycles.cast_shadow = True


def make_world(scene, given):
    world = bpy.data.worlds.new("world")
    scene.world = world
    world.use_nodes = True
    tree = world.node_tree
    background = next(node for node in tree.nodes if node.type == "BACKGROUND")
    if given is None:
        background.inputs["Color"].default_value = (0.0, 0.0, 0.0, 1.0)
        background.inputs["Strength"].default_value = 0.0
        return
    background.inputs["Strength"].default_value = given["scale"]
    world.cycles_visibility.camera = given["visible"]
    background.inputs["Color"].default_value = (*given["color"], 1.0)
    if given["image"] is None:
        return
    image = tree.nodes.new("ShaderNodeTexEnvironment")
    image.image = bpy.data.images.load(given["image"])
    image.image.colorspace_settings.name = "Linear"
    coordinates, mapping = tree.nodes.new("ShaderNodeTexCoord"), tree.nodes.new("ShaderNodeMapping")
    # Blender has the middle of the image towards glTF's +X, Etendue towards -Z.
    mapping.inputs["Rotation"].default_value = (0.0, 0.0, -0.5 * math.pi - given["rotation"])
    tint = tree.nodes.new("ShaderNodeMixRGB")
    tint.blend_type = "MULTIPLY"
    tint.inputs["Fac"].default_value = 1.0
    tint.inputs["Color2"].default_value = (*given["color"], 1.0)
    tree.links.new(coordinates.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], image.inputs["Vector"])
    tree.links.new(image.outputs["Color"], tint.inputs["Color1"])
    tree.links.new(tint.outputs["Color"], background.inputs["Color"])


def set_cycles(scene, plan):
    render, cycles = scene.render, scene.cycles
    render.engine, cycles.device, cycles.feature_set = "CYCLES", "CPU", "SUPPORTED"
    render.threads_mode, render.threads = "FIXED", plan["threads"]
    render.use_persistent_data = True
    render.film_transparent = render.use_motion_blur = False
    render.use_compositing = render.use_sequencer = False
    render.dither_intensity = 0.0
    cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_guiding = False
    cycles.time_limit = 0.0
    cycles.pixel_filter_type = "BOX"
    cycles.film_exposure = 1.0
    bounces = plan["max_bounces"]
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = bounces
    cycles.transmission_bounces = cycles.volume_bounces = bounces
    cycles.transparent_max_bounces = 1024
    cycles.min_light_bounces = plan["roulette_bounces"]
    cycles.min_transparent_bounces = 0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.blur_glossy = cycles.light_sampling_threshold = 0.0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.use_fast_gi = False
    settings = render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth, settings.exr_codec = "OPEN_EXR", "RGB", "32", "ZIP"
    scene.view_settings.view_transform, scene.view_settings.look = "Raw", "None"
    scene.view_settings.exposure, scene.view_settings.gamma = 0.0, 1.0
    for item in scene.objects:
        if item.type == "MESH":
            # Both move shadows at the terminator of smooth normals.
            item.cycles.shadow_terminator_offset = item.cycles.shadow_terminator_geometry_offset = 0.0


def build(plan):
    import_gltf(plan["gltf"])
    scene = bpy.context.scene
    for material in {material for mesh in bpy.data.meshes for material in mesh.materials}:
        # The importer makes a second material, with a number behind its name, for meshes with colours.
        name = material.name if material.name in plan["materials"] else material.name.rsplit(".", 1)[0]
        make_material(material, plan["materials"][name])
    make_camera(scene, plan, plan["size"])
    make_lights(plan)
    bpy.context.view_layer.update()
    lamps = make_lamps(scene, plan) if plan["lamps"] else 0
    make_world(scene, plan["environment"])
    set_cycles(scene, plan)
    return scene, lamps


def render(scene, order):
    scene.cycles.samples, scene.cycles.seed = order["spp"], order["seed"]
    output = Path(order["output"])
    scene.render.filepath = str(output.with_suffix(""))
    cpu, wall = time.process_time(), time.monotonic()
    bpy.ops.render.render(write_still=True)
    return {"cpu": time.process_time() - cpu, "wall": time.monotonic() - wall}


def main():
    plan_file, descriptor = sys.argv[sys.argv.index("--") + 1:]
    with os.fdopen(int(descriptor), "w", buffering=1) as answers:
        scene, lamps = build(json.loads(Path(plan_file).read_text()))
        print(json.dumps({"blender": bpy.app.version_string, "lamps": lamps}), file=answers)
        for line in sys.stdin:
            print(json.dumps(render(scene, json.loads(line))), file=answers)


if __name__ == "__main__":
    main()
