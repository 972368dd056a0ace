"""Tests of what Blender's add-on reads of trees of nodes, and of what it says is lost; needs no Blender.

Called with the program as its last argument, it also holds the entries of materials against the program's schema."""

import copy
import math
import os
import struct
import sys
import unittest
import zlib
from pathlib import Path

import fake_blender as fake
import skipped_tests
from etendue import glb_materials, layers, materials, nodes, overlooked, program, scene_settings, textures, volumes
from etendue import vertex_colors
from etendue.written import Texture, Written

try:
    import numpy
except ImportError:
    numpy = None
if numpy is not None:
    from etendue import images

LAST = Path(sys.argv[-1] if len(sys.argv) > 1 else "-")
PROGRAM = Path(sys.argv.pop()) if LAST.is_file() and os.access(LAST, os.X_OK) else None
GREY, RED = (0.5, 0.5, 0.5, 1.0), (0.8, 0.2, 0.1, 1.0)


def value(number):
    return fake.Node("VALUE", value=number)


def rgb(color):
    return fake.Node("RGB", value=color)


def diffuse(color=GREY, **inputs):
    return fake.Node("BSDF_DIFFUSE", {"Color": color, "Roughness": 0.0, **inputs})


def transparent(color=(1.0, 1.0, 1.0, 1.0)):
    return fake.Node("BSDF_TRANSPARENT", {"Color": color})


def emission(color=GREY, strength=1.0):
    return fake.Node("EMISSION", {"Color": color, "Strength": strength})


class Constants(unittest.TestCase):
    def seen(self, socket):
        return nodes.Seen(fake.Node("BSDF", {"Color": socket}))

    def test_constants_come_through_reroutes_groups_and_muted_nodes(self):
        reroute = fake.Node("REROUTE", {"Input": rgb(RED)})
        self.assertEqual(self.seen(reroute).value("Color"), [0.8, 0.2, 0.1])
        inside = fake.group(fake.Node("REROUTE", {"Input": fake.Node("GROUP_INPUT", outputs=("Tint",))}), "Color", Tint=rgb(RED))
        self.assertEqual(self.seen(inside).value("Color"), [0.8, 0.2, 0.1])
        muted = fake.Node("INVERT", {"Color": rgb(RED)}, mute=True)
        muted.internal_links = [fake.SimpleNamespace(from_socket=muted.inputs["Color"], to_socket=muted.outputs["Out"])]
        self.assertEqual(self.seen(muted).value("Color"), [0.8, 0.2, 0.1])
        muted.mute = False
        self.assertIsNone(self.seen(muted).value("Color"))
        circle = fake.Node("REROUTE", {"Input": rgb(RED)})
        circle.inputs[0].links[0] = fake.SimpleNamespace(from_node=circle, from_socket=circle.outputs[0], is_valid=False)
        self.assertEqual(self.seen(circle).value("Color"), None)

    def test_numbers_and_colours_are_made_of_each_other(self):
        self.assertEqual(self.seen(value(0.25)).value("Color"), [0.25] * 3)
        number = nodes.Seen(fake.Node("BSDF", {"Fac": rgb((1.0, 0.0, 0.0, 1.0))}))
        self.assertAlmostEqual(number.value("Fac"), 0.2126)
        product = fake.Node("MATH", {"Value": value(3.0), "Value__2": 2.0}, operation="MULTIPLY")
        self.assertEqual(nodes.Seen(fake.Node("BSDF", {"Fac": product})).value("Fac"), 6.0)

    def test_black_bodies_have_the_colours_of_planck(self):
        # From the CIE's chromaticities (0.4369, 0.4041) and (0.3135, 0.3237); the fits are within 2%.
        for kelvin, expected in ((3000.0, (1.770, 0.845, 0.272)), (6500.0, (1.043, 0.984, 1.035))):
            for found, wanted in zip(self.seen(fake.Node("BLACKBODY", {"Temperature": kelvin})).value("Color"), expected):
                self.assertLess(abs(found - wanted), 0.02)

    def test_outputs_are_those_of_cycles(self):
        def output(target, active):
            return fake.Node("OUTPUT_MATERIAL", target=target, is_active_output=active)

        for outputs in ((output("EEVEE", True), output("ALL", False)), (output("ALL", True), output("CYCLES", False)),
                        (output("ALL", False), output("ALL", True))):
            tree = fake.SimpleNamespace(nodes=outputs)
            self.assertIs(nodes.active_output(tree, "OUTPUT_MATERIAL"), outputs[1])


class Lamps(unittest.TestCase):
    def lamp(self, *shaders, kind="POINT", **properties):
        tree = fake.tree("OUTPUT_LIGHT", shaders[0] if shaders else None)
        tree.nodes[:0] = shaders[1:]
        result = Written()
        item = fake.item("Lamp", fake.light(kind, use_nodes=True, node_tree=tree, **properties), "LIGHT")
        return scene_settings.lamp(item, (3, 4, 1), result), result.notes

    def test_the_emission_is_that_of_the_output_each_input_on_its_own(self):
        lamp, notes = self.lamp(emission((0.5, 1.0, 1.0, 1.0), fake.Node("TEX_IES")), emission(strength=7.0))
        self.assertEqual((lamp["power"], lamp["color"][0]), (10.0, 0.5))
        self.assertIn("strength", notes[0])
        lamp, notes = self.lamp(emission(fake.Node("TEX_IMAGE"), value(3.0)))
        self.assertEqual((lamp["power"], lamp["color"][0]), (30.0, 1.0))
        self.assertIn("color", notes[0])

    def test_falloff_and_black_bodies(self):
        falloff = fake.Node("LIGHT_FALLOFF", {"Strength": 4.0, "Smooth": 0.0}, ("Quadratic", "Linear"))
        lamp, notes = self.lamp(emission(fake.Node("BLACKBODY", {"Temperature": 3000.0}), (falloff, "Quadratic")))
        self.assertEqual((lamp["power"], notes), (40.0, []))
        self.assertGreater(lamp["color"][0], 1.6)
        self.assertIn("square of the distance", self.lamp(emission(strength=(falloff, "Linear")))[1][0])

    def test_what_is_not_read_is_said(self):
        self.assertEqual(self.lamp()[0]["power"], 0.0)
        lamp, notes = self.lamp(fake.Node("MIX_SHADER"))
        self.assertEqual((lamp["power"], len(notes)), (10.0, 1))
        lamp, notes = self.lamp(emission(), energy=-5.0)
        self.assertEqual((lamp["power"], len(notes)), (0.0, 1))

    def test_portals_do_not_shine(self):
        items = [fake.item(name, fake.light("AREA", cycles=fake.SimpleNamespace(is_portal=portal)), "LIGHT")
                 for name, portal in (("Portal", True), ("Lamp", False))]
        self.assertEqual(set(scene_settings.write(fake.scene(), items, (), ()).document["lights"]), {"Lamp"})


