"""Scenes for tools/lab/compare-blender and the tests of the add-on, built by Blender's Python: one function for each.
Objects that are to be compared have a pass index."""

from __future__ import annotations

import math

import addon_utils
import bpy
import numpy

SCENES = {}


def scene_of(function):
    SCENES[function.__name__] = function
    return function


# --- parts

def socket(node, *names):
    """The first input with one of these names: they differ between Blender's versions."""
    return next(node.inputs[name] for name in names if name in node.inputs)


def principled(name, color=(0.8, 0.8, 0.8), **inputs):
    """`inputs`: roughness, metallic, transmission, sheen …; what has several names has them all."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    node = material.node_tree.nodes["Principled BSDF"]
    node.inputs["Base Color"].default_value = (*color, 1.0)
    node.distribution = "MULTI_GGX"  # the other one loses light
    names = {"roughness": ("Roughness",), "metallic": ("Metallic",), "specular": ("Specular IOR Level", "Specular"),
             "transmission": ("Transmission Weight", "Transmission"), "ior": ("IOR",), "alpha": ("Alpha",),
             "sheen": ("Sheen Weight", "Sheen"), "anisotropic": ("Anisotropic",), "coat": ("Coat Weight", "Clearcoat"),
             "subsurface": ("Subsurface Weight", "Subsurface"), "strength": ("Emission Strength",)}
    for key, value in inputs.items():
        socket(node, *names[key]).default_value = value
    return material


def matte(name, color=(0.5, 0.5, 0.5)):
    """Lambert's surface, which both renderers have alike."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.remove(tree.nodes["Principled BSDF"])
    node = tree.nodes.new("ShaderNodeBsdfDiffuse")
    node.inputs["Color"].default_value = (*color, 1.0)
    tree.links.new(node.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    material.pass_index = len(bpy.data.materials)
    return material


def finish(name, material):
    item = bpy.context.object
    item.name = name
    item.pass_index = 1 + sum(1 for other in bpy.data.objects if other.pass_index > 0)
    if material is not None:
        item.data.materials.append(material)
    return item


def floor(material=None, size=12.0):
    bpy.ops.mesh.primitive_plane_add(size=size)
    return finish("Floor", material or matte("Grey"))


def ball(name, place, material, radius=0.8, segments=48):
    bpy.ops.mesh.primitive_uv_sphere_add(radius=radius, location=place, segments=segments, ring_count=segments // 2)
    bpy.ops.object.shade_smooth()
    return finish(name, material)


def cube(name, place, material, size=1.2):
    bpy.ops.mesh.primitive_cube_add(size=size, location=place, rotation=(0.0, 0.0, 0.5))
    return finish(name, material)


def lamp(kind, name, place, energy, rotation=(0.0, 0.0, 0.0), color=(1.0, 1.0, 1.0), **properties):
    bpy.ops.object.light_add(type=kind, location=place, rotation=rotation)
    item = bpy.context.object
    item.name, item.data.energy, item.data.color = name, energy, color
    item.data.shadow_soft_size = 0.0
    if hasattr(item.data, "use_soft_falloff"):
        item.data.use_soft_falloff = False  # which would make a disk of a sphere, as in Blender before 4
    if kind == "SUN":
        item.data.angle = 0.0
    for key, value in properties.items():
        setattr(item.data, key, value)
    return item


def world(color=(0.0, 0.0, 0.0), strength=1.0):
    made = bpy.data.worlds.new("World")
    made.use_nodes = True
    node = made.node_tree.nodes["Background"]
    node.inputs["Color"].default_value = (*color, 1.0)
    node.inputs["Strength"].default_value = strength
    bpy.context.scene.world = made
    return made


def camera(place=(0.0, -9.0, 4.0), pitch=1.17):
    bpy.ops.object.camera_add(location=place, rotation=(pitch, 0.0, 0.0))
    item = bpy.context.object
    item.name = "View"
    bpy.context.scene.camera = item
    return item


def image(name, pixels):
    """An image of `pixels`, rows from the bottom up, as Blender has them; packed."""
    height, width = pixels.shape[:2]
    made = bpy.data.images.new(name, width, height, float_buffer=pixels.dtype == numpy.float32)
    flat = numpy.ones((height, width, 4), numpy.float32)
    flat[..., :3] = pixels
    made.pixels.foreach_set(flat.ravel())
    made.update()
    made.pack()
    return made


def clear():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon_utils.enable("etendue")  # factory settings have turned it off
    world()


# --- scenes

@scene_of
def points():
    """Point lamps, hard and soft."""
    floor()
    cube("Cube", (-1.2, 0.0, 0.6), matte("Red", (0.7, 0.2, 0.2)))
    ball("Ball", (1.2, 0.0, 0.8), matte("Blue", (0.2, 0.3, 0.7)))
    lamp("POINT", "Hard", (-2.0, -3.0, 4.0), 300.0, color=(1.0, 0.8, 0.6))
    lamp("POINT", "Soft", (2.5, -1.0, 3.0), 200.0, shadow_soft_size=0.4)


@scene_of
def suns():
    """Suns, sharp and half a radian wide."""
    floor()
    cube("Cube", (-1.2, 0.0, 0.6), matte("Red", (0.7, 0.2, 0.2)))
    ball("Ball", (1.2, 0.0, 0.8), matte("Blue", (0.2, 0.3, 0.7)))
    lamp("SUN", "Sharp", (0.0, 0.0, 5.0), 1.5, rotation=(0.5, 0.3, 0.0))
    lamp("SUN", "Wide", (0.0, 0.0, 5.0), 1.0, rotation=(0.6, -0.6, 0.0), angle=0.5)


@scene_of
def sun_in_mirrors():
    """A wide sun in a mirror, in rough metal and in glass."""
    floor()
    for index, rough in enumerate((0.0, 0.3)):
        ball(f"Roughness {rough:g}", (2.2 * (index - 1), 0.0, 0.8),
             principled(f"M{rough:g}", (0.9, 0.7, 0.4), metallic=1.0, roughness=rough))
    ball("Glass", (2.2, 0.0, 0.85), principled("Glass", (1.0, 1.0, 1.0), transmission=1.0, roughness=0.0, ior=1.45))
    lamp("SUN", "Sun", (0.0, 0.0, 5.0), 2.0, rotation=(0.7, 0.4, 0.0), angle=0.5)
    world((0.2, 0.2, 0.2))


@scene_of
def lamps_in_the_way():
    """An area lamp and a soft point lamp between a floor and other lamps, whose light passes them."""
    floor()
    cube("Cube", (1.2, 1.0, 0.6), matte("Red", (0.7, 0.2, 0.2)))
    ball("Mirror", (-1.2, 1.0, 0.8), principled("Mirror", (0.9, 0.9, 0.9), metallic=1.0, roughness=0.0))
    lamp("SUN", "Sun", (0.0, 0.0, 5.0), 1.0)
    lamp("POINT", "Point", (0.0, 0.0, 5.0), 100.0)
    lamp("AREA", "Panel", (-1.0, -1.0, 2.5), 10.0, size=1.5)
    lamp("POINT", "Soft", (1.5, -1.0, 2.0), 10.0, shadow_soft_size=0.1)
    world((0.1, 0.1, 0.1))


@scene_of
def spots():
    """A spot with a hard rim and one that fades from its middle on."""
    floor()
    cube("Cube", (-1.2, 0.0, 0.6), matte("Red", (0.7, 0.2, 0.2)))
    ball("Ball", (1.2, 0.0, 0.8), matte("Blue", (0.2, 0.3, 0.7)))
    lamp("SPOT", "Rim", (-1.5, 0.0, 5.0), 600.0, spot_size=0.9, spot_blend=0.0)
    lamp("SPOT", "Fading", (1.5, 0.0, 5.0), 900.0, spot_size=1.0, spot_blend=1.0, shadow_soft_size=0.1)


@scene_of
def areas():
    """Area lamps of all shapes."""
    floor()
    ball("Left", (-2.4, 0.0, 0.8), matte("Red", (0.7, 0.2, 0.2)))
    ball("Middle", (0.0, 0.0, 0.8), matte("Green", (0.2, 0.7, 0.2)))
    ball("Right", (2.4, 0.0, 0.8), matte("Blue", (0.2, 0.3, 0.7)))
    lamp("AREA", "Square", (-3.0, -2.0, 4.0), 60.0, rotation=(0.4, -0.5, 0.0), shape="SQUARE", size=1.0)
    lamp("AREA", "Rectangle", (-1.0, 2.0, 4.0), 60.0, rotation=(-0.4, 0.0, 0.3), shape="RECTANGLE", size=2.0, size_y=0.4)
    lamp("AREA", "Disk", (1.0, -2.0, 4.0), 60.0, rotation=(0.4, 0.0, 0.0), shape="DISK", size=1.2)
    item = lamp("AREA", "Ellipse", (3.0, 0.0, 4.0), 60.0, rotation=(0.0, 0.6, 0.4), shape="ELLIPSE", size=1.5, size_y=0.5)
    item.scale = (1.0, 1.5, 1.0)


@scene_of
def spread():
    """An area lamp that shines 60 degrees wide."""
    floor()
    cube("Cube", (0.0, 0.0, 0.6), matte("Red", (0.7, 0.2, 0.2)))
    lamp("AREA", "Narrow", (0.0, 0.0, 4.0), 100.0, shape="SQUARE", size=1.0, spread=math.radians(60.0))


@scene_of
def world_color():
    """An even sky."""
    floor()
    cube("Cube", (-1.2, 0.0, 0.6), matte("Red", (0.7, 0.2, 0.2)))
    ball("Ball", (1.2, 0.0, 0.8), matte("Blue", (0.2, 0.3, 0.7)))
    world((0.3, 0.5, 0.9), 1.5)


def sky_pixels():
    """A sky with a bright patch, and colours that tell directions apart."""
    v, u = numpy.meshgrid((numpy.arange(64) + 0.5) / 64, (numpy.arange(128) + 0.5) / 128, indexing="ij")
    pixels = numpy.stack([0.2 + 0.6 * u, 0.3 + 0.4 * v, 0.9 - 0.6 * u], axis=-1)
    pixels[40:52, 20:34] = (8.0, 7.0, 5.0)
    return pixels.astype(numpy.float32)


@scene_of
def world_image():
    """An image as the sky, turned by a Mapping node."""
    floor()
    cube("Cube", (-1.2, 0.0, 0.6), matte("Red", (0.7, 0.2, 0.2)))
    ball("Ball", (1.2, 0.0, 0.8), principled("Mirror", (0.9, 0.9, 0.9), metallic=1.0, roughness=0.0))
    tree = world((0.0, 0.0, 0.0), 0.8).node_tree
    texture, mapping = tree.nodes.new("ShaderNodeTexEnvironment"), tree.nodes.new("ShaderNodeMapping")
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    texture.image = image("sky", sky_pixels())
    mapping.inputs["Rotation"].default_value = (0.0, 0.0, 0.7)
    tree.links.new(coordinates.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
    tree.links.new(texture.outputs["Color"], tree.nodes["Background"].inputs["Color"])


@scene_of
def rough_plastic():
    """The Principled BSDF without metal, at three roughnesses."""
    floor()
    for index, rough in enumerate((0.1, 0.5, 1.0)):
        ball(f"Roughness {rough:g}", (2.2 * (index - 1), 0.0, 0.8), principled(f"P{rough:g}", (0.6, 0.3, 0.2), roughness=rough))
    world((0.4, 0.4, 0.4))
    lamp("AREA", "Key", (-2.0, -3.0, 4.0), 150.0, rotation=(0.7, -0.4, 0.0), size=1.0)


@scene_of
def metals():
    """Metals at three roughnesses."""
    floor()
    for index, rough in enumerate((0.0, 0.3, 0.8)):
        ball(f"Roughness {rough:g}", (2.2 * (index - 1), 0.0, 0.8),
             principled(f"M{rough:g}", (0.9, 0.7, 0.4), metallic=1.0, roughness=rough))
    world((0.4, 0.4, 0.4))
    lamp("AREA", "Key", (-2.0, -3.0, 4.0), 150.0, rotation=(0.7, -0.4, 0.0), size=1.0)


@scene_of
def glass():
    """Clear and tinted glass, and a rough one."""
    floor()
    ball("Clear", (-2.2, 0.0, 0.85), principled("Clear", (1.0, 1.0, 1.0), transmission=1.0, roughness=0.0, ior=1.45))
    ball("Tinted", (0.0, 0.0, 0.85), principled("Tinted", (0.8, 0.9, 0.8), transmission=1.0, roughness=0.0, ior=1.45))
    ball("Rough", (2.2, 0.0, 0.85), principled("Rough", (1.0, 1.0, 1.0), transmission=1.0, roughness=0.3, ior=1.45))
    world((0.5, 0.6, 0.8))


@scene_of
def layers():
    """Clear coat, sheen, anisotropy."""
    floor()
    ball("Coat", (-2.4, 0.0, 0.8), principled("Coat", (0.6, 0.1, 0.1), roughness=0.6, coat=1.0))
    ball("Sheen", (0.0, 0.0, 0.8), principled("Sheen", (0.2, 0.2, 0.5), roughness=0.8, sheen=0.5, specular=0.0))
    ball("Anisotropy", (2.4, 0.0, 0.8), principled("Brushed", (0.8, 0.8, 0.8), metallic=1.0, roughness=0.4, anisotropic=0.7))
    world((0.4, 0.4, 0.4))


@scene_of
def subsurface():
    """Wax."""
    floor()
    material = principled("Wax", (0.8, 0.5, 0.3), subsurface=1.0, roughness=0.5)
    node = material.node_tree.nodes["Principled BSDF"]
    if "Subsurface Color" in node.inputs:
        node.inputs["Subsurface Color"].default_value = (0.8, 0.5, 0.3, 1.0)
    node.inputs["Subsurface Radius"].default_value = (0.1, 0.05, 0.03)
    ball("Wax", (0.0, 0.0, 0.8), material)
    world((0.4, 0.4, 0.4))
    lamp("AREA", "Key", (-2.0, -3.0, 4.0), 150.0, rotation=(0.7, -0.4, 0.0), size=1.0)


@scene_of
def smooth_coarse():
    """Coarse meshes with smooth normals."""
    floor()
    for index, (name, make) in enumerate((
            ("Cylinder", lambda place: bpy.ops.mesh.primitive_cylinder_add(vertices=8, radius=0.7, depth=1.4, location=place)),
            ("Cube", lambda place: bpy.ops.mesh.primitive_cube_add(size=1.2, location=place)),
            ("Icosphere", lambda place: bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=1, radius=0.8, location=place)),
            ("Cone", lambda place: bpy.ops.mesh.primitive_cone_add(vertices=8, radius1=0.8, depth=1.5, location=place)))):
        make((1.9 * (index - 1.5), 0.0, 0.8))
        bpy.ops.object.shade_smooth()
        finish(name, matte(name, (0.6, 0.6, 0.6)))
    world((0.3, 0.3, 0.3))
    lamp("SUN", "Sun", (0.0, 0.0, 5.0), 2.0, rotation=(0.7, 0.4, 0.0), angle=0.1)


@scene_of
def textures():
    """A texture on metal, and one that shines. Its squares are large, since Cycles interpolates the numbers of the file
    between texels, and Etendue light."""
    floor()
    rows, columns = numpy.indices((512, 512)) // 128
    pixels = numpy.where(((rows + columns) % 2 == 0)[..., None], (0.9, 0.6, 0.1), (0.1, 0.2, 0.5))
    material = principled("Checker", metallic=1.0, roughness=0.4)
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = image("checker", pixels)
    tree.links.new(node.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])
    cube("Cube", (-1.5, 0.0, 0.6), material)
    emitting = principled("Screen", (0.0, 0.0, 0.0), roughness=1.0, specular=0.0, strength=2.0)
    tree = emitting.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = bpy.data.images["checker"]
    tree.links.new(node.outputs["Color"], socket(tree.nodes["Principled BSDF"], "Emission Color", "Emission"))
    cube("Screen", (1.5, 0.0, 0.6), emitting)
    world((0.6, 0.6, 0.6))


@scene_of
def depth_of_field():
    """A wide aperture, in focus on an empty."""
    floor()
    for index, (name, color) in enumerate((("Near", (0.8, 0.2, 0.2)), ("Middle", (0.2, 0.8, 0.2)), ("Far", (0.2, 0.2, 0.8)))):
        cube(name, (1.6 * (index - 1), 3.0 * (index - 1), 0.6), matte(name, color))
    bpy.ops.object.empty_add(location=(0.0, 0.0, 0.6))
    target = bpy.context.object
    world((0.5, 0.5, 0.5))
    item = camera()
    item.data.dof.use_dof, item.data.dof.focus_object, item.data.dof.aperture_fstop = True, target, 0.1


@scene_of
def lens_shift():
    """A lens that is shifted both ways, and a far plane before the far cube."""
    floor()
    cube("Near", (-1.0, -1.0, 0.6), matte("Red", (0.8, 0.2, 0.2)))
    cube("Middle", (1.0, 1.0, 0.6), matte("Green", (0.2, 0.8, 0.2)))
    item = camera()
    item.data.shift_x, item.data.shift_y, item.data.clip_end = 0.1, -0.08, 12.0
    world((0.5, 0.5, 0.5))


def around(name):
    """Cubes on all sides of a camera that sees all around, and its settings."""
    floor()
    for label, place, color in (("Ahead", (0.0, 3.0, 1.0), (0.8, 0.2, 0.2)), ("Right", (3.0, 0.0, 1.5), (0.2, 0.8, 0.2)),
                                ("Behind", (-1.0, -3.0, 2.0), (0.2, 0.2, 0.8)), ("Above", (0.5, 1.0, 4.0), (0.7, 0.7, 0.2))):
        cube(label, place, matte(label, color))
    item = camera((0.0, 0.0, 1.2), 0.5 * math.pi)
    item.data.type = "PANO"
    world((0.5, 0.5, 0.5))
    settings = item.data if hasattr(item.data, "panorama_type") else item.data.cycles
    settings.panorama_type = name
    return settings


@scene_of
def panorama():
    """All directions, by longitude and latitude."""
    around("EQUIRECTANGULAR")


@scene_of
def fisheye():
    """A fisheye of 200 degrees."""
    around("FISHEYE_EQUIDISTANT").fisheye_fov = math.radians(200.0)


@scene_of
def fisheye_lens():
    """An equisolid fisheye lens on its sensor."""
    settings = around("FISHEYE_EQUISOLID")
    settings.fisheye_fov, settings.fisheye_lens = math.radians(180.0), 10.5


@scene_of
def instances():
    """A collection that is placed three times, and meshes that objects share."""
    floor()
    collection = bpy.data.collections.new("Tower")
    below, above = cube("Below", (0.0, 0.0, 0.4), matte("Red", (0.7, 0.2, 0.2)), 0.8), ball(
        "Above", (0.0, 0.0, 1.2), matte("Blue", (0.2, 0.3, 0.7)), 0.4)
    for item in (below, above):
        for other in item.users_collection:
            other.objects.unlink(item)
        collection.objects.link(item)
    for index in range(3):
        placed = bpy.data.objects.new(f"Place {index}", None)
        placed.instance_type, placed.instance_collection = "COLLECTION", collection
        placed.location, placed.rotation_euler = (2.2 * (index - 1), 0.5 * index, 0.0), (0.0, 0.0, 0.4 * index)
        bpy.context.scene.collection.objects.link(placed)
    first = cube("Shared", (-1.0, -2.5, 0.3), matte("Green", (0.2, 0.7, 0.2)), 0.6)
    second = bpy.data.objects.new("Shared too", first.data)
    second.location, second.scale, second.pass_index = (1.0, -2.5, 0.3), (1.0, 1.0, 2.0), 90
    bpy.context.scene.collection.objects.link(second)
    world((0.5, 0.5, 0.5))
    lamp("SUN", "Sun", (0.0, 0.0, 5.0), 2.0, rotation=(0.7, 0.4, 0.0))


@scene_of
def modifiers():
    """Modifiers that render otherwise than viewports show, and one that only renders have."""
    floor()
    item = cube("Subdivided", (-2.2, 0.0, 0.7), matte("Red", (0.7, 0.2, 0.2)))
    modifier = item.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels, modifier.render_levels = 0, 3
    item = cube("Array", (0.0, 0.0, 0.4), matte("Green", (0.2, 0.7, 0.2)), 0.7)
    modifier = item.modifiers.new("Array", "ARRAY")
    modifier.count, modifier.relative_offset_displace = 3, (0.0, 0.0, 1.2)
    modifier.show_viewport = False
    item = cube("Bent", (2.2, 0.0, 0.7), matte("Blue", (0.2, 0.3, 0.7)))
    item.shape_key_add(name="Basis")
    key = item.shape_key_add(name="Wide")
    for point in key.data:
        point.co.x *= 1.8
    key.value = 0.6
    world((0.5, 0.5, 0.5))
    lamp("SUN", "Sun", (0.0, 0.0, 5.0), 2.0, rotation=(0.7, 0.4, 0.0))


@scene_of
def posed():
    """A column that an armature has bent."""
    floor()
    bpy.ops.object.armature_add(location=(0.0, 0.0, 0.0))
    rig = bpy.context.object
    bpy.ops.object.mode_set(mode="EDIT")
    bones = rig.data.edit_bones
    bones[0].tail = (0.0, 0.0, 1.0)
    above = bones.new("Above")
    above.head, above.tail, above.parent = (0.0, 0.0, 1.0), (0.0, 0.0, 2.0), bones[0]
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.mesh.primitive_cylinder_add(radius=0.4, depth=2.0, location=(0.0, 0.0, 1.0))
    item = finish("Column", matte("Red", (0.7, 0.2, 0.2)))
    for name, indices in ((rig.data.bones[0].name, [v.index for v in item.data.vertices if v.co.z < 0.0]),
                          ("Above", [v.index for v in item.data.vertices if v.co.z > 0.0])):
        item.vertex_groups.new(name=name).add(indices, 1.0, "REPLACE")
    item.parent = rig
    item.modifiers.new("Armature", "ARMATURE").object = rig
    rig.pose.bones["Above"].rotation_mode = "XYZ"
    rig.pose.bones["Above"].rotation_euler = (0.0, 0.0, 0.9)
    rig.pose.bones["Above"].location = (0.5, 0.0, 0.0)
    world((0.5, 0.5, 0.5))
    lamp("SUN", "Sun", (0.0, 0.0, 5.0), 2.0, rotation=(0.7, 0.4, 0.0))


@scene_of
def visibility():
    """Objects that the camera does not see, that are not rendered, and half alpha."""
    floor()
    item = cube("Unseen", (-2.0, 0.0, 0.6), matte("Red", (0.7, 0.2, 0.2)))
    item.visible_camera = False
    item = cube("Off", (0.0, 2.0, 0.6), matte("Green", (0.2, 0.7, 0.2)))
    item.hide_render = True
    cube("Half", (2.0, 0.0, 0.65), principled("Half", (0.2, 0.3, 0.7), roughness=1.0, specular=0.0, alpha=0.5))
    world((0.4, 0.4, 0.4))
    lamp("SUN", "Sun", (0.0, 0.0, 5.0), 2.0, rotation=(0.7, 0.4, 0.0))


@scene_of
def motion_blur():
    """A cube that moves and turns by its keys, and a child that goes with it."""
    floor()
    scene = bpy.context.scene
    item = cube("Moving", (0.0, 0.0, 0.6), matte("Red", (0.7, 0.2, 0.2)))
    for frame, x, turn in ((0, -2.0, 0.0), (2, 2.0, 1.2)):
        item.location.x, item.rotation_euler.z = x, turn
        item.keyframe_insert("location", frame=frame)
        item.keyframe_insert("rotation_euler", frame=frame)
    child = ball("Child", (0.0, 0.0, 1.2), matte("Blue", (0.2, 0.3, 0.7)), 0.4)
    child.parent = item
    child.matrix_parent_inverse.identity()
    scene.frame_set(1)
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 0.8
    world((0.5, 0.5, 0.5))
    lamp("SUN", "Sun", (0.0, 0.0, 5.0), 2.0, rotation=(0.7, 0.4, 0.0))


@scene_of
def everything():
    """Every kind of lamp, a sky, depth of field, and the common surfaces."""
    floor()
    ball("Plastic", (-2.4, 0.0, 0.8), principled("Plastic", (0.6, 0.3, 0.2), roughness=0.3))
    ball("Metal", (0.0, 0.0, 0.8), principled("Metal", (0.9, 0.7, 0.4), metallic=1.0, roughness=0.2))
    ball("Glass", (2.4, 0.0, 0.85), principled("Glass", (1.0, 1.0, 1.0), transmission=1.0, roughness=0.0, ior=1.45))
    cube("Matte", (0.0, 2.5, 0.6), matte("Matte", (0.3, 0.6, 0.3)))
    lamp("POINT", "Point", (-3.0, -3.0, 3.0), 120.0, shadow_soft_size=0.2)
    lamp("SUN", "Sun", (0.0, 0.0, 6.0), 0.8, rotation=(0.5, 0.3, 0.0), angle=0.05)
    lamp("SPOT", "Spot", (3.0, -3.0, 4.0), 150.0, rotation=(0.8, 0.5, 0.0), spot_size=1.0, spot_blend=0.2, shadow_soft_size=0.05)
    lamp("AREA", "Area", (0.0, 2.0, 5.0), 100.0, shape="RECTANGLE", size=2.0, size_y=1.0)
    world((0.2, 0.25, 0.35))
    item = camera()
    item.data.dof.use_dof, item.data.dof.focus_distance, item.data.dof.aperture_fstop = True, 9.5, 0.5


def build(name, size=(128, 96)):
    """Makes the scene the only one, with a camera and a size."""
    clear()
    SCENES[name]()
    scene = bpy.context.scene
    if scene.camera is None:
        camera()
    square = name == "fisheye"  # the circle is an ellipse in Cycles where the image is not square
    scene.render.resolution_x, scene.render.resolution_y = (size[1], size[1]) if square else size
    scene.render.resolution_percentage = 100
    scene.render.filter_size = 1.5
    bpy.context.view_layer.update()
    return scene


def set_cycles(scene, samples, seed=0):
    """Cycles as the program renders: all light, no tricks, the same filter."""
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device, cycles.samples, cycles.seed = "CPU", samples, seed
    cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_fast_gi = False
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = 16
    cycles.transmission_bounces = cycles.volume_bounces = 16
    cycles.transparent_max_bounces = 64
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.blur_glossy = cycles.light_sampling_threshold = 0.0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.pixel_filter_type, cycles.filter_width = "BLACKMAN_HARRIS", 1.5
    cycles.film_exposure = 1.0
    for item in bpy.data.objects:
        # Both move shadows at the terminator of smooth normals.
        if item.type == "MESH":
            item.cycles.shadow_terminator_offset = item.cycles.shadow_terminator_geometry_offset = 0.0


def set_etendue(scene, samples, seed=0):
    scene.render.engine = "ETENDUE"
    scene.etendue.samples, scene.etendue.seed, scene.etendue.max_depth = samples, seed, 18
