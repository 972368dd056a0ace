"""Tests of what tools/lab/compare-cycles tells Blender, in whose place stands a dummy that takes note of it."""

import math
import sys
import types
import unittest
from collections import defaultdict
from pathlib import Path
from unittest import mock

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools/lab"))
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools/gen"))

BPY = mock.MagicMock()
BPY.types.NodeSocket = type("NodeSocket", (), {})
with mock.patch.dict(sys.modules, {"bpy": BPY, "mathutils": mock.MagicMock(), "numpy": mock.MagicMock()}):
    from cycles import blender_scene


class Tree:
    """Of nodes as Blender makes them: sockets are there when they are asked for."""

    def __init__(self, kinds=()):
        self.all, self.links = [], mock.MagicMock()
        self.nodes = self
        for kind in kinds:
            self.new(kind)

    def new(self, kind):
        node = types.SimpleNamespace(
            kind=kind, type=kind, inputs=defaultdict(lambda: types.SimpleNamespace(is_linked=False, default_value=(1, 1, 1, 1))),
            outputs=defaultdict(BPY.types.NodeSocket), mapping=mock.MagicMock())
        self.all.append(node)
        return node

    def remove(self, node):
        self.all.remove(node)

    def __iter__(self):
        return iter(self.all)

    def of(self, kind):
        return [node for node in self.all if node.kind == kind]


class ToldToBlender(unittest.TestCase):
    def test_lights_come_in_watts_per_steradian(self):
        blender_scene.import_gltf("a.gltf")
        BPY.ops.import_scene.gltf.assert_called_with(filepath="a.gltf", convert_lighting_mode="COMPAT")
        point, sun = (types.SimpleNamespace(name=name, shadow_soft_size=1.0, angle=1.0, cycles=types.SimpleNamespace())
                      for name in ("point", "sun"))
        with mock.patch.object(BPY.data, "lights", [point, sun]):
            blender_scene.make_lights({"lights": {
                "point": {"type": "point", "color": [1, 0, 0], "intensity": 2.0},
                "sun": {"type": "directional", "color": [1, 1, 1], "intensity": 3.0}}})
        self.assertAlmostEqual(point.energy, 8.0 * math.pi)
        self.assertEqual((point.shadow_soft_size, sun.angle, sun.energy), (0.0, 0.0, 3.0))

    def test_an_area_lamp_has_four_times_its_area_and_radiance(self):
        for kind, properties, area, watts in (("AREA", {"size": 2.0}, 6.0, 4.0 * 6.0 * 5.0),
                                              ("POINT", {"shadow_soft_size": 0.5}, None, 5.0 * math.pi ** 2)):
            light, item = mock.MagicMock(), mock.MagicMock()
            with mock.patch.object(BPY.data.lights, "new", lambda *_: light):
                blender_scene.make_lamp(mock.MagicMock(), item, [5.0, 2.5, 0.0], (kind, properties, area, None))
            self.assertAlmostEqual(light.energy, watts)
            self.assertEqual(light.color, [1.0, 0.5, 0.0])

    def test_nothing_is_clamped_filtered_denoised_or_left_out(self):
        scene = mock.MagicMock()
        blender_scene.set_cycles(scene, {"threads": 2, "max_bounces": 14, "roulette_bounces": 1})
        cycles = scene.cycles
        self.assertEqual((cycles.pixel_filter_type, scene.render.threads), ("BOX", 2))
        self.assertEqual({cycles.sample_clamp_direct, cycles.sample_clamp_indirect, cycles.blur_glossy,
                          cycles.light_sampling_threshold}, {0.0})
        self.assertFalse(cycles.use_adaptive_sampling or cycles.use_denoising or cycles.use_guiding or cycles.use_fast_gi)
        self.assertTrue(cycles.caustics_reflective and cycles.caustics_refractive)
        self.assertEqual({cycles.max_bounces, cycles.diffuse_bounces, cycles.glossy_bounces, cycles.transmission_bounces,
                          cycles.volume_bounces}, {14})
        self.assertEqual(cycles.min_light_bounces, 1)

    def material(self, **plan):
        tree = Tree(("BSDF_PRINCIPLED", "VOLUME_ABSORPTION", "OUTPUT_MATERIAL"))
        material = types.SimpleNamespace(name="a", node_tree=tree, cycles=types.SimpleNamespace())
        blender_scene.make_material(material, {"emission": [0, 0, 0], "double_sided": False, **plan})
        return tree

    def test_matte_is_lamberts_and_not_a_principled_surface(self):
        tree = self.material(kind="diffuse", color=[0.1, 0.2, 0.3])
        diffuse, = tree.of("ShaderNodeBsdfDiffuse")
        self.assertEqual(diffuse.inputs["Color"].default_value, (0.1, 0.2, 0.3, 1.0))
        self.assertEqual(tree.of("BSDF_PRINCIPLED"), [])

    def test_only_bodies_that_absorb_have_a_node_for_it(self):
        clear = self.material(kind="glass", ior=1.5, absorption=None)
        self.assertEqual(clear.of("VOLUME_ABSORPTION") + clear.of("ShaderNodeVolumeAbsorption"), [])
        absorbing, = self.material(kind="glass", ior=1.5, absorption=[0.5, 2.0, 1.0]).of("ShaderNodeVolumeAbsorption")
        self.assertEqual(absorbing.inputs["Density"].default_value, 2.0)
        self.assertEqual(absorbing.inputs["Color"].default_value, (0.75, 0.0, 0.5, 1.0))

    def test_environments_are_turned_by_a_quarter(self):
        tree = Tree(("BACKGROUND",))
        with mock.patch.object(BPY.data.worlds, "new", lambda _: types.SimpleNamespace(
                node_tree=tree, cycles_visibility=types.SimpleNamespace())):
            blender_scene.make_world(mock.MagicMock(), {"image": "sky.exr", "color": [1, 2, 3], "scale": 4.0, "rotation": 0.25,
                                                        "visible": True})
        mapping, = tree.of("ShaderNodeMapping")
        self.assertAlmostEqual(mapping.inputs["Rotation"].default_value[2], -0.5 * math.pi - 0.25)
        self.assertEqual(tree.of("BACKGROUND")[0].inputs["Strength"].default_value, 4.0)


if __name__ == "__main__":
    unittest.main()
