"""Tests of the parts of Blender's add-on that need no Blender: render.json, GLB files, passes, the program as a child.

Called with the program as its last argument, it also holds what is written against the program's schema."""

import json
import math
import os
import shutil
import stat
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import unittest.mock
import zipfile
from pathlib import Path

import fake_blender as fake
import skipped_tests
from etendue import child, folders, glb, identity, overlooked, passes, program, scene_settings, vertex_colors, viewport

try:
    import numpy
except ImportError:
    numpy = None
if numpy is not None:
    from etendue import exr, pixels

ROOT = Path(__file__).resolve().parents[2]
LAST = Path(sys.argv[-1] if len(sys.argv) > 1 else "-")
PROGRAM = Path(sys.argv.pop()) if LAST.is_file() and os.access(LAST, os.X_OK) else None


def written(scene=None, objects=(), materials=(), aovs=(), **more):
    return scene_settings.write(scene or fake.scene(), objects, materials, aovs, **more)


class Image(unittest.TestCase):
    def test_the_size_and_the_border_are_blenders(self):
        scene = fake.scene()
        self.assertEqual(written(scene).document["size"], [100, 50])
        self.assertNotIn("crop", written(scene).document)
        scene.render.use_border = True
        self.assertEqual(written(scene).document["crop"], [25, 25, 75, 50])  # y down
        # Blender 3.4 renders 41 x 29 of 64 x 48 pixels; its numbers are of single precision.
        scene.render.resolution_percentage, scene.render.resolution_x, scene.render.resolution_y = 100, 64, 48
        scene.render.border_max_x, scene.render.border_min_y, scene.render.border_max_y = 0.8999999761581421, 0.2, 0.8
        self.assertEqual(written(scene).document["crop"], [16, 10, 57, 39])
        scene.render.resolution_x, scene.render.border_max_x = 10, 0.699999988079071
        self.assertEqual(written(scene).document["crop"][2], 7)

    def test_pixels_that_are_not_square(self):
        scene = fake.scene()
        scene.render.pixel_aspect_x = 1.5
        self.assertEqual(written(scene).document["film"]["pixel_aspect"], 1.5)
        self.assertNotIn("pixel_aspect", written().document["film"])

    def test_integrators_get_what_they_look_at(self):
        self.assertEqual(written().document["integrator"], {"type": "path", "max_depth": 12, "light_samples": 1})
        vcm = written(fake.scene(integrator="vcm", connections=4, merge="all")).document["integrator"]
        self.assertEqual((vcm["merge"], vcm["connections"]), ("all", "cache:4"))
        self.assertNotIn("light_samples", vcm)
        auto = written(fake.scene(integrator="auto", connections=4, merge="all", heuristic="power")).document["integrator"]
        self.assertEqual((auto["merge"], auto["merge_radius"]), ("all", 1.5))
        self.assertEqual((auto["connections"], auto["heuristic"]), ("cache:4", "power"))

    def test_mist_is_blenders_where_its_pass_is_asked_for(self):
        scene = fake.scene()
        scene.world = fake.world()
        self.assertNotIn("mist", written(scene).document)
        self.assertEqual(written(scene, aovs=["mist"]).document["mist"], {"start": 2.0, "depth": 8.0, "falloff": "inverse-quadratic"})

    def test_view_layers_have_samples_and_worlds_of_their_own(self):
        scene, world = fake.scene(), fake.world(fake.Node("BACKGROUND", {"Color": (1, 0, 0, 1), "Strength": 1.0}))
        for flags, samples in (({"samples": 0}, 32), ({"samples": 7, "world_override": world}, 7)):
            document = written(scene, view_layer=fake.view_layer(**flags)).document
            self.assertEqual((document["spp"], "environment" in document), (samples, "world_override" in flags))

    def test_what_ends_the_render(self):
        self.assertFalse({"time", "error", "adaptive"} & set(written().document))
        document = written(fake.scene(time=9.0, error=0.05, robust=6)).document
        self.assertEqual((document["time"], document["error"], document["min_spp"], document["robust"]), (9.0, 0.05, 48, "mon:7"))

    def test_the_shutter(self):
        render = fake.scene().render
        self.assertEqual(scene_settings.shutter(render, "CENTER"), (-0.25, 0.25))
        self.assertEqual(scene_settings.shutter(render, "START"), (0.0, 0.5))
        document = written(moving=(0.0, 0.02)).document
        self.assertEqual((document["shutter"], document["fps"]), ([0.0, 0.02], 25.0))


class Lamps(unittest.TestCase):
    def lamp(self, kind, visible=False, version=(3, 4, 1), **properties):
        item = fake.item("Lamp", fake.light(kind, **properties), "LIGHT", visible_camera=visible)
        return scene_settings.lamp(item, version, scene_settings.Written())

    def test_points_have_blenders_watts(self):
        self.assertEqual(self.lamp("POINT"), {"color": [1.0, 0.5, 0.25], "power": 10.0})
        soft = self.lamp("SPOT", shadow_soft_size=0.2)
        self.assertEqual((soft["radius"], soft["visible_to_camera"], soft["stops_light"]), (0.2, False, False))

    def test_suns(self):
        self.assertEqual(self.lamp("SUN", angle=0.01), {"color": [1.0, 0.5, 0.25], "irradiance": 10.0, "angle": 0.01})

    def test_areas(self):
        square = self.lamp("AREA", size=2.0)
        self.assertEqual((square["type"], square["width"], square["height"]), ("rectangle", 2.0, 2.0))
        # Radiance: power / (pi area) is to be Cycles' 10 / (4 area), since Blender 4.0 10 / (pi area).
        self.assertAlmostEqual(square["power"] / math.pi, 10.0 / 4.0)
        self.assertEqual(self.lamp("AREA", version=(4, 0, 0))["power"], 10.0)
        self.assertNotIn("spread", square)
        self.assertEqual(self.lamp("AREA", shape="RECTANGLE", size_y=3.0)["height"], 3.0)
        disk, ellipse = (self.lamp("AREA", shape=shape, size=3.0, size_y=2.0) for shape in ("DISK", "ELLIPSE"))
        self.assertEqual((disk["type"], disk["width"], disk["height"]), ("disk", 3.0, 3.0))
        self.assertEqual((ellipse["type"], ellipse["width"], ellipse["height"]), ("disk", 3.0, 2.0))
        self.assertEqual([self.lamp("AREA", spread=spread)["spread"] for spread in (1.0, 0.001)], [1.0, math.radians(1.0)])
        self.assertIs(square["visible_to_camera"], False)
        self.assertNotIn("visible_to_camera", self.lamp("AREA", visible=True))

    def test_odd_values_are_clamped_and_told_of(self):
        lamps = [fake.item("Dark", fake.light("POINT", energy=-3.0), "LIGHT"),
                 fake.item("Flat", fake.light("AREA", size=0.0), "LIGHT"),
                 fake.item("Day", fake.light("SUN", energy=-1.0), "LIGHT"), fake.item("Fine", fake.light("POINT"), "LIGHT")]
        scene = fake.scene()
        scene.world = fake.world(fake.Node("BACKGROUND", {"Color": (1, 1, 1, 1), "Strength": -2.0}))
        result = written(scene, lamps)
        lights = result.document["lights"]
        self.assertEqual((lights["Dark"]["power"], lights["Day"]["irradiance"], result.document["environment"]["scale"]), (0, 0, 0))
        self.assertEqual((lights["Flat"]["width"], lights["Flat"]["height"]), (scene_settings.LEAST_SIZE,) * 2)
        self.assertEqual([note.partition(":")[0] for note in result.notes],
                         ["lamp 'Dark'", "lamp 'Day'", "the world", "lamp 'Flat'", "lamp 'Flat'"])

    def test_names_are_those_that_the_file_has(self):
        lamps, materials = [fake.item("L", fake.light("POINT"), "LIGHT")], [(fake.material("M", fake.principled(Sheen=1.0)), True)]
        document = written(objects=lamps, materials=materials, name_of=lambda item: f"{item.name} [a]").document
        self.assertEqual((document["camera"], list(document["cameras"]), list(document["lights"]), list(document["materials"])),
                         ("View [a]", ["View [a]"], ["L [a]"], ["M [a]"]))

    def test_nodes_multiply(self):
        node = fake.Node("EMISSION", {"Color": (0.5, 1.0, 1.0, 1.0), "Strength": 3.0})
        lamp = self.lamp("POINT", use_nodes=True, node_tree=fake.tree("OUTPUT_LIGHT", node))
        self.assertEqual((lamp["power"], lamp["color"][0]), (30.0, 0.5))

    def test_a_spot_has_the_light_that_cycles_gives_it(self):
        light = fake.light("SPOT", spot_size=1.2, spot_blend=0.6)
        inner, outer = (math.cos(angle) for angle in scene_settings.spot_cones(light))
        smooth = outer + 0.6 * (1.0 - outer)
        steps = 20000
        sums = [0.0, 0.0]
        for step in range(steps):
            z = outer + (step + 0.5) / steps * (1.0 - outer)
            t = min((z - outer) / (smooth - outer), 1.0)
            sums[0] += t * t * (3.0 - 2.0 * t)
            sums[1] += min((z - outer) / (inner - outer), 1.0) ** 2
        self.assertAlmostEqual(sums[0] / sums[1], 1.0, places=4)