class Worlds(unittest.TestCase):
    def environment(self, surface):
        result = Written()
        return scene_settings.environment(fake.world(surface), False, result), result

    def background(self, color, strength=2.0):
        return fake.Node("BACKGROUND", {"Color": color, "Strength": strength})

    def sky(self, **mapping):
        vector = fake.Node("MAPPING", {"Rotation": (0.0, 0.0, 0.0), **mapping}, vector_type="POINT") if mapping else None
        return fake.Node("TEX_ENVIRONMENT", {"Vector": vector}, image="the image", projection="EQUIRECTANGULAR")

    def test_images_and_colours_are_found_behind_other_nodes(self):
        found, result = self.environment(self.background(fake.Node("HUE_SAT", {"Hue": 0.5, "Color": self.sky()})))
        self.assertEqual((found["image"], result.world_image, len(result.notes)), ("world.exr", "the image", 1))
        found, result = self.environment(self.background(fake.Node("HUE_SAT", {"Hue": 0.5, "Color": rgb(RED)})))
        self.assertEqual((found["color"], len(result.notes)), ([0.8, 0.2, 0.1], 1))
        found, result = self.environment(self.background(rgb(RED), value(0.5)))
        self.assertEqual((found, result.notes), ({"scale": 0.5, "color": [0.8, 0.2, 0.1]}, []))

    def test_the_branch_that_lights_is_taken(self):
        rays = fake.Node("LIGHT_PATH", outputs=("Is Camera Ray",))
        lit, seen = self.background(self.sky()), self.background(GREY)
        found, result = self.environment(fake.mix((rays, "Is Camera Ray"), lit, seen))
        self.assertEqual((found["image"], len(result.notes)), ("world.exr", 1))
        found, result = self.environment(fake.mix(fake.Node("TEX_NOISE"), seen, lit))
        self.assertEqual((found["image"], len(result.notes)), ("world.exr", 1))
        found, result = self.environment(fake.mix(1.0, lit, seen))
        self.assertEqual((found["color"], result.notes), ([0.5] * 3, []))

    def test_mappings_that_mirror_are_said(self):
        for mapping, said in (({"Scale": (1.0, 1.0, 1.0)}, 0), ({"Scale": (-1.0, 1.0, 1.0)}, 1), ({"Scale": (-1.0, -1.0, -1.0)}, 1),
                              ({"Location": (0.1, 0.0, 0.0)}, 1)):
            self.assertEqual(len(self.environment(self.background(self.sky(**mapping)))[1].notes), said)

    def test_what_does_not_see_the_world_is_said(self):
        for flags, said in (({}, 0), ({"camera": False}, 0), ({"glossy": False}, 1), ({"scatter": False}, 1)):
            result = Written()
            world = fake.world(self.background(GREY), cycles_visibility=fake.SimpleNamespace(**flags))
            scene_settings.environment(world, False, result)
            self.assertEqual(len(result.notes), said)
        result = Written()
        world = fake.world(self.background(GREY), cycles=fake.SimpleNamespace(max_bounces=0))
        scene_settings.environment(world, False, result)
        self.assertEqual(len(result.notes), 1)

    def test_view_layers_without_their_environment_are_dark(self):
        scene = fake.scene()
        scene.world = fake.world(self.background(GREY))
        for lit in (True, False):
            document = scene_settings.write(scene, (), (), (), view_layer=fake.view_layer(use_sky=lit)).document
            self.assertEqual(("environment" in document, document.get("studio")), (lit, None if lit else False))