class World(unittest.TestCase):
    def environment(self, world, transparent=False):
        result = scene_settings.Written()
        return scene_settings.environment(world, transparent, result), result

    def background(self, color=(0.5, 0.5, 1.0, 1.0), strength=2.0):
        return fake.Node("BACKGROUND", {"Color": color, "Strength": strength})

    def test_colours(self):
        self.assertIsNone(self.environment(None)[0])
        self.assertIs(written().document["studio"], False, "Blender has no light that it is not given")
        self.assertEqual(self.environment(fake.world(self.background()))[0], {"scale": 2.0, "color": [0.5, 0.5, 1.0]})
        self.assertIs(self.environment(fake.world(self.background()), True)[0]["visible_to_camera"], False)
        self.assertIs(self.environment(fake.world(self.background(), visible_camera=False))[0]["visible_to_camera"], False)

    def test_images_are_turned_as_cycles_turns_them(self):
        for vector_type, sign in (("POINT", 1.0), ("TEXTURE", -1.0)):
            mapping = fake.Node("MAPPING", {"Vector": None, "Rotation": (0.0, 0.0, 0.25)}, vector_type=vector_type)
            texture = fake.Node("TEX_ENVIRONMENT", {"Vector": mapping}, image="the image", projection="EQUIRECTANGULAR")
            found, result = self.environment(fake.world(self.background(texture)))
            self.assertAlmostEqual(found["rotation"], -0.5 * math.pi - sign * 0.25)
            self.assertEqual((result.world_image, result.notes), ("the image", []))

    def test_what_is_left_out_is_said(self):
        for world in (fake.world(fake.Node("BSDF_DIFFUSE")), fake.world(self.background(fake.Node("TEX_SKY")))):
            self.assertIn("is not brought over", self.environment(world)[1].notes[0])


class Cameras(unittest.TestCase):
    def test_shift_clip_and_blades(self):
        camera = fake.camera(shift_x=0.1)
        camera.dof.use_dof, camera.dof.aperture_blades, camera.dof.aperture_ratio = True, 6, 2.0
        found = scene_settings.camera_settings(camera, scene_settings.Written(), 4, 3)
        self.assertEqual(found, {"shift": [0.1, 0.0], "clip_start": 0.1, "clip_end": 100.0, "blades": 6, "blade_rotation": 0.0,
                                 "aperture_ratio": 2.0})

    def test_depth_of_field(self):
        self.assertEqual(scene_settings.lens(fake.camera(), fake.IDENTITY, 4, 3), {})
        camera = fake.camera()
        camera.dof.use_dof = True
        camera.dof.focus_object = fake.item("Target", None, "EMPTY", [[1, 0, 0, 5], [0, 1, 0, 1], [0, 0, 1, -7], [0, 0, 0, 1]])
        self.assertEqual(scene_settings.lens(camera, fake.IDENTITY, 4, 3),
                         {"focus_distance": 7.0, "f_stop": 2.8, "sensor_width": 36.0})
        # Half as large, 1 up, and its bone 4 behind that.
        rig = fake.item("Rig", None, "ARMATURE", [[0.5, 0, 0, 0], [0, 0.5, 0, 1], [0, 0, 0.5, 0], [0, 0, 0, 1]])
        eye = fake.SimpleNamespace(matrix=[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, -8], [0, 0, 0, 1]])
        rig.pose = fake.SimpleNamespace(bones={"Eye": eye})
        camera.dof.focus_object, camera.dof.focus_subtarget = rig, "Eye"
        self.assertEqual(scene_settings.lens(camera, fake.IDENTITY, 4, 3)["focus_distance"], 4.0)
        camera.type = "ORTHO"
        self.assertAlmostEqual(scene_settings.lens(camera, fake.IDENTITY, 4, 3)["lens_radius"], 0.5 / 2.8)

    def test_the_sensor_is_that_of_the_longer_side(self):
        for fit, width, height, expected in (("AUTO", 3, 4, 36.0), ("HORIZONTAL", 4, 3, 36.0), ("HORIZONTAL", 3, 4, 48.0),
                                             ("VERTICAL", 4, 3, 32.0), ("VERTICAL", 3, 4, 24.0)):
            self.assertAlmostEqual(scene_settings.sensor_of_longer_side(fake.camera(sensor_fit=fit), width, height), expected)

    def test_shifts_and_orthographic_scales_are_of_the_side_that_the_sensor_fits(self):
        for fit, shift, halves in (("AUTO", 0.1, (3.0, 1.5)), ("HORIZONTAL", 0.1, (3.0, 1.5)), ("VERTICAL", 0.05, (6.0, 3.0))):
            camera = fake.camera("ORTHO", sensor_fit=fit, shift_x=0.1, ortho_scale=6.0)
            self.assertEqual(scene_settings.camera_settings(camera, scene_settings.Written(), 2, 1)["shift"], [shift, 0.0])
            self.assertEqual(scene_settings.orthographic_halves(camera, 2, 1), halves)
        document = {"cameras": [{"orthographic": {"xmag": 1.0, "ymag": 1.0, "znear": 0.1}}], "nodes": [{"name": "V", "camera": 0}]}
        glb.set_orthographic(document, "V", (3.0, 1.5))
        self.assertEqual(document["cameras"][0]["orthographic"], {"xmag": 3.0, "ymag": 1.5, "znear": 0.1})

    def test_panoramas(self):
        settings = fake.SimpleNamespace(panorama_type="FISHEYE_EQUISOLID", fisheye_fov=2.0, fisheye_lens=9.0)
        fisheye = fake.camera("PANO", cycles=settings)
        found = scene_settings.camera_settings(fisheye, scene_settings.Written(), 4, 3)
        self.assertEqual((found["type"], found["mapping"], found["fov"], found["focal_length"]), ("fisheye", "equisolid", 2.0, 9.0))
        newer = fake.camera("PANO", panorama_type="MIRRORBALL")
        result = scene_settings.Written()
        self.assertEqual(scene_settings.camera_settings(newer, result, 4, 3)["type"], "equirectangular")
        self.assertIn("MIRRORBALL", result.notes[0])