class Materials(unittest.TestCase):
    def material(self, shader, closed=True, whole=False, blend="HASHED", with_groups=False, **ends):
        result, item = Written(), fake.material("M", shader, **ends)
        item.blend_method = blend
        return scene_settings.material(item, closed, result, whole, with_groups=with_groups), result

    def test_nothing_becomes_white_metal(self):
        black, matte = {"diffuse": {"albedo": [0.0] * 3}}, {"diffuse": {"albedo": [0.5] * 3}}
        self.assertEqual(self.material(None)[0], black)
        self.assertEqual(len(self.material(None)[1].notes), 1)
        empty = fake.SimpleNamespace(name="M", use_nodes=True, node_tree=fake.SimpleNamespace(nodes=[]))
        self.assertEqual(scene_settings.material(empty, True, Written()), black)
        toon, result = self.material(fake.Node("BSDF_TOON", {"Color": GREY}))
        self.assertEqual((toon, len(result.notes)), (matte, 1))
        self.assertEqual(self.material(fake.Node("SCRIPT"))[0], {"diffuse": {"albedo": [0.8] * 3}})
        self.assertEqual(self.material(emission(strength=0.0))[0], black | {"emission": {"color": [0.5] * 3, "strength": 0.0}})

    def test_changes_of_the_file_go_by_the_names_that_it_has(self):
        result = Written()
        scene_settings.material(fake.material("M", fake.principled(Alpha=0.5)), True, result, name="M [a.blend]")
        self.assertEqual(result.blended, {"M [a.blend]"})

    def test_groups_have_all_factors(self):
        shader = fake.group(fake.principled(Base_Color=fake.Node("GROUP_INPUT", outputs=("Tint",)), Roughness=1.0, Metallic=0.0,
                                            Specular=0.25, Emission=(0, 0, 0, 1), Alpha=0.5), Tint=RED)
        found, result = self.material(shader)
        self.assertEqual((found["base_color"], found["metallic"], found["roughness"], found["specular"]),
                         ([0.8, 0.2, 0.1], 0.0, 1.0, 0.5))
        self.assertEqual((result.alphas, result.blended, result.notes), ({"M": 0.5}, {"M"}, []))
        override = self.material(fake.principled(Base_Color=RED, Metallic=1.0, Roughness=0.2, Emission=RED), whole=True)[0]
        self.assertEqual((override["base_color"], override["metallic"]), ([0.8, 0.2, 0.1], 1.0))

    def test_images_of_shaders_that_the_exporter_does_not_know_come_along(self):
        found, result = self.material(diffuse(fake.texture(fake.image("bark"))))
        self.assertEqual((found, result.textures["M"].image.name, result.notes),
                         ({"base_color": [1.0] * 3, "metallic": 0.0, "roughness": 1.0, "specular": 0.0}, "bark", []))
        toon, result = self.material(fake.Node("BSDF_TOON", {"Color": fake.texture(fake.image("bark"))}))
        self.assertEqual((toon, set(result.textures)), (found, {"M"}))
        painted, result = self.material(diffuse(fake.Node("VERTEX_COLOR", outputs=("Color",))))
        self.assertEqual((painted, result.notes), (found, []))
        found, result = self.material(diffuse(fake.Node("TEX_NOISE", {"Scale": 5.0}, ("Color",))))
        self.assertEqual((found, len(result.notes)), ({"diffuse": {"albedo": [0.8] * 3}}, 2))

    def test_shaders_of_one_lobe(self):
        self.assertEqual(self.material(diffuse(rgb(RED)))[0], {"diffuse": {"albedo": [0.8, 0.2, 0.1]}})
        glossy = self.material(fake.Node("BSDF_GLOSSY", {"Color": RED, "Roughness": value(0.4)}))[0]
        self.assertEqual(glossy, {"base_color": [0.8, 0.2, 0.1], "metallic": 1.0, "roughness": 0.4})
        leaf = self.material(fake.Node("BSDF_TRANSLUCENT", {"Color": RED}))[0]
        self.assertEqual((leaf["diffuse_transmission"], leaf["diffuse_transmission_color"]), (1.0, [0.8, 0.2, 0.1]))
        bent = self.material(fake.Node("BSDF_REFRACTION", {"Color": GREY, "Roughness": 0.0, "IOR": 1.3}))[0]
        self.assertEqual((bent["transmission"], bent["ior"]), (1.0, 1.3))
        wax = self.material(fake.Node("SUBSURFACE_SCATTERING", {"Color": RED, "Scale": 0.1, "Radius": (1.0, 0.5, 0.2)}))[0]
        self.assertEqual(wax["subsurface"]["radius"], [0.1, 0.05, 0.020000000000000004])
        self.assertEqual(self.material(transparent())[1].alphas, {"M": 0.0})
        self.assertEqual(len(self.material(transparent(RED))[1].notes), 1)

    def test_glossy_lobes_are_stretched_as_those_of_cycles(self):
        def widths(found):
            narrow, strength = found["roughness"] ** 2, found["anisotropy_strength"]
            return narrow + (1.0 - narrow) * strength ** 2, narrow

        for stretch, turn in ((0.5, 0.25), (-0.5, 0.0)):
            inputs = {"Color": RED, "Roughness": 0.5, "Anisotropy": stretch, "Rotation": 0.125}
            for kind in ("BSDF_ANISOTROPIC", "BSDF_GLOSSY"):
                found = self.material(fake.Node(kind, inputs))[0]
                for one, other in zip(widths(found), (0.5, 0.125)):
                    self.assertAlmostEqual(one, other)
                self.assertAlmostEqual(found["anisotropy_rotation"], 2.0 * math.pi * (turn + 0.125))

    def test_mixes_with_transparency_are_coverage(self):
        self.assertEqual(self.material(fake.mix(0.25, transparent(), diffuse()))[1].alphas, {"M": 0.25})
        self.assertEqual(self.material(fake.mix(0.25, diffuse(), transparent()))[1].alphas, {"M": 0.75})
        leaves = fake.image("leaves")
        cut = fake.mix((fake.texture(leaves), "Alpha"), transparent(), diffuse(fake.texture(leaves)))
        result = self.material(cut)[1]
        self.assertEqual((result.textures["M"].image, result.textures["M"].with_alpha, result.notes), (leaves, True, []))
        other = fake.mix(fake.Node("TEX_NOISE"), transparent(), diffuse())
        self.assertIn("nothing is transparent", self.material(other)[1].notes[0])

    def test_glass_that_is_partly_transparent_is_a_sheet(self):
        glass = fake.Node("BSDF_GLASS", {"Color": RED, "Roughness": 0.0, "IOR": 1.45})
        wax = {"Subsurface": 1.0, "Subsurface_Color": RED, "Subsurface_Radius": (1.0, 1.0, 1.0)}
        for shader, key, there, said in (
                (fake.mix(0.25, glass, transparent()), "solid", False, 1),
                (fake.mix(1.0, transparent(), glass), "solid", True, 0),
                (fake.principled(Transmission=1.0, Alpha=0.5), "solid", False, 1),
                (fake.principled(Transmission=1.0, Alpha=1.0), "solid", True, 0),
                (fake.principled(Transmission=1.0, Alpha=0.9), "solid", True, 1),
                (fake.principled(Alpha=0.5, **wax), "subsurface", True, 1)):
            found, result = self.material(shader)
            self.assertEqual((key in found, len(result.notes)), (there, said))

    def test_of_other_mixes_the_heavier_part_is_taken(self):
        found, result = self.material(fake.mix(0.75, diffuse(RED), diffuse()))
        self.assertEqual((found, len(result.notes)), ({"diffuse": {"albedo": [0.5] * 3}}, 1))
        for share in (0.0, 1.0):
            found, result = self.material(fake.mix(share, diffuse((share,) * 4), diffuse((1.0 - share,) * 4)))
            self.assertEqual((found, result.notes), ({"diffuse": {"albedo": [0.0] * 3}}, []))
        glow = self.material(fake.Node("ADD_SHADER", {"Shader": diffuse(), "Shader__2": emission(RED, 4.0)}))[0]
        self.assertEqual(glow["emission"], {"color": [0.8, 0.2, 0.1], "strength": 4.0})
        self.assertEqual(glow["diffuse"], {"albedo": [0.5] * 3})

    def test_the_branch_that_a_mix_has_chosen_is_read_whole(self):
        """The exporter takes the first Principled BSDF and any Emission, whatever is mixed."""
        first = fake.principled(Base_Color=fake.texture(fake.image()), Roughness=0.1)
        second = fake.principled(Base_Color=RED, Roughness=0.7, Metallic=1.0, Specular=0.5)
        first.name, second.name = "First", "Second"
        found, result = self.material(fake.mix(1.0, first, second))
        self.assertEqual(found, {"base_color": [0.8, 0.2, 0.1], "roughness": 0.7, "metallic": 1.0, "transmission": 0.0,
                                 "specular": 1.0})
        self.assertEqual((result.bare, result.dark, result.notes), ({"M"}, {"M"}, []))
        found, result = self.material(fake.mix(0.0, first, second))
        self.assertEqual((found, result.bare, result.dark, result.notes), ({}, set(), set(), []))
        for chosen, name in ((diffuse(RED), "diffuse"), (transparent(), "diffuse"), (emission(RED), "emission")):
            found, result = self.material(fake.mix(1.0, first, chosen))
            self.assertIn(name, found)
            self.assertEqual(result.bare, {"M"})

    def test_vertex_colours_of_a_branch_that_is_not_shown_do_not_count(self):
        paint = fake.Node("VERTEX_COLOR", outputs=("Color",), layer_name="Paint")
        for share, expected in ((0.0, ["Paint"]), (1.0, [])):
            shown = self.material(fake.mix(share, diffuse(paint), fake.principled(Base_Color=RED)))[1].shown["M"]
            self.assertEqual(vertex_colors.attributes_at(shown), (expected, []))

    def test_the_light_of_a_branch_that_is_not_shown_goes(self):
        shader = fake.principled(Base_Color=RED, Emission=RED, Emission_Strength=2.0)
        found, result = self.material(fake.mix(0.0, shader, emission(GREY, 5.0)))
        self.assertEqual(found, {"emission": {"color": [0.8, 0.2, 0.1], "strength": 2.0}})
        self.assertEqual((result.bare, result.dark), (set(), {"M"}))
        lit = emission(fake.texture(fake.image()), 4.0)
        found, result = self.material(fake.mix(0.25, fake.principled(Base_Color=RED), lit))
        self.assertEqual((found, result.bare, result.dark), ({"emissive": [1.0] * 3, "emissive_strength": 1.0}, set(), set()))
        both = fake.Node("ADD_SHADER", {"Shader": shader, "Shader__2": lit})
        found, result = self.material(both)
        self.assertEqual((found, result.dark), ({}, set()))
        self.assertIn("beside the light of 'EMISSION'", result.notes[0])

    def test_images_that_are_lost_with_the_shader_of_the_exporter_are_said(self):
        picture = fake.image(space="Non-Color")
        image = fake.texture(picture)
        shader = fake.principled(Roughness=image, Alpha=(image, "Alpha"), Emission=image, Clearcoat=image,
                                 Normal=fake.Node("NORMAL_MAP", {"Color": image}))
        shader.name = "Second"
        found, result = self.material(fake.mix(1.0, fake.principled(), shader))
        self.assertEqual((found["roughness"], found["clearcoat"]), (0.5, 0.0))
        for lost in ("'Roughness'", "'Alpha'", "'Normal'", "'Clearcoat'", "the light"):
            self.assertTrue([text for text in result.notes if lost in text], lost)

    def test_newer_exporters_see_what_groups_have(self):
        picture = fake.image(space="Non-Color")
        metal = fake.Node("GROUP_INPUT", outputs=("Metal",))
        shader = fake.group(fake.principled(Base_Color=GREY, Roughness=fake.texture(picture), Metallic=metal), Metal=0.25)
        found, result = self.material(shader, with_groups=True)
        self.assertEqual((found, result.bare, result.notes), ({"metallic": 0.25}, set(), []))
        found, result = self.material(shader)
        self.assertEqual((found["roughness"], len(result.notes)), (0.5, 1))

    def test_alpha_in_groups_is_that_of_the_image_or_said(self):
        leaves = fake.image("leaves")
        for other, alpha, said in ((leaves, True, 0), (fake.image("mask"), False, 1)):
            mask = (fake.texture(other, name="mask"), "Alpha")
            shader = fake.group(fake.principled(Base_Color=fake.texture(leaves), Alpha=mask))
            result = self.material(shader)[1]
            self.assertEqual((result.textures["M"].with_alpha, len(result.notes)), (alpha, said))

    def test_images_of_other_spaces_are_said(self):
        def notes(shader):
            return self.material(shader)[1].notes

        for space, said in (("sRGB", 0), ("Non-Color", 1), ("ACEScg", 1)):
            self.assertEqual(len(notes(fake.principled(Base_Color=fake.texture(fake.image(space=space))))), said)
        for space, said in (("sRGB", 1), ("Non-Color", 0), ("Linear", 0)):
            self.assertEqual(len(notes(fake.principled(Roughness=fake.texture(fake.image(space=space))))), said)
        # The add-on itself writes these as sRGB.
        for space, said in (("sRGB", 0), ("Non-Color", 0), ("ACEScg", 1)):
            self.assertEqual(len(notes(diffuse(fake.texture(fake.image(space=space))))), said)

    def test_bodies_scatter_forward_as_far_as_the_program_goes(self):
        wax = fake.Node("SUBSURFACE_SCATTERING", {"Color": RED, "Scale": 0.1, "Radius": (1.0, 0.5, 0.2), "Anisotropy": 1.0})
        self.assertEqual(self.material(wax)[0]["subsurface"]["anisotropy"], 0.999)

    def test_images_lie_as_their_nodes_say(self):
        uv_map = fake.Node("UVMAP", outputs=("UV",), uv_map="Second")
        mapping = fake.mapping(uv_map, place=(0.1, 0.2, 0.0), turn=(0.0, 0.0, 0.5), scale=(2.0, 3.0, 1.0))
        shader = diffuse(fake.texture(fake.image(), mapping, extension="EXTEND", interpolation="Closest"))
        found, result = self.material(shader)[1].textures["M"], self.material(shader)[1]
        self.assertEqual(found.sampler, {"wrapS": 33071, "wrapT": 33071, "magFilter": 9728, "minFilter": 9984})
        self.assertEqual(found.uv_map, "Second")
        self.assertEqual(result.notes, [])

    def test_mappings_are_those_of_blender(self):
        def moved(place, turn, scale, u, v):
            """Where a Mapping of points leads."""
            u, v = u * scale[0], v * scale[1]
            return (place[0] + math.cos(turn) * u - math.sin(turn) * v, place[1] + math.sin(turn) * u + math.cos(turn) * v)

        for kind, place, turn, scale in (("POINT", (0.1, 0.2), 0.5, (2.0, 3.0)), ("VECTOR", (0.1, 0.2), 0.5, (2.0, 3.0)),
                                         ("TEXTURE", (0.1, 0.2), 0.5, (2.0, 2.0)), ("TEXTURE", (0.1, 0.2), 0.0, (2.0, 3.0))):
            found = textures.transform(nodes.Seen(fake.mapping(None, kind, (*place, 0.0), (0.0, 0.0, turn), (*scale, 1.0))))
            for u, v in ((0.0, 0.0), (1.0, 0.0), (0.3, 0.8)):
                (x, y), angle = found["offset"], found["rotation"]
                # glTF turns clockwise, since its v runs down.
                a, b = u * found["scale"][0], (1.0 - v) * found["scale"][1]
                here = (x + math.cos(angle) * a + math.sin(angle) * b, 1.0 - (y - math.sin(angle) * a + math.cos(angle) * b))
                if kind == "TEXTURE":
                    here, (u, v) = (u, v), moved(place, turn, scale, *here)
                else:
                    u, v = moved(place if kind == "POINT" else (0.0, 0.0), turn, scale, u, v)
                for one, other in zip(here, (u, v)):
                    self.assertAlmostEqual(one, other)
        for mapping in (fake.mapping(turn=(0.1, 0.0, 0.0)), fake.mapping(None, "NORMAL"),
                        fake.mapping(place=fake.Node("TEX_NOISE")),
                        fake.mapping(None, "TEXTURE", turn=(0.0, 0.0, 0.5), scale=(1.0, 2.0, 1.0))):
            self.assertIsNone(textures.transform(nodes.Seen(mapping)))
            self.assertEqual(len(self.material(diffuse(fake.texture(fake.image(), mapping)))[1].notes), 1)

    def test_height_images_are_no_maps_of_normals(self):
        bumpy = fake.principled(Normal=fake.Node("BUMP", {"Height": fake.texture(fake.image())}))
        result = self.material(bumpy)[1]
        self.assertEqual((result.unbumped, len(result.notes)), ({"M"}, 1))
        mapped = fake.principled(Normal=fake.Node("NORMAL_MAP", {"Color": fake.texture(fake.image(space="Non-Color"))}))
        result = self.material(mapped)[1]
        self.assertEqual((result.unbumped, result.notes), (set(), []))
        for space, strength, unbumped, said in (("TANGENT", 1.0, set(), 0), ("OBJECT", 1.0, {"M"}, 1),
                                                ("TANGENT", fake.Node("TEX_NOISE"), set(), 2)):
            image = fake.texture(fake.image(space="Non-Color"), fake.Node("UVMAP", outputs=("UV",), uv_map="Second"))
            node = fake.Node("NORMAL_MAP", {"Color": image, "Strength": strength}, space=space, uv_map="Third")
            result = self.material(fake.principled(Normal=node))[1]
            self.assertEqual((result.unbumped, len(result.notes)), (unbumped, said))
            self.assertEqual(result.tangents, {} if unbumped else {"M": ("Second", "Third")})

    def test_value_nodes_are_no_textures(self):
        reroute = fake.Node("REROUTE", {"Input": value(0.1)})
        found = self.material(fake.principled(Transmission=value(1.0), Roughness=reroute, Sheen=value(1.0), Base_Color=rgb(RED)))[0]
        self.assertEqual((found["transmission"], found["roughness"], found["base_color"]), (1.0, 0.1, [0.8, 0.2, 0.1]))
        self.assertGreater(max(found["sheen_color"]), 0.1)

    def test_without_specular_nothing_reflects_at_grazing_angles_either(self):
        for specular, expected in ((0.0, {"specular": 0.0}), (value(0.25), {"specular": 0.5}), (0.25, {})):
            self.assertEqual(self.material(fake.principled(Specular=specular))[0], expected)
        self.assertNotIn("specular", self.material(fake.principled(Specular=0.0, Transmission=1.0))[0])

    def test_strengths_of_light_that_are_linked_are_constants_or_said(self):
        image = fake.texture(fake.image())
        twice = fake.Node("MATH", {"Value": 3.0, "Value__2": 2.0}, operation="MULTIPLY")
        for light, strength, expected, said in (
                (RED, value(3.0), {"emission": {"color": [0.8, 0.2, 0.1], "strength": 3.0}}, 0),
                (RED, image, {"emission": {"color": [0.8, 0.2, 0.1], "strength": 1.0}}, 1),
                (image, value(3.0), {}, 0),
                (image, twice, {"emissive_strength": 6.0}, 0),
                ((0.0, 0.0, 0.0, 1.0), value(3.0), {}, 0)):
            found, result = self.material(fake.principled(Emission=light, Emission_Strength=strength))
            self.assertEqual((found, len([text for text in result.notes if "linked to" in text])), (expected, said))

    def test_what_is_linked_to_inputs_that_are_constants_is_said(self):
        noise = fake.Node("TEX_NOISE")
        for name in ("Specular", "IOR", "Sheen", "Sheen_Tint", "Thin_Film_Thickness", "Anisotropic_Rotation",
                     "Tangent"):
            notes = self.material(fake.principled(**{name: noise}))[1].notes
            self.assertEqual(len([text for text in notes if "linked to" in text]), 1, name)
            self.assertEqual(self.material(fake.principled(**{name: value(0.0)}))[1].notes, [], name)
        image = fake.texture(fake.image(space="Non-Color"))
        self.assertEqual(self.material(fake.principled(Specular=image))[1].notes, [])

    def test_what_comes_through_is_rougher_as_transmission_roughness_says(self):
        image = fake.texture(fake.image())
        for kind, transmission, rough, expected, said in (
                ("GGX", 1.0, 0.2, 0.6, 0), ("MULTI_GGX", 1.0, 0.2, None, 0), ("GGX", 0.0, 0.2, None, 0),
                ("GGX", 0.5, 0.2, None, 1), ("GGX", 1.0, image, None, 1)):
            shader = fake.principled(Transmission=transmission, Roughness=rough, Transmission_Roughness=0.5)
            shader.distribution = kind
            found, result = self.material(shader)
            notes = [text for text in result.notes if "Transmission Roughness" in text]
            self.assertEqual((found.get("roughness"), len(notes)), (expected, said))

    def test_procedural_inputs_are_neither_white_nor_metal_nor_light(self):
        noise = fake.Node("TEX_NOISE", {"Scale": 5.0}, ("Color",))
        found, result = self.material(fake.principled(Base_Color=noise, Metallic=noise, Roughness=noise, Transmission=noise,
                                                      Emission=noise))
        self.assertEqual(found, {"base_color": [0.8] * 3, "metallic": 0.0, "roughness": 0.5, "transmission": 0.0,
                                 "emission": {"color": [0.0] * 3}})
        self.assertIn("material 'M': nodes that are not brought over: 'TEX_NOISE'", result.notes)
        painted = fake.principled(Base_Color=fake.Node("VERTEX_COLOR", outputs=("Color",)), Metallic=fake.texture(fake.image()))
        self.assertEqual(self.material(painted)[0], {})

    def test_a_coat_by_a_texture_has_a_quarter_of_its_light_too(self):
        self.assertEqual(self.material(fake.principled(Clearcoat=fake.texture(fake.image())))[0]["clearcoat"], 0.25)

    def test_shadows_that_are_not_transparent_are_said(self):
        for alpha, transparent_shadow, said in ((1.0, False, 0), (0.5, True, 0), (0.5, False, 1)):
            result, item = Written(), fake.material("M", fake.principled(Alpha=alpha))
            item.cycles = fake.SimpleNamespace(use_transparent_shadow=transparent_shadow)
            scene_settings.material(item, True, result)
            self.assertEqual(len(result.notes), said)

    def test_images_times_constants_are_brought_over_by_the_exporter(self):
        def product(tint=GREY, factor=1.0, blend="MULTIPLY"):
            inputs = {"Factor": factor, "V": None, "A": None, "B": None, "C": None, "D": None,
                      "A__6": fake.texture(fake.image()), "B__7": tint}
            return fake.Node("MIX", inputs, data_type="RGBA", blend_type=blend)

        for node, said in ((product(), 0), (product(rgb(RED)), 0), (product(factor=0.5), 1), (product(blend="ADD"), 1),
                           (product(fake.Node("TEX_NOISE")), 1)):
            self.assertEqual(len(self.material(fake.principled(Base_Color=node))[1].notes), said)
        image = fake.texture(fake.image(space="Non-Color"))
        rough = fake.Node("MATH", {"Value": image, "Value__2": 0.5}, operation="MULTIPLY")
        self.assertEqual(self.material(fake.principled(Roughness=rough))[1].notes, [])
        self.assertEqual(len(self.material(fake.principled(Clearcoat=rough))[1].notes), 1)
        # The add-on itself brings over the image of Diffuse alone.
        self.assertEqual(len(self.material(diffuse(product()))[1].notes), 1)

    def test_alpha_of_images_darkens_their_colours_unless_something_is_linked_to_it(self):
        for mode, linked, expected in (("STRAIGHT", False, True), ("STRAIGHT", True, False), ("NONE", False, False),
                                       ("CHANNEL_PACKED", False, False)):
            picture = fake.image(alpha_mode=mode, depth=32)
            source = fake.texture(picture)
            source.outputs["Alpha"].is_linked = linked
            for shader, there in ((diffuse(source), True), (fake.principled(Base_Color=source), expected)):
                found = self.material(shader)[1].textures
                self.assertEqual({name: texture.times_alpha for name, texture in found.items()},
                                 {"M": expected} if there else {})

    def test_images_that_are_told_to_have_no_alpha_are_opaque(self):
        for mode, opaque in (("NONE", True), ("STRAIGHT", False)):
            picture = fake.image(alpha_mode=mode, depth=32)
            source = fake.texture(picture)
            source.outputs["Alpha"].is_linked = True
            for shader in (fake.principled(Base_Color=source, Alpha=(source, "Alpha")),
                           fake.group(fake.principled(Base_Color=source, Alpha=(source, "Alpha"))),
                           fake.mix((source, "Alpha"), transparent(), diffuse(source))):
                result = self.material(shader)[1]
                blended = "M" in result.blended or (result.textures and result.textures["M"].with_alpha)
                self.assertEqual((bool(blended), result.notes), (not opaque, []))
            result = self.material(fake.principled(Alpha=(source, "Alpha")), blend="CLIP")[1]
            self.assertEqual(result.opaque, {"M"} if opaque else set())

    def test_alpha_that_eevee_clips_is_coverage(self):
        self.assertEqual(self.material(fake.principled(), blend="CLIP")[1].blended, {"M"})

    def test_textures_that_lie_otherwise_are_said(self):
        def notes(picture, vector=None, **properties):
            texture = fake.texture(picture, vector, **properties)
            return self.material(fake.principled(Base_Color=fake.Node("MIX_RGB", {"Color": texture})))[1].notes

        here = fake.image()
        self.assertEqual(notes(here), ["material 'M': nodes that are not brought over: 'MIX_RGB'"])
        coordinates = fake.Node("TEX_COORD", outputs=("UV", "Object"))
        for output, said in (("UV", 1), ("Object", 2)):
            self.assertEqual(len(notes(here, fake.mapping((coordinates, output)))), said)
        for picture, properties in ((None, {}), (fake.image(size=(0, 0)), {}), (fake.image(source="SEQUENCE"), {}),
                                    (here, {"projection": "BOX"}), (here, {"extension": "CLIP"})):
            self.assertEqual(len(notes(picture, **properties)), 2)
        bright = self.material(fake.principled(Emission=fake.texture(fake.image(is_float=True))))[1]
        self.assertIn("up to 1 alone", bright.notes[0])


class Volumes(unittest.TestCase):
    def scatter(self, color=GREY, density=2.0, forward=0.0):
        return fake.Node("VOLUME_SCATTER", {"Color": color, "Density": density, "Anisotropy": forward})

    def absorption(self, color=GREY, density=2.0):
        return fake.Node("VOLUME_ABSORPTION", {"Color": color, "Density": density})

    def coefficients(self, volume):
        """Scattering and extinction that the program makes of the factors."""
        found = volumes.medium(nodes.Seen(volume))
        extinction = [-math.log(channel) / found["attenuation_distance"] for channel in found["attenuation_color"]]
        forward, albedo = found.get("scatter_anisotropy", 0.0), []
        for color in found.get("multiscatter_color", [0.0] * 3):
            s = 4.09712 + 4.20863 * color - math.sqrt(9.59217 + 41.6808 * color + 17.7126 * color ** 2)
            albedo.append(max((1.0 - s * s) / (1.0 - forward * s * s), 0.0))
        return [a * b for a, b in zip(albedo, extinction)] + extinction

    def test_media_are_those_of_cycles(self):
        principled = fake.Node("PRINCIPLED_VOLUME", {"Color": GREY, "Density": value(4.0), "Anisotropy": 0.5,
                                                     "Absorption Color": (0.0,) * 4})
        both = fake.Node("ADD_SHADER", {"Shader": self.scatter(forward=0.3), "Shader__2": self.absorption(density=6.0)})
        for volume, scattering, extinction in ((self.scatter(), 1.0, 1.0), (self.absorption(), 0.0, 1.0), (principled, 2.0, 4.0),
                                               (both, 1.0, 4.0)):
            for found, wanted in zip(self.coefficients(volume), [scattering] * 3 + [extinction] * 3):
                self.assertAlmostEqual(found, wanted, places=3)

    def fog(self, volume, surface=None, closed=True):
        result = Written()
        return scene_settings.material(fake.material("M", surface, Volume=volume), closed, result), result

    def test_fog_is_a_body_without_a_surface(self):
        found, result = self.fog(self.scatter())
        self.assertEqual((found["ior"], found["solid"], found["transmission"], result.notes), (1.0, True, 1.0, []))
        for volume, closed in ((self.scatter(density=fake.Node("ATTRIBUTE")), True), (self.scatter(), False)):
            found, result = self.fog(volume, closed=closed)
            self.assertEqual((found, result.left_out, len(result.notes)), ({}, {"M"}, 1))

    def test_glass_is_filled(self):
        found = self.fog(self.absorption(), fake.principled(Transmission=1.0, IOR=1.45))[0]
        self.assertAlmostEqual(found["attenuation_distance"], 1.0)
        self.assertNotIn("attenuation_distance", self.fog(self.absorption(), fake.principled())[0])
        for shader, closed, said in ((fake.principled(), True, 0), (fake.principled(Transmission=1.0), False, 1),
                                     (fake.mix(0.5, transparent(), diffuse()), True, 1)):
            self.assertEqual(len(self.fog(self.absorption(), shader, closed)[1].notes), said)