class Materials(unittest.TestCase):
    def material(self, shader, closed=True):
        result = scene_settings.Written()
        return scene_settings.material(fake.material("M", shader), closed, result), result

    def test_a_plain_surface_needs_nothing(self):
        self.assertEqual(self.material(fake.principled(Base_Color=(1, 1, 1, 1), Roughness=0.5))[0], {})

    def test_glass_is_solid_where_its_meshes_are_closed(self):
        for name in ("Transmission", "Transmission_Weight"):
            glass = fake.principled(IOR=1.6, **{name: 1.0})
            self.assertEqual(self.material(glass)[0], {"solid": True, "ior": 1.6})
            self.assertEqual(self.material(glass, closed=False)[0], {"ior": 1.6})

    def test_glass_of_blender_4_has_its_colour_after_two_surfaces(self):
        for closed, weight, expected in ((True, 1.0, [0.5, 1.0, 0.0]), (False, 1.0, None), (True, 0.5, None)):
            glass = fake.principled(Transmission_Weight=weight, Base_Color=(0.25, 1.0, 0.0, 1.0))
            self.assertEqual(self.material(glass, closed)[0].get("base_color"), expected)
        self.assertNotIn("base_color", self.material(fake.principled(Transmission=1.0, Base_Color=(0.25, 1.0, 0.0, 1.0)))[0])

    def test_without_nodes_it_is_matte(self):
        plain = fake.SimpleNamespace(name="M", use_nodes=False, node_tree=None, diffuse_color=(0.2, 0.4, 1.5, 1.0))
        self.assertEqual(scene_settings.material(plain, True, scene_settings.Written()), {"diffuse": {"albedo": [0.2, 0.4, 1.0]}})

    def test_sheen_of_both_versions(self):
        new = fake.principled(Sheen_Weight=0.5, Sheen_Tint=(1.0, 0.5, 0.0, 1.0), Sheen_Roughness=0.3)
        self.assertEqual(self.material(new)[0], {"sheen_color": [0.5, 0.25, 0.0], "sheen_roughness": 0.3})
        old = fake.principled(Sheen=0.5, Sheen_Tint=0.0, Base_Color=(0.2, 0.2, 0.2, 1.0))
        self.assertEqual(self.material(old)[0], {"sheen_color": [0.1, 0.1, 0.1], "sheen_roughness": 0.3})

    def test_a_coat_before_blender_4_has_a_quarter_of_its_light(self):
        self.assertEqual(self.material(fake.principled(Clearcoat=0.8))[0], {"clearcoat": 0.2})
        self.assertEqual(self.material(fake.principled(Coat_Weight=0.8))[0], {})

    def test_thin_films(self):
        found = self.material(fake.principled(Thin_Film_Thickness=400.0, Thin_Film_IOR=1.5))[0]
        self.assertEqual(found, {"iridescence": 1.0, "iridescence_ior": 1.5, "iridescence_thickness_minimum": 400.0,
                                 "iridescence_thickness_maximum": 400.0})

    def test_anisotropy_has_the_widths_of_cycles(self):
        found = scene_settings.anisotropy(0.7, 0.4, 0.25)
        narrow = found["roughness"] ** 2
        wide = narrow + (1.0 - narrow) * found["anisotropy_strength"] ** 2
        aspect = math.sqrt(1.0 - 0.9 * 0.7)
        self.assertAlmostEqual(narrow, 0.16 * aspect)
        self.assertAlmostEqual(wide, 0.16 / aspect)
        self.assertAlmostEqual(found["anisotropy_rotation"], 0.5 * math.pi)

    def test_wax_of_both_versions(self):
        old = fake.principled(Subsurface=0.8, Subsurface_Color=(0.8, 0.5, 0.3, 1.0), Subsurface_Radius=(1.0, 0.2, 0.1),
                              Roughness=0.4, Subsurface_IOR=1.4)
        new = fake.principled(Subsurface_Weight=1.0, Base_Color=(0.8, 0.5, 0.3, 1.0), Subsurface_Radius=(1.0, 0.2, 0.1),
                              Subsurface_Scale=0.8, Roughness=0.4, IOR=1.4)
        for shader in (old, new):
            body = self.material(shader)[0]["subsurface"]
            self.assertEqual((body["albedo"], body["radius"][0], body["ior"]), ([0.8, 0.5, 0.3], 0.8, 1.4))
        found, result = self.material(new, closed=False)
        self.assertNotIn("subsurface", found)
        self.assertIn("closed meshes", result.notes[0])

    def test_simple_shaders(self):
        self.assertEqual(self.material(fake.Node("BSDF_DIFFUSE", {"Color": (0.2, 0.4, 0.6, 1.0), "Roughness": 0.0}))[0],
                         {"diffuse": {"albedo": [0.2, 0.4, 0.6]}})
        glossy = fake.Node("BSDF_GLOSSY", {"Color": (1, 1, 1, 1), "Roughness": 0.4}, distribution="SHARP")
        self.assertEqual(self.material(glossy)[0]["roughness"], 0.0)
        glass = fake.Node("BSDF_GLASS", {"Color": (1, 1, 1, 1), "Roughness": 0.0, "IOR": 1.4}, distribution="GGX")
        self.assertTrue(self.material(glass)[0]["solid"])

    def test_alpha_is_kept(self):
        self.assertEqual(self.material(fake.principled(Alpha=0.5))[1].blended, {"M"})
        self.assertEqual(self.material(fake.principled(Alpha=1.0))[1].blended, set())


class Glb(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = Path(folder.name) / "a.glb"

    def test_what_is_written_is_read(self):
        document = {"asset": {"version": "2.0"}, "buffers": [{"byteLength": 5}]}
        glb.write_glb(self.file, document, b"hello")
        self.assertEqual(glb.read_glb(self.file), (document, b"hello\0\0\0"))
        self.file.write_bytes(b"no glTF, but long enough")
        with self.assertRaisesRegex(ValueError, "no GLB"):
            glb.read_glb(self.file)

    def test_nodes_get_cameras_and_lamps_of_their_own(self):
        lamp = {glb.LAMPS: {"light": 0}}
        document = {"cameras": [{"name": "B"}], "extensions": {glb.LAMPS: {"lights": [{"name": "data", "type": "spot", "intensity": -5.0}]}},
                    "nodes": [{"name": "A", "camera": 0}, {"name": "B", "camera": 0}, {"name": "L", "extensions": lamp},
                              {"name": "K", "extensions": {glb.LAMPS: {"light": 0}}}]}
        glb.give_nodes_their_own(document)
        glb.set_spots(document, {"K": (0.1, 0.2)})
        self.assertEqual([camera["name"] for camera in document["cameras"]], ["A", "B"])
        lights = document["extensions"][glb.LAMPS]["lights"]
        self.assertEqual([(light["name"], light["intensity"]) for light in lights], [("L", 0.0), ("K", 0.0)])
        self.assertNotIn("spot", lights[0])
        self.assertEqual(lights[1]["spot"], {"innerConeAngle": 0.1, "outerConeAngle": 0.2})

    def test_bones_do_not_take_the_names_of_objects(self):
        document = {"nodes": [{"name": "View"}, {"name": "View"}, {}, {"name": "View."}, {"name": "Bone"}]}
        glb.rename(document, [0, 2, 4], {"View", "View."})
        self.assertEqual([node.get("name") for node in document["nodes"]], ["View..", "View", None, "View.", "Bone"])

    def test_what_is_not_rendered_is_left_out_and_its_children_stay(self):
        document = {"nodes": [{"name": "A", "mesh": 0, "children": [1]}, {"name": "B", "mesh": 1}]}
        self.assertEqual(glb.leave_out(document, {1}), ["A"])
        self.assertEqual(document["nodes"], [{"name": "A", "children": [1]}, {"name": "B", "mesh": 1}])

    def test_what_has_no_material_gets_that_of_blender(self):
        document = {"materials": [{"name": "M"}], "meshes": [{"primitives": [{"material": 0}, {}]}, {"primitives": [{}]}]}
        glb.give_all_materials(document)
        self.assertEqual([[primitive["material"] for primitive in mesh["primitives"]] for mesh in document["meshes"]], [[0, 1], [1]])
        self.assertEqual(document["materials"][1]["pbrMetallicRoughness"],
                         {"baseColorFactor": [0.8, 0.8, 0.8, 1.0], "metallicFactor": 0.0})
        self.assertEqual(document["extensionsUsed"], [glb.SPECULAR])
        whole = {"meshes": [{"primitives": [{"material": 0}]}]}
        glb.give_all_materials(whole)
        self.assertEqual(whole, {"meshes": [{"primitives": [{"material": 0}]}]})

    def test_what_the_camera_does_not_see_has_materials_of_its_own(self):
        document = {"materials": [{"name": "M"}], "meshes": [{"primitives": [{"material": 0}, {}]}],
                    "nodes": [{"name": "A", "mesh": 0}, {"name": "B", "mesh": 0}, {"name": "C", "mesh": 0}]}
        origins = glb.give_own_materials(document, {"B", "C"}, "hidden from the camera")
        self.assertEqual(origins, {"M hidden from the camera": "M", "default hidden from the camera": ""})
        self.assertEqual([node["mesh"] for node in document["nodes"]], [0, 1, 1])
        self.assertEqual(document["meshes"][0]["primitives"], [{"material": 0}, {}])

    def test_motion_is_an_animation_of_bytes_behind_the_others(self):
        document = {"buffers": [{"byteLength": 5}], "nodes": [{"name": "A"}, {"name": "B"}], "animations": [{}]}
        data = glb.add_motion(document, b"hello", [0.0, 0.5], {1: {"translation": [(0.0, 1.0, 2.0), (3.0, 4.0, 5.0)]}})
        animation, = document["animations"]
        self.assertEqual(animation["channels"], [{"sampler": 0, "target": {"node": 1, "path": "translation"}}])
        view = document["bufferViews"][document["accessors"][1]["bufferView"]]
        self.assertEqual(view["byteOffset"] % 4, 0)
        self.assertEqual(struct.unpack_from("<6f", data, view["byteOffset"]), (0.0, 1.0, 2.0, 3.0, 4.0, 5.0))
        self.assertEqual((data[:5], document["buffers"][0]["byteLength"]), (b"hello", len(data)))

    def test_what_has_a_matrix_is_moved_by_a_node_above_it(self):
        matrix = [1.0, 0.5, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]
        document = {"scenes": [{"nodes": [0]}], "nodes": [{"name": "A", "children": [1]}, {"name": "B", "matrix": matrix}]}
        motion = {"translation": [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0)]}
        glb.add_motion(document, b"", [0.0, 0.5], {0: motion, 1: motion})
        self.assertEqual(document["nodes"], [{"name": "A", "children": [2]}, {"name": "B", "matrix": matrix}, {"children": [1]}])
        targets = [channel["target"]["node"] for channel in document["animations"][0]["channels"]]
        self.assertEqual(targets, [0, 2])
        document = {"scenes": [{"nodes": [0]}], "nodes": [{"matrix": matrix}]}
        glb.add_motion(document, b"", [0.0, 0.5], {0: motion})
        self.assertEqual(document["scenes"], [{"nodes": [1]}])

    def test_cameras_that_the_exporter_does_not_know_are_there(self):
        document = {"nodes": [{"name": "View"}], "scenes": [{"nodes": [0]}]}
        glb.ensure_camera(document, "View", [1.0] * 16)
        self.assertEqual(document["nodes"], [{"name": "View", "camera": 0}])
        glb.ensure_camera(document, "Lost", [2.0] * 16)
        self.assertEqual(document["nodes"][1], {"name": "Lost", "matrix": [2.0] * 16, "camera": 1})
        self.assertEqual(document["scenes"], [{"nodes": [0, 1]}])

    def test_vertex_colours_stay_where_the_material_has_them(self):
        primitives = [{"material": 0, "attributes": {"COLOR_0": 0, "POSITION": 1}}, {"material": 1, "attributes": {"COLOR_0": 0}},
                      {"material": 2, "attributes": {"COLOR_0": 0}}, {"material": 3, "attributes": {"COLOR_0": 0}},
                      {"attributes": {"COLOR_0": 0}}]
        document = {"meshes": [{"primitives": primitives}], "bufferViews": [{"buffer": 0, "byteOffset": 8, "byteLength": 32}],
                    "accessors": [{"bufferView": 0, "componentType": 5123, "normalized": True, "type": "VEC4", "count": 4}]}
        used = [(False, False), (True, True), (True, False), (False, True)]
        self.assertEqual(glb.keep_vertex_colors(document, used), [3])
        self.assertEqual([primitive["attributes"] for primitive in primitives],
                         [{"POSITION": 1}, {"COLOR_0": 0}, {"COLOR_0": 1}, {}, {}])
        self.assertEqual(document["accessors"][1], {"bufferView": 1, "componentType": 5123, "normalized": True, "type": "VEC3",
                                                    "count": 4})
        self.assertEqual(document["bufferViews"][1], {"buffer": 0, "byteOffset": 8, "byteLength": 32, "byteStride": 8})