class Document(unittest.TestCase):
    """Changes of the GLB."""

    def document(self):
        return {"materials": [{"name": "A", "alphaMode": "MASK", "alphaCutoff": 0.5, "normalTexture": {"index": 0}}, {"name": "B"}],
                "meshes": [{"primitives": [{"material": 0}, {"material": 1}]}, {"primitives": [{"material": 1}]}],
                "nodes": [{"mesh": 0}, {"mesh": 1}]}

    def mend(self, **changes):
        document = self.document()
        binary = glb_materials.mend(document, b"12345", Written(**changes), lambda *image: (b"PNG", "image/png"),
                                    lambda material, uv_map: {"": 0, "Second": 1}[uv_map])
        return document, binary

    def test_alpha_that_is_not_there_goes(self):
        document, _ = self.mend(opaque={"A"})
        self.assertEqual(set(document["materials"][0]) & {"alphaMode", "alphaCutoff"}, set())

    def test_images_that_their_alpha_darkens_take_the_place_of_the_exporters(self):
        document = self.document()
        document["materials"][0]["pbrMetallicRoughness"] = {"baseColorTexture": {"index": 7, "texCoord": 1}}
        written = Written(textures={"A": Texture(fake.image(), times_alpha=True)})
        glb_materials.mend(document, b"", written, lambda _, times_alpha: (b"PNG" if times_alpha else b"", "image/png"),
                           lambda *names: 0)
        surface = document["materials"][0]["pbrMetallicRoughness"]
        self.assertEqual(surface["baseColorTexture"], {"index": 0, "texCoord": 1})

    def test_alpha_bumps_and_sides(self):
        document, _ = self.mend(blended={"A"}, alphas={"A": 0.5}, unbumped={"A"})
        self.assertEqual(document["materials"], [
            {"name": "A", "alphaMode": "BLEND", "doubleSided": True,
             "pbrMetallicRoughness": {"baseColorFactor": [1.0, 1.0, 1.0, 0.5]}},
            {"name": "B", "doubleSided": True}])

    def test_shaders_that_are_not_shown_go(self):
        light = {"emissiveFactor": [1.0] * 3, "extensions": {glb_materials.STRENGTH: {"emissiveStrength": 2.0}}}
        for bare, dark, expected in (({"A"}, set(), light), ({"A"}, {"A"}, {"extensions": {}})):
            document = self.document()
            document["materials"][0] |= {"pbrMetallicRoughness": {"metallicFactor": 0.5}, "extras": {"mine": 1},
                                         **copy.deepcopy(light)}
            document["materials"][0]["extensions"]["KHR_materials_ior"] = {"ior": 1.2}
            glb_materials.mend(document, b"", Written(bare=bare, dark=dark), lambda *image: (b"", ""), lambda *names: 0)
            self.assertEqual(document["materials"][0], {"name": "A", "doubleSided": True, "extras": {"mine": 1}, **expected})

    def test_images_that_are_added_lie_as_blender_has_them(self):
        transform = {"offset": [0.5, 0.0], "rotation": 0.0, "scale": [2.0, 2.0]}
        texture = Texture(fake.image(), uv_map="Second", transform=transform, sampler={"wrapS": 33071})
        document, _ = self.mend(textures={"A": texture})
        self.assertEqual(document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"],
                         {"texCoord": 1, "extensions": {glb_materials.TRANSFORM: transform}, "index": 0})
        self.assertEqual((document["samplers"], document["extensionsUsed"]), ([{"wrapS": 33071}], [glb_materials.TRANSFORM]))

    def test_parts_have_the_materials_that_they_are_rendered_with(self):
        """The exporter takes the slots of the object, whatever its modifiers have made of them."""
        document, a, b = self.document(), fake.Block("A"), fake.Block("B")
        document["nodes"].append({"mesh": 1})
        self.assertEqual(glb_materials.give_parts(document, {0: [a, b], 1: [b], 2: [None]}, [a, b]), [])
        self.assertEqual([node["mesh"] for node in document["nodes"]], [0, 1, 2])
        self.assertEqual(document["meshes"][2], {"primitives": [{}]})
        self.assertEqual(glb_materials.give_parts(document, {0: [b, a], 1: [a], 2: [a]}, [a, b]), [])
        found = [document["meshes"][node["mesh"]]["primitives"] for node in document["nodes"]]
        self.assertEqual([[part.get("material") for part in parts] for parts in found], [[1, 0], [0], [0]])
        # Without the material, or with other parts, nothing changes.
        self.assertEqual(glb_materials.give_parts(document, {0: [a], 1: [fake.Block("C")]}, [a, b]), [0, 1])

    def test_fog_that_is_not_read_is_left_out(self):
        document, _ = self.mend(left_out={"B"})
        self.assertEqual((document["meshes"][0]["primitives"], document["nodes"]), ([{"material": 0}], [{"mesh": 0}, {}]))

    def test_one_material_for_all(self):
        document = self.document()
        glb_materials.override(document, "Clay")
        self.assertEqual([primitive["material"] for mesh in document["meshes"] for primitive in mesh["primitives"]], [2, 2, 2])

    def test_images_are_added_once(self):
        picture = fake.image("bark")
        namesake = fake.image("bark", size=(4, 4))
        document, _ = self.mend(textures={"A": Texture(picture), "B": Texture(namesake)})
        self.assertEqual(len(document["images"]), 2)
        document, binary = self.mend(textures={"A": Texture(picture, True), "B": Texture(picture)})
        self.assertEqual(binary, b"12345\0\0\0PNG")
        self.assertEqual(document["bufferViews"], [{"buffer": 0, "byteOffset": 8, "byteLength": 3}])
        self.assertEqual((document["textures"], document["images"][0]["mimeType"]), ([{"source": 0, "sampler": 0}], "image/png"))
        self.assertEqual([material["pbrMetallicRoughness"]["baseColorTexture"]["index"] for material in document["materials"]], [0, 0])
        self.assertEqual([material.get("alphaMode") for material in document["materials"]], ["BLEND", None])

    @unittest.skipIf(numpy is None, "there is no numpy (Debian: python3-numpy)")
    def test_pixels_that_are_linear_become_srgb(self):
        for space, expected in (("sRGB", 55), ("Non-Color", 128)):
            pixels = fake.SimpleNamespace(foreach_get=lambda flat: flat.fill(55.0 / 255.0))
            picture = fake.image(space=space, size=(1, 1), channels=3, is_dirty=True, packed_file=None, pixels=pixels)
            found = images.image_bytes(picture, None)[0]
            size, = struct.unpack_from(">I", found, 33)
            self.assertEqual(zlib.decompress(found[41:41 + size])[1], expected)

    @unittest.skipIf(numpy is None, "there is no numpy (Debian: python3-numpy)")
    def test_colours_are_multiplied_by_alpha_as_they_are_encoded(self):
        pixels = fake.SimpleNamespace(foreach_get=lambda flat: flat.__setitem__(slice(None), [1.0, 0.5, 0.0, 0.4]))
        picture = fake.image(size=(1, 1), channels=4, is_dirty=False, packed_file=None, pixels=pixels)
        found = images.image_bytes(picture, None, True)[0]
        size, = struct.unpack_from(">I", found, 33)
        self.assertEqual(zlib.decompress(found[41:41 + size]), bytes([0, 102, 51, 0, 255]))

    @unittest.skipIf(numpy is None, "there is no numpy (Debian: python3-numpy)")
    def test_pixels_become_a_png(self):
        found = images.png(numpy.arange(8, dtype=numpy.uint8).reshape(1, 2, 4))
        self.assertEqual(struct.unpack_from(">II", found, 16), (2, 1))
        size, = struct.unpack_from(">I", found, 33)
        self.assertEqual(zlib.decompress(found[41:41 + size]), bytes([0, *range(8)]))