class VertexColors(unittest.TestCase):
    def attributes(self, **inputs):
        return vertex_colors.attributes_of(fake.material("M", fake.principled(**inputs)))

    def test_they_are_found_behind_other_nodes(self):
        paint = fake.Node("VERTEX_COLOR", layer_name="Paint")
        mask = fake.Node("ATTRIBUTE", attribute_name="Mask")
        mix = fake.Node("MIX_RGB", {"Color1": fake.Node("REROUTE", {"Input": paint}), "Color2": (1, 1, 1, 1)})
        self.assertEqual(self.attributes(Base_Color=mix, Alpha=fake.group(mask)), (["Paint"], ["Mask"]))
        self.assertEqual(self.attributes(Base_Color=(1, 1, 1, 1), Roughness=paint), ([], []))
        inside = fake.group(fake.principled(Base_Color=fake.Node("GROUP_INPUT", outputs=("Tint",))), Tint=paint)
        self.assertEqual(vertex_colors.attributes_of(fake.material("M", inside)), (["Paint"], []))
        mixed = fake.Node("MIX_SHADER", {"A": fake.Node("BSDF_DIFFUSE", {"Color": paint}), "B": fake.principled()})
        self.assertEqual(vertex_colors.attributes_of(fake.material("M", mixed)), (["Paint"], []))
        self.assertEqual(vertex_colors.attributes_of(fake.SimpleNamespace(use_nodes=False, node_tree=None)), ([], []))

    def test_the_exporter_is_given_those_that_a_material_names(self):
        class Attributes(list):
            render_color_index = 0

        mesh = fake.SimpleNamespace(color_attributes=Attributes(fake.Block(name) for name in ("One", "Two")), materials=[
            None, fake.material("M", fake.principled(Base_Color=fake.Node("VERTEX_COLOR", layer_name="Two")))])
        self.assertEqual(list(vertex_colors.choices([mesh])), [(mesh.color_attributes, "render_color_index", 1)])
        mesh.materials = [fake.material("M", fake.principled(Base_Color=fake.Node("VERTEX_COLOR", layer_name="")))]
        self.assertEqual(list(vertex_colors.choices([mesh])), [])


class Viewport(unittest.TestCase):
    def test_viewports_show_what_renders_show(self):
        new = fake.SimpleNamespace
        hidden, group = new(hide_viewport=True, modifiers=[]), new(hide_viewport=True)
        part = new(hide_viewport=False, children=[])
        modifiers = [new(show_viewport=False, show_render=True, levels=1, render_levels=3),
                     new(show_viewport=True, show_render=False), new(show_viewport=True, show_render=True, steps=4, render_steps=9),
                     new(show_viewport=True, show_render=True, resolution=7, viewport_resolution=2)]
        ring = new(resolution_u=2, resolution_v=2, render_resolution_u=20, render_resolution_v=0, splines=[new(resolution_u=5)])
        text = new(resolution_u=2, resolution_v=2, render_resolution_u=0, render_resolution_v=6, splines=[])
        hair = new(display_percentage=10, child_nbr=4, rendered_child_count=90)
        render = new(simplify_subdivision=0, simplify_subdivision_render=6, simplify_child_particles=0.1,
                     simplify_child_particles_render=1.0)
        data = new(objects=[hidden, new(hide_viewport=False, modifiers=modifiers)], collections=[group], curves=[ring, text],
                   particles=[hair])

        def seen():
            return (hidden.hide_viewport, group.hide_viewport, part.hide_viewport, [item.show_viewport for item in modifiers],
                    modifiers[0].levels, modifiers[2].steps, modifiers[3].viewport_resolution, ring.resolution_u,
                    ring.splines[0].resolution_u, text.resolution_v, hair.display_percentage, hair.child_nbr,
                    render.simplify_subdivision, render.simplify_child_particles)

        before = seen()
        layer = new(layer_collection=new(hide_viewport=False, children=[part]))
        with viewport.changed(viewport.differences(new(render=render), layer, data)):
            self.assertEqual(seen(), (False, False, False, [True, False, True, True], 3, 9, 7, 2, 20, 6, 100, 90, 6, 1.0))
        self.assertEqual(seen(), before)

    def test_what_has_no_keyframe_yet_is_kept(self):
        bone = fake.SimpleNamespace(location=[1.0, 2.0])
        rig = fake.Block("Rig", location=[3.0, 4.0], lost=1.0)
        rig.path_resolve = {'pose.bones["a.b"]': bone}.__getitem__
        rig.__class__ = type("Rig", (fake.Block,), {"__getitem__": lambda self, key: self.custom[key]})
        rig["my.control"] = 5.0
        paths = ('pose.bones["a.b"].location', "location", "missing", 'gone["x"].value', '["my.control"]', "location")
        rig.animation_data = fake.SimpleNamespace(action=fake.SimpleNamespace(
            fcurves=[fake.SimpleNamespace(data_path=path) for path in paths]))
        with viewport.kept(viewport.keyed([rig, fake.Block("Other")])):
            bone.location, rig.location, rig["my.control"], rig.lost = [0.0, 0.0], [0.0, 0.0], 0.0, 0.0
        self.assertEqual((bone.location, rig.location, rig["my.control"], rig.lost), ((1.0, 2.0), (3.0, 4.0), 5.0, 0.0))

    def test_settings_come_back_where_a_change_fails(self):
        one = fake.SimpleNamespace(a=1)
        with self.assertRaises(AttributeError):
            with viewport.changed([(one, "a", 2), (one, "missing", 3)]):
                pass
        self.assertEqual(one.a, 1)


class Identity(unittest.TestCase):
    def test_numbers_come_and_go(self):
        blocks = [fake.Block("A"), fake.Block("B")]
        with identity.numbered(blocks):
            self.assertEqual([block.custom for block in blocks], [{identity.KEY: 0}, {identity.KEY: 1}])
        self.assertEqual([block.custom for block in blocks], [{}, {}])
        entries = [{"extras": {identity.KEY: 1}}, {"extras": {identity.KEY: 0, "mine": 2}}, {}]
        self.assertEqual(identity.take_blocks(entries, blocks), [blocks[1], blocks[0], None])
        self.assertEqual(entries, [{}, {"extras": {"mine": 2}}, {}])
        twins = [*blocks, fake.Block("B", "a.blend")]
        self.assertEqual(identity.take_blocks([{"name": "A"}, {"name": "B"}, {"name": "C"}], twins, True), [blocks[0], None, None])
        self.assertEqual(identity.take_blocks([{"name": "A"}], twins), [None])

    def test_linked_data_gives_way_to_what_is_local(self):
        linked, local, other = fake.Block("Paint", "a.blend"), fake.Block("Paint"), fake.Block("Wood", "a.blend")
        self.assertEqual(identity.unique_names([linked, local, other, linked]),
                         {linked: "Paint [a.blend]", local: "Paint", other: "Wood"})
        again = fake.Block("Paint", "a.blend")
        self.assertEqual(sorted(identity.unique_names([linked, again, local]).values()),
                         ["Paint", "Paint [a.blend]", "Paint [a.blend] 2"])

    def test_sources_of_instances_are_not_rendered_where_they_stand(self):
        source, child = fake.Block("Source"), fake.Block("Child")
        child.parent = source
        one = fake.Block("One", is_instancer=True, instance_type="COLLECTION")
        hidden = fake.Block("Hidden", is_instancer=True, instance_type="COLLECTION")
        emitter = fake.Block("Emitter", is_instancer=True, instance_type="FACES")
        source_of_faces = fake.Block("Leaf", parent=emitter)
        # The source with its child; an instance of both, and one that is not rendered; instances on faces; a bone.
        nodes = [{"children": [1]}, {}, {"children": [3]}, {"children": [4]}, {}, {"children": [6]}, {}, {"children": [8]}, {},
                 {"children": [10]}, {}]
        tree = identity.tree_of(nodes, [source, child, one, source, child, hidden, source, emitter, source_of_faces, child, None])
        self.assertEqual(tree.instancers, [None, None, None, 2, 2, None, 5, None, 7, None, None])
        instanced = {(one, source), (one, child), (emitter, source_of_faces)}
        self.assertEqual(identity.rendered_nodes(tree, {emitter}, instanced), {3, 4, 7, 8})
        self.assertEqual(identity.rendered_nodes(tree, {emitter, source}, instanced), {0, 3, 4, 7, 8})
        self.assertEqual(identity.rendered_nodes(tree, {child}, set()), {1, 9, 10})

    def test_instances_in_instances_go_with_the_outermost(self):
        outer, inner = (fake.Block(name, is_instancer=True, instance_type="COLLECTION") for name in ("Outer", "Inner"))
        ball = fake.Block("Ball")
        tree = identity.tree_of([{"children": [1]}, {"children": [2]}, {}], [outer, inner, ball])
        self.assertEqual((tree.instancers, tree.top_instancer(2)), ([None, 0, 1], 0))
        self.assertEqual(identity.rendered_nodes(tree, set(), {(outer, ball)}), {2})


class Lost(unittest.TestCase):
    def found(self, *items, surfaces=(), instanced=(), scattered=(), background=None, brought=()):
        document = {"nodes": [{} for _ in items]}
        tree = identity.tree_of(document["nodes"], list(items))
        scene = fake.SimpleNamespace(objects=items, background_set=background)
        evaluated = {item: item for item in (*items, *dict(surfaces))}
        rendered = fake.SimpleNamespace(single=set(items), items=evaluated, instanced=dict(instanced), scattered=scattered)
        return overlooked.lost(scene, document, tree, rendered, dict(surfaces), brought)

    def surface(self, has_faces=True):
        return fake.SimpleNamespace(has_faces=has_faces)

    def test_what_has_nothing_in_the_file_is_told_of_once(self):
        ball, wire, drop = fake.Block("Ball"), fake.Block("Wire"), fake.Block("Drop", type="META")
        surfaces = {ball: self.surface(), wire: self.surface(False), drop: self.surface()}
        self.assertEqual(self.found(ball, wire, drop, surfaces=surfaces), ["Blender's exporter leaves objects out: 'Ball'"])
        self.assertEqual(self.found(background=fake.Block("Set")), ["background sets are not brought over: 'Set'"])

    def test_instances(self):
        new = fake.SimpleNamespace
        place, ball, curve = fake.Block("Place", type="EMPTY"), fake.Block("Ball"), fake.Block("Curve", type="CURVE")
        surfaces = {ball: self.surface(False), curve: self.surface(False)}
        there = {(place, ball): 2, (curve, curve): 1}
        self.assertEqual(self.found(place, surfaces=surfaces, instanced=there), [])
        surfaces[ball] = self.surface()
        self.assertEqual(self.found(place, surfaces=surfaces, instanced=there),
                         ["instances by 'Place' are not brought over: 'Ball'"])
        self.assertEqual(self.found(place, surfaces=surfaces, instanced=there, brought={(place, ball)}), [])
        self.assertEqual(self.found(ball, scattered=[new(instancer=ball, source=None), new(instancer=ball, source=None),
                                                     new(instancer=curve, source=ball)]),
                         ["instances of meshes that geometry nodes make are not brought over: 'Ball'"])


class Passes(unittest.TestCase):
    def test_layers_are_asked_for_once(self):
        layer = fake.view_layer(use_pass_z=True, use_pass_diffuse_direct=True, use_pass_diffuse_indirect=True,
                                use_pass_cryptomatte_object=True, use_pass_glossy_color=True)
        wanted = passes.wanted(layer)
        self.assertEqual([item.name for item in wanted], ["Depth", "DiffDir", "DiffInd", "GlossCol", "CryptoObject00",
                                                          "CryptoObject01", "CryptoObject02"])
        self.assertEqual(passes.sources(wanted, True), ["depth", "diffuse_direct", "diffuse_indirect", "cryptomatte_object:6",
                                                        "albedo_diffuse", "denoising"])
        layer.pass_cryptomatte_depth = 5  # the program rounds up, and so is to be asked for as many as Blender has
        self.assertEqual(passes.wanted(layer)[-1].source, "cryptomatte_object:6")
        self.assertEqual(wanted[4].names(), ["CryptoObject00.R", "CryptoObject00.G", "CryptoObject00.B", "CryptoObject00.A"])

    def test_layers_of_the_users(self):
        key, glass = passes.extra_layers("key=light:Key; glass=lpe:C T .* L;")
        self.assertEqual((key.name, key.source, glass.names()[0]), ("key", "key=light:Key", "glass.R"))
        with self.assertRaisesRegex(ValueError, "'depth' is no layer"):
            list(passes.extra_layers("depth"))

    def test_layers_of_the_users_take_no_pass_of_blenders(self):
        for text in ("Depth=light:Key", "Combined=lpe:C D L", "AO=light:Key", "CryptoObject01=light:Key", "a=light:A; a=light:B"):
            with self.assertRaisesRegex(ValueError, "the name of another pass"):
                list(passes.extra_layers(text))

    def test_keys_of_mattes_are_those_of_the_specification(self):
        # As docs/cryptomatte.md shows it, and the vectors of MurmurHash3.
        self.assertEqual(passes.matte_key("CryptoObject"), "3ae39a5")
        for data, seed, expected in ((b"", 1, 0x514E28B7), (b"test", 0, 0xBA6BD213), (b"Hello, world!", 0, 0xC0363E43)):
            self.assertEqual(passes.murmur3(data, seed), expected)