class Layers(unittest.TestCase):
    def item(self, name, material, uv_maps, colors=()):
        new = fake.SimpleNamespace
        maps = [new(name=uv_map, active_render=number == 0) for number, uv_map in enumerate(uv_maps)]
        slot = new(material=new(original=material))
        mesh = new(uv_layers=maps, color_attributes=[new(name=color) for color in colors])
        return fake.item(name, mesh, "MESH", material_slots=[slot])

    def notes(self, shader, *items):
        result, material = Written(), fake.Block("M")
        scene_settings.material(fake.material("M", shader), True, result)
        meshes = layers.users([self.item(name, material, *has) for name, *has in items], {material: "M"}, None)
        return [*layers.missing(meshes, result), *layers.tangents(result, layers.uv_sets(meshes, result))]

    def test_what_a_mesh_lacks_is_said(self):
        second = fake.texture(fake.image(), fake.Node("UVMAP", outputs=("UV",), uv_map="Second"))
        items = (("A", ["First"]), ("B", ["First", "Second"]), ("C", []))
        self.assertEqual(self.notes(diffuse(second), *items),
                         ["material 'M': there is no UV map 'Second', and another is in its place: 'A', 'C'"])
        self.assertEqual(self.notes(diffuse(fake.texture(fake.image())), *items), [])
        paint = fake.Node("VERTEX_COLOR", outputs=("Color",), layer_name="Paint")
        self.assertEqual(len(self.notes(diffuse(paint), ("A", [], ["Paint"]), ("B", [], ["Other"]))), 1)

    def test_tangents_of_another_map_are_said(self):
        for uv_map, said in (("", 0), ("First", 0), ("Second", 1)):
            image = fake.texture(fake.image(space="Non-Color"))
            node = fake.Node("NORMAL_MAP", {"Color": image, "Strength": 1.0}, space="TANGENT", uv_map=uv_map)
            self.assertEqual(len(self.notes(fake.principled(Normal=node), ("A", ["First", "Second"]))), said)