@unittest.skipIf(numpy is None, "there is no numpy (Debian: python3-numpy)")
class Pixels(unittest.TestCase):
    def test_an_exr_that_is_written_is_read(self):
        with tempfile.TemporaryDirectory() as folder:
            image = numpy.arange(24, dtype=numpy.float32).reshape(2, 4, 3)
            exr.write_exr(Path(folder) / "a.exr", image)
            found = exr.read_exr(Path(folder) / "a.exr")
        self.assertEqual((found.width, found.height), (4, 2))
        for index, letter in enumerate("RGB"):
            self.assertTrue((found.channels[letter] == image[..., index]).all())

    def exr(self, **channels):
        rows = {name.replace("__", "."): numpy.array([[value], [value + 1.0]], numpy.float32) for name, value in channels.items()}
        return exr.Exr(0, 0, 1, 2, rows, {})

    def test_rows_go_up_and_the_film_is_opaque(self):
        image = self.exr(R=1.0, G=2.0, B=3.0, A=-1.0)
        self.assertEqual(pixels.combined(image, True)[0, 0].tolist(), [2.0, 3.0, 4.0, 0.0])
        self.assertEqual(pixels.combined(image, False)[1, 0].tolist(), [1.0, 2.0, 3.0, 1.0])

    def test_conventions(self):
        _, normal = next(row for row in passes.STANDARD if row[1].name == "Normal")
        self.assertEqual(pixels.pixels_of(self.exr(N__X=1.0, N__Y=2.0, N__Z=3.0), normal, {})[1, 0].tolist(), [1.0, -3.0, 2.0])
        _, uv = next(row for row in passes.STANDARD if row[1].name == "UV")
        self.assertIn("depth", passes.sources([uv], False))
        found = pixels.pixels_of(self.exr(uv__U=0.25, uv__V=0.75, depth__Z=3.0, A=1.0), uv, {})
        self.assertEqual(found[1, 0].tolist(), [0.25, 0.25, 1.0])
        nothing = pixels.pixels_of(self.exr(uv__U=0.0, uv__V=0.0, depth__Z=1e10, A=1.0), uv, {})
        self.assertEqual(nothing[1, 0].tolist(), [0.0, 0.0, 0.0])
        _, diffuse = next(row for row in passes.STANDARD if row[1].name == "DiffDir")
        light = {f"diffuse_direct__{letter}": 3.0 for letter in "RGB"} | {f"albedo_diffuse__{letter}": 1.0 for letter in "RGB"}
        self.assertEqual(pixels.pixels_of(self.exr(**light), diffuse, {})[0, 0].tolist(), [2.0, 2.0, 2.0])
        self.assertIsNone(pixels.pixels_of(self.exr(), diffuse, {}))
        # What light paths bring to a pixel without diffuse surfaces adds up all the same.
        color = next(item for _, item in passes.STANDARD if item.name == "DiffCol")
        light |= {"albedo_diffuse__G": -1.0}  # 0 below
        times = pixels.pixels_of(self.exr(**light), diffuse, {}) * pixels.pixels_of(self.exr(**light), color, {})
        self.assertEqual(times[0, 0].tolist(), [4.0, 4.0, 4.0])
        black = {name: -1.0 if name.startswith("diffuse") else value for name, value in light.items()}
        self.assertEqual(pixels.pixels_of(self.exr(**black), color, {})[0, 0].tolist(), [2.0, 0.0, 2.0])

    def test_numbers_become_pass_indices_by_the_names_of_objects(self):
        _, item = next(row for row in passes.STANDARD if row[1].name == "IndexOB")
        image = self.exr(object_id__X=1.0)
        image.attributes["etendue:names/object_id"] = json.dumps(["Ball", "Place/in/Wheel", "a/b"]).encode()
        given = {"object_id": {"Ball": 7, "Wheel": 3, "a/b": 5, "C#2": 9, "C": 1}}
        self.assertEqual(pixels.pixels_of(image, item, given).ravel().tolist(), [3.0, 7.0])
        self.assertEqual(pixels.indices(["Ball", "Place/in/Wheel", "a/b", "other"], given["object_id"]).tolist(), [0, 7, 3, 5, 0])
        # Scattered instances of a name have numbers.
        names = ["Ground/Wheel", "Ground/Wheel#57", "Ball#3", "C#2", "D/C#11"]
        self.assertEqual(pixels.indices(names, given["object_id"]).tolist(), [0, 3, 3, 7, 9, 1])


class Program(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name).resolve()

    def script(self, text, name="etendue"):
        file = self.folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(f"#!/bin/sh\n{text}\n")
        file.chmod(file.stat().st_mode | stat.S_IXUSR)
        return file

    def test_where_it_is_found(self):
        there = self.script("exit 0", "prefix/bin/etendue")
        package = self.folder / "prefix/share/etendue/blender/etendue"
        nowhere = self.folder / "a/b/c/d/e"
        self.assertEqual(program.find_program(environment={"PATH": ""}, package=package), there)
        self.assertEqual(program.find_program(str(there.parent), {}, nowhere), there)
        self.assertEqual(program.find_program("", {"ETENDUE": str(there)}, nowhere), there)
        self.assertEqual(program.find_program("", {"PATH": str(there.parent)}, nowhere), there)
        # Who names one wants no other.
        self.assertIsNone(program.find_program(str(self.folder / "missing"), {"ETENDUE": str(there)}, package))

    def test_unknown_keys_go_and_a_lamp_of_an_unknown_kind_as_a_whole(self):
        document = {"lights": {"A": {"type": "disk", "color": [1, 1, 1], "radius": 1}, "B": {"radius": 1}}, "spp": 3,
                    "aovs": ["depth", "vector", "N", "later"]}
        left, dropped = program.without(document, ["/lights/A/type", "/lights/A/radius", "/lights/B/radius", "/aovs/1", "/aovs/3"])
        self.assertEqual(left, {"spp": 3, "aovs": ["depth", "N"]})
        self.assertEqual(dropped, ["aovs: later", "aovs: vector", "lights.A", "lights.B.radius"])

    def test_places_get_the_names_of_objects(self):
        gltf = {"nodes": [{"name": "Cube", "mesh": 0}], "meshes": [{"name": "data"}], "materials": [{"name": "Red"}, {}]}
        for message, expected in (("./scene.glb#/nodes/0/mesh: it is odd", "object 'Cube': it is odd"),
                                  ("a/scene.glb#/meshes/0/primitives/1: no", "object 'Cube': no"),
                                  ("scene.glb#/materials/0: no", "material 'Red': no"),
                                  ("scene.glb#/materials/1: no", "scene.glb#/materials/1: no"),
                                  ("/tmp/x/scene.glb#/nodes/7: no", "scene.glb#/nodes/7: no"),
                                  ("/tmp/x/render.json#/spp: no", "render.json#/spp: no"),
                                  ("/tmp/x/image.exr: bright", "image.exr: bright"),
                                  ("odd (/tmp/x/render.json#/spp)", "odd (render.json#/spp)"),
                                  ("odd (scene.glb#/nodes/0/mesh)", "odd (object 'Cube')")):
            self.assertEqual(program.with_names(message, gltf), expected)

    def test_a_program_that_does_not_answer_is_an_error(self):
        with unittest.mock.patch("subprocess.run", side_effect=program.subprocess.TimeoutExpired("etendue", 60)):
            with self.assertRaisesRegex(program.ProgramError, "not come to its end"):
                program.unknown_pointers(self.folder / "etendue", {})

    def test_messages(self):
        said = "note: one\nerror: a.json#/spp: two\nand more\nwarning: three\n/tmp/a.exr: 4 spp\n"
        self.assertEqual(program.messages_of(said), [("note", "one"), ("error", "a.json#/spp: two\nand more"), ("warning", "three")])

    def test_progress_previews_and_the_end(self):
        preview = self.folder / "image.preview.png"
        done = self.script(f"""
            trap 'touch {preview}' USR1
            for last; do :; done
            eval "echo '{{\\"phase\\":\\"render\\",\\"fraction\\":0.5}}' >&$last"
            i=0
            while [ ! -e {preview} ] && [ $i -lt 100 ]; do sleep 0.05; i=$((i + 1)); done
            echo 'warning: odd' >&2; sleep 0.2""")
        seen, shown = [], []
        ended = child.run([str(done)], lambda: False, lambda progress: seen.append(progress.fraction), preview,
                          lambda path: shown.append(path.name), 0.0)
        self.assertEqual((ended.code, ended.cancelled, ended.messages), (0, False, [("warning", "odd")]))
        self.assertIn(0.5, seen)
        self.assertEqual(shown[0], "image.preview.png")

    def test_a_preview_that_is_gone_is_not_shown(self):
        preview = self.folder / "image.preview.png"
        preview.touch()
        shown = []
        child.run([str(self.script(f"sleep 0.2; rm {preview}; sleep 0.2"))], lambda: False, preview=preview,
                  on_preview=lambda path: shown.append(path.exists()))
        self.assertEqual(shown, [True])

    def test_stopping_ends_it_even_if_it_does_not_listen(self):
        for text, longest in (("exec sleep 60", 1.0), ("trap '' TERM\nwhile :; do sleep 0.05; done", child.PATIENCE + 1.0)):
            began = time.monotonic()
            ended = child.run([str(self.script(text))], lambda: time.monotonic() - began > 0.2)
            self.assertTrue(ended.cancelled)
            self.assertLess(time.monotonic() - began, longest)

    @unittest.skipIf(shutil.which("setpriv") is None, "there is no setpriv")
    def test_it_ends_with_a_process_that_is_killed(self):
        def words(process):
            """The command line of a process; none where it has ended."""
            try:
                return Path(f"/proc/{process}/cmdline").read_bytes()
            except OSError:
                return b""

        def waits_for(condition):
            return any(condition() or time.sleep(0.02) for _ in range(200))

        code = (f"import sys; sys.path.insert(0, {str(ROOT / 'addons/blender')!r}); from etendue import child; "
                "c = child.Child(['/bin/sleep', '60'], False); print(c.process.pid, flush=True); input()")
        with subprocess.Popen([sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
            started = int(process.stdout.readline())
            self.assertTrue(waits_for(lambda: words(started).startswith(b"/bin/sleep")))  # which setpriv becomes
            process.kill()
        self.assertTrue(waits_for(lambda: not words(started)))

    def test_folders_of_processes_that_are_no_more_go(self):
        above, other = self.folder / "blender_me", self.folder / "blender_other"
        for folder in (above, other):
            folder.mkdir()
        kept, mine, before = (folders.make(str(place), keep) for place, keep in ((above, str(above)), (above, ""), (other, "")))
        for alive in (True, False):
            with unittest.mock.patch("os.kill", side_effect=None if alive else ProcessLookupError):
                folders.sweep(str(above))
            self.assertEqual([path.exists() for path in (kept, mine, before)], [True, alive, alive])

    def test_errors(self):
        ended = child.run([str(self.script("echo 'error: it is broken' >&2; exit 3"))], lambda: False)
        self.assertEqual((ended.code, ended.error()), (3, "it is broken"))
        self.assertEqual(child.Ended(-9, False, []).error(), "the program ended with -9")
        with self.assertRaisesRegex(program.ProgramError, "cannot be started"):
            child.run([str(self.folder / "missing")], lambda: False)


@unittest.skipIf(PROGRAM is None, "no program was given")
class WithTheProgram(unittest.TestCase):
    """Holds what is written against the program."""

    def test_it_knows_every_key(self):
        scene = fake.scene(integrator="vcm", time=9.0, error=0.05, robust=7, clamp_indirect=3.0)
        scene.render.use_border, scene.render.pixel_aspect_x = True, 1.5
        scene.world = fake.world(fake.Node("BACKGROUND", {"Color": (1, 1, 1, 1), "Strength": 1.0}), visible_camera=False)
        scene.camera.data.dof.use_dof, scene.camera.data.shift_x, scene.camera.data.dof.aperture_blades = True, 0.1, 5
        lamps = [fake.item(shape or kind, fake.light(kind, shape=shape, shadow_soft_size=0.1, spread=1.0, angle=0.1), "LIGHT")
                 for kind, shape in (("POINT", ""), ("SPOT", ""), ("SUN", ""), ("AREA", "SQUARE"), ("AREA", "DISK"),
                                     ("AREA", "ELLIPSE"))]
        shaders = (fake.principled(Transmission=1.0, IOR=1.5), fake.principled(Sheen=1.0, Anisotropic=0.5, Clearcoat=1.0, Thin_Film_Thickness=400.0),
                   fake.principled(Subsurface=1.0, Subsurface_Color=(1, 1, 1, 1), Subsurface_Radius=(1, 1, 1)),
                   fake.Node("BSDF_DIFFUSE", {"Color": (1, 1, 1, 1), "Roughness": 0.5}))
        materials = [(fake.material(f"M{index}", shader), True) for index, shader in enumerate(shaders)]
        layer = fake.view_layer(**{name: True for name, _ in passes.STANDARD}, **{name: True for name, _, _ in passes.MATTES},
                                use_pass_volume=True, use_pass_caustics=True)
        document = written(scene, lamps, materials, passes.sources(passes.wanted(layer), True), moving=(0.0, 0.02)).document
        dropped = program.known_part(PROGRAM, document)[1]
        self.assertEqual(dropped, [])

    def test_it_does_not_know_others(self):
        document = {"spp": 1, "nonsense": 2, "aovs": ["depth", "nonsense"]}
        left, dropped = program.known_part(PROGRAM, document)
        self.assertEqual((left, dropped), ({"spp": 1, "aovs": ["depth"]}, ["aovs: nonsense", "nonsense"]))


class Package(unittest.TestCase):
    def test_the_manifest_and_the_older_form_agree(self):
        manifest = (ROOT / "addons/blender/etendue/blender_manifest.toml").read_text()
        source = (ROOT / "addons/blender/etendue/__init__.py").read_text()
        version = ".".join(map(str, eval(source.split('"version": ')[1].split("),")[0] + ")")))
        self.assertIn(f'version = "{version}"', manifest)
        cmake = (ROOT / "CMakeLists.txt").read_text()
        self.assertRegex(cmake, rf"VERSION {version}\b")

    def test_the_zip_is_the_same_each_time_and_holds_all_of_the_add_on(self):
        sys.path.insert(0, str(ROOT / "tools"))
        from lib.addon_zip import write_zip
        with tempfile.TemporaryDirectory() as folder:
            files = [Path(folder) / name for name in ("a.zip", "b.zip")]
            for file in files:
                write_zip(ROOT / "addons/blender/etendue", file)
            self.assertEqual(files[0].read_bytes(), files[1].read_bytes())
            with zipfile.ZipFile(files[0]) as archive:
                names = set(archive.namelist())
        self.assertLessEqual({"etendue/__init__.py", "etendue/blender_manifest.toml", "etendue/engine.py"}, names)
        self.assertFalse([name for name in names if "__pycache__" in name])


if __name__ == "__main__":
    skipped_tests.main("blender_addon_test")