class Overlooked(unittest.TestCase):
    def notes(self, *items, **flags):
        return overlooked.notes(items, fake.view_layer(**flags))

    def test_each_is_said_once_with_the_names(self):
        flags = {"visible_shadow": False,
                 "light_linking": fake.SimpleNamespace(receiver_collection="C", blocker_collection=None)}
        items = [fake.item(name, None, "MESH", **flags) for name in "fbcade"]
        found = self.notes(*items)
        self.assertEqual(len(found), 2)
        for text in found:
            self.assertTrue(text.endswith(": 'a', 'b', 'c', 'd' and 2 more"), text)
        self.assertEqual(self.notes(lightgroups=[fake.SimpleNamespace(name="Key")]), ["light groups are not brought over: 'Key'"])
        self.assertFalse(overlooked.moves_blurred(fake.item("a", None, "MESH", cycles=fake.SimpleNamespace(use_motion_blur=False))))
        self.assertTrue(overlooked.moves_blurred(None))
        self.assertEqual(self.notes(fake.item("a", None, "MESH")), [])

    def test_geometry_nodes_that_ask_for_viewports_and_view_layers_that_ask_for_more(self):
        inner = fake.SimpleNamespace(nodes=[fake.SimpleNamespace(bl_idname="GeometryNodeIsViewport")])
        group = fake.SimpleNamespace(nodes=[fake.SimpleNamespace(bl_idname="GeometryNodeGroup", node_tree=inner)])
        for tree, said in ((group, 1), (fake.SimpleNamespace(nodes=[]), 0), (None, 0)):
            item = fake.item("Field", None, "MESH", modifiers=[fake.SimpleNamespace(type="NODES", node_group=tree)])
            self.assertEqual(len(self.notes(item)), said)
        self.assertEqual(self.notes(aovs=[fake.SimpleNamespace(name="Key")]), ["shader AOVs are not brought over: 'Key'"])
        self.assertEqual(len(self.notes(use_volumes=False, name="Layer")), 1)
        self.assertEqual(self.notes(use_solid=False, name="Layer"),
                         ["surfaces are shown in view layers without them: 'Layer'"])

    def test_lamps_with_bounces_of_their_own_are_said(self):
        for bounces, said in ((1024, 0), (0, 1)):
            lamp = fake.light("POINT", cycles=fake.SimpleNamespace(max_bounces=bounces, cast_shadow=True))
            self.assertEqual(len(self.notes(fake.item("Lamp", lamp, "LIGHT"))), said)

    def test_volumes_hair_and_lamps(self):
        hair = fake.SimpleNamespace(settings=fake.SimpleNamespace(type="HAIR", render_type="PATH"))
        lamp = fake.light("POINT", cycles=fake.SimpleNamespace(cast_shadow=False))
        found = self.notes(fake.item("Drop", None, "META"), fake.item("Smoke", None, "VOLUME"), fake.item("Head", None, "MESH", particle_systems=[hair]),
                           fake.item("Lamp", lamp, "LIGHT"))
        self.assertEqual([text.split(": ")[1] for text in found], ["'Drop'", "'Smoke'", "'Head'", "'Lamp'"])

    def test_objects_and_collections_are_holdouts_and_catchers(self):
        def are(kind="MESH", **properties):
            item = fake.item("A", None, kind, **properties)
            return overlooked.is_holdout(item, None), overlooked.is_shadow_catcher(item)

        self.assertEqual(are(), (False, False))
        self.assertEqual(are(is_holdout=True), (True, False))
        self.assertEqual(are(holdout_get=lambda view_layer: True), (True, False))
        self.assertEqual(are(is_shadow_catcher=True), (False, True))
        self.assertEqual(are("LIGHT", is_holdout=True, is_shadow_catcher=True), (False, False))

    def test_light_has_no_alpha_for_holdouts_and_catchers(self):
        items = [fake.item("Floor", None, "MESH", is_shadow_catcher=True), fake.item("Cube", None, "MESH", is_holdout=True),
                 fake.item("Ball", None, "MESH")]
        for integrator, expected, count in (("path", items[:2], 0), ("vcm", items[:2], 0), ("light", [], 1)):
            said = []
            self.assertEqual(overlooked.replaced(items, None, integrator, said.append), expected)
            self.assertEqual(len(said), count)

    def test_objects_and_collections_hide_from_the_camera(self):
        def hidden(kind="MESH", **properties):
            return overlooked.is_hidden(fake.item("A", None, kind, **properties), None)

        self.assertTrue(hidden(indirect_only_get=lambda view_layer: True))
        self.assertTrue(hidden(visible_camera=False))
        self.assertFalse(hidden())
        self.assertFalse(hidden("LIGHT", visible_camera=False))

    def test_panoramas_with_limits_are_said(self):
        def notes(**limits):
            settings = fake.SimpleNamespace(panorama_type="EQUIRECTANGULAR", latitude_min=-0.5 * math.pi, latitude_max=0.5 * math.pi,
                                            longitude_min=-math.pi, longitude_max=math.pi)
            vars(settings).update(limits)
            result = Written()
            scene_settings.camera_settings(fake.camera("PANO", cycles=settings), result, 2, 1)
            return result.notes

        self.assertEqual((len(notes()), len(notes(longitude_max=1.0))), (0, 1))

    def test_panoramas_without_their_depth_of_field_are_said(self):
        result, camera = Written(), fake.camera("PANO")
        camera.dof.use_dof = True
        scene_settings.camera_settings(camera, result, 2, 1)
        self.assertEqual(len(result.notes), 1)


@unittest.skipIf(PROGRAM is None, "no program was given")
class WithTheProgram(unittest.TestCase):
    def test_it_knows_every_key(self):
        scatter = fake.Node("VOLUME_SCATTER", {"Color": GREY, "Density": 1.0, "Anisotropy": 0.1})
        shaders = (fake.group(fake.principled(Base_Color=RED, Transmission=0.5, Emission=RED, Specular=0.5)), emission(),
                   fake.Node("BSDF_TRANSLUCENT", {"Color": RED}), fake.mix(0.5, transparent(), diffuse()),
                   fake.Node("SUBSURFACE_SCATTERING", {"Color": RED, "Scale": 0.1, "Radius": (1.0, 0.5, 0.2)}))
        items = [(fake.material(f"M{index}", shader), True) for index, shader in enumerate(shaders)]
        items.append((fake.material("Fog", None, Volume=scatter), True))
        document = scene_settings.write(fake.scene(), (), items, ()).document
        self.assertEqual(len(document["materials"]), 6)
        self.assertEqual(program.known_part(PROGRAM, document)[1], [])


if __name__ == "__main__":
    skipped_tests.main("blender_nodes_test")
