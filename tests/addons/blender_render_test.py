"""Tests of Etendue as a render engine in Blender, without a window: blender_render_test.py PROGRAM [TEST...]

Ends with 77 where there is no Blender, or one without numpy."""

import json
import math
import os
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "addons/blender")]

from etendue.exr_header import channel_kinds, read_attributes  # noqa: E402
from lib.addon_zip import write_zip  # noqa: E402

PROGRAM = Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else None
# Blender takes the modules of the first python3 of the path; numpy is with Debian's.
PATH = f"/usr/bin:{os.environ.get('PATH', '')}"


class InBlender(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="etendue-blender-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        addons = self.folder / "scripts/addons"
        addons.mkdir(parents=True)
        shutil.copytree(ROOT / "addons/blender/etendue", addons / "etendue", ignore=shutil.ignore_patterns("__pycache__"))
        self.temporary = self.folder / "tmp"
        self.temporary.mkdir()
        self.environment = {**os.environ, "BLENDER_USER_SCRIPTS": str(self.folder / "scripts"), "ETENDUE": str(PROGRAM),
                            "PATH": PATH, "TMPDIR": str(self.temporary), "PYTHONDONTWRITEBYTECODE": "1"}

    def start(self, *words):
        command = ["blender", "--background", "--factory-startup", "--python-exit-code", "1", "--addons", "etendue"]
        return subprocess.Popen([*command, *map(str, words)], env=self.environment, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, text=True)

    def blender(self, *words, code=0):
        """Returns what it prints; fails unless it ends with this code."""
        process = self.start(*words)
        said, _ = process.communicate(timeout=500)
        self.assertEqual(process.returncode, code, said[-3000:])
        return said

    def inside(self, function, *words):
        return self.blender("--python", ROOT / "tests/addons/blender_in_blender.py", "--", function, *words)

    def simple(self, change="pass"):
        """A .blend with a ball under a sky, and where its image goes."""
        blend, image = self.folder / "simple.blend", self.folder / "simple_####.exr"
        self.inside("save_simple", blend, image, change)
        return blend, self.folder / "simple_0001.exr"

    def left_over(self):
        return [path.name for path in self.temporary.rglob("*") if "etendue-" in path.name]


def processes_with(word):
    """The command lines of processes that have the word in them."""
    found = []
    for file in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            line = file.read_bytes().replace(b"\0", b" ").decode(errors="replace")
        except OSError:
            continue
        if word in line:
            found.append(line)
    return found


def header(path):
    """Channels and attributes of an EXR."""
    attributes, _ = read_attributes(path.read_bytes())
    return {name for name, _ in channel_kinds(attributes["channels"])}, attributes


class Renders(InBlender):
    def python(self, code, image):
        """Returns the value of the code inside Blender: `p(NAME)` has the pixels of a pass of the image, `p("")` of the image."""
        before = (f"import sys, json, numpy; sys.path.insert(0, {str(ROOT / 'addons/blender')!r}); from pathlib import Path; "
                  f"from etendue.exr import read_exr; c = read_exr(Path({str(image)!r})).channels; "
                  "p = lambda n: numpy.stack([c[f'ViewLayer.{n}.{l}' if n else l].astype(float) for l in 'RGB']); ")
        said = self.blender("--python-expr", f"{before} print('FOUND', json.dumps({code}))")
        return json.loads(next(line for line in said.splitlines() if line.startswith("FOUND")).removeprefix("FOUND"))

    def means(self, image, *passes):
        return self.python(f"{{n: p(n).mean(axis=(1, 2)).tolist() for n in {passes!r}}}", image)

    def difference_of_sum(self, image):
        """The largest difference between the image and the sum of its passes, as Blender's manual has it."""
        parts = " + ".join(f"p('{name}')" for name in ("GlossDir", "GlossInd", "TransDir", "TransInd", "Emit", "Env"))
        return self.python(f"abs(p('DiffCol') * (p('DiffDir') + p('DiffInd')) + {parts} - p('Combined')).max()", image)

    def test_everything_by_the_command_line_as_cycles_renders_it(self):
        blend = self.folder / "everything.blend"
        self.inside("save", "everything", blend, self.folder / "image_####.exr", "64")
        image = self.folder / "image_0001.exr"
        self.blender(blend, "-E", "CYCLES", "-f", "1")
        theirs = self.means(image, "Combined")["Combined"]
        cycles = image.rename(self.folder / "cycles.exr")
        said = self.blender(blend, "-E", "ETENDUE", "-f", "1")
        self.assertNotIn("Error", said)
        self.assertNotIn("does not know", said)
        found = self.means(image, "Combined", "DiffDir", "DiffInd", "DiffCol", "GlossDir", "GlossInd", "TransDir", "TransInd",
                           "Emit", "Env", "sun")
        # 64 samples of 6,912 pixels: noise below 0.5%; the diffuse lobe of the Principled BSDF and the spot's cosine make
        # up to 2% in this scene.
        for channel, (ours, expected) in enumerate(zip(found["Combined"], theirs)):
            self.assertLess(abs(ours / expected - 1.0), 0.03, f"channel {channel}: {ours} and {expected}")
        self.assertGreater(found["sun"][0], 0.01)
        # Edges are pixels of the one thing or of the other.
        same = self.python("(lambda d: [float((abs(d[n] - c[n]) < 0.01).mean()) for n in ('ViewLayer.IndexOB.X', "
                           f"'ViewLayer.IndexMA.X', 'ViewLayer.Mist.Z')])(read_exr(Path({str(cycles)!r})).channels)", image)
        for share in same:
            self.assertGreater(share, 0.9)
        self.assertLess(self.difference_of_sum(image), 1e-3)
        channels, attributes = header(image)
        for name in ("Depth.Z", "Normal.X", "Position.Z", "UV.A", "Samples.X", "CryptoObject00.r", "CryptoObject02.a"):
            self.assertIn(f"ViewLayer.{name}", channels)
        names = [value for name, value in attributes.items() if name.startswith("cryptomatte/") and name.endswith("/name")]
        self.assertEqual(names, [b"ViewLayer.CryptoObject"])
        manifest = next(value for name, value in attributes.items() if name.endswith("/manifest"))
        self.assertLessEqual({"Plastic", "Metal", "Glass", "Matte", "Floor"}, set(json.loads(manifest)))
        self.assertEqual(self.left_over(), [])

    def test_the_compositor_finds_a_matte_by_the_name_of_its_object(self):
        image = self.folder / "matte.exr"
        self.inside("matte", image)
        # The ball covers 395 of 6,912 pixels.
        self.assertAlmostEqual(self.means(image, "")[""][0], 395 / 6912, delta=0.004)

    def test_the_compositor_reads_files_of_the_program(self):
        """Cryptomattes in parts of a file; and the image, not one of its halves, of a file with layers for denoising."""
        folder = self.folder / "sail"
        folder.mkdir()
        corners = struct.pack("<9f", -1, -1, -2, 1, -1, -2, 0, 1, -2)
        (folder / "scene.gltf").write_text(json.dumps({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
            "nodes": [{"name": "Sail", "mesh": 0}, {"name": "View", "camera": 0}],
            "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1, -1, -2],
                           "max": [1, 1, -2]}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"uri": "corners.bin", "byteLength": 36}]}))
        (folder / "corners.bin").write_bytes(corners)
        (folder / "render.json").write_text(json.dumps({"size": [64, 48], "environment": {"color": [0.25, 0.5, 0.75]}}))
        files = [self.folder / name for name in ("parts.exr", "denoising.exr", "matte.exr", "shown.exr")]
        parts, denoising, matte, shown = files
        for image, layers in ((parts, ("cryptomatte", "--aov-layout", "parts")), (denoising, ("denoising",))):
            subprocess.run([PROGRAM, "render", folder, "--integrator", "path", "--spp", "16", "--float", "--quiet", "-o", image,
                            "--aov", *layers], check=True)
        self.inside("read_files", *files)
        # A triangle as wide as 1 - y at the height y, in a view that is 2 h high and 8/3 h wide, where h is 2 tan 0.4.
        self.assertAlmostEqual(self.means(matte, "")[""][0], 3.0 / (16.0 * math.tan(0.4)), delta=0.005)
        for layer, differs in (("", False), ("half.", True)):
            expected = f"numpy.stack([read_exr(Path({str(denoising)!r})).channels['{layer}' + l] for l in 'RGB'])"
            self.assertEqual(self.python(f"float(abs(p('') - {expected}).max())", shown) > 1e-5, differs, layer)

    def test_the_image_is_shown_as_it_grows(self):
        answer = self.folder / "answer.json"
        self.inside("previews", answer)
        *shown, last = json.loads(answer.read_text())
        self.assertGreater(len(shown), 1)
        # Previews have 8 bits.
        for preview in shown[1:]:
            for channel, expected in zip(preview, last):
                self.assertAlmostEqual(channel / expected, 1.0, delta=0.02)

    def test_frames_show_what_moves(self):
        blend, image = self.simple("b = bpy.data.objects['Ball']; b.location.z = 0.8; b.keyframe_insert('location', frame=1); "
                                   "b.location.z = 100.0; b.keyframe_insert('location', frame=2)")
        self.blender(blend, "-E", "ETENDUE", "-s", "1", "-e", "2", "-a")
        one, two = (self.means(self.folder / f"simple_000{frame}.exr", "Combined")["Combined"][0] for frame in (1, 2))
        # The dark red of the ball is gone from 6% of the image.
        self.assertGreater(two - one, 0.005)

    def test_borders_and_denoising(self):
        blend, image = self.simple("r = scene.render; r.use_border = r.use_crop_to_border = True; r.border_min_x = 0.25; "
                                   "r.border_max_x = 0.9; r.border_min_y = 0.2; r.border_max_y = 0.8; scene.etendue.denoise = True; "
                                   "bpy.context.view_layer.use_pass_normal = True")
        said = self.blender(blend, "-E", "ETENDUE", "-f", "1")
        self.assertNotIn("Error", said)
        channels, attributes = header(image)
        x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
        self.assertEqual((x1 - x0 + 1, y1 - y0 + 1), (41, 29))
        self.assertIn("ViewLayer.Normal.Z", channels)

    def test_view_layers_show_what_is_in_them(self):
        blend, image = self.simple("c = bpy.data.collections.new('Away'); scene.collection.children.link(c); "
                                   "b = bpy.data.objects['Ball']; scene.collection.objects.unlink(b); c.objects.link(b); "
                                   "l = scene.view_layers.new('Without'); l.layer_collection.children['Away'].exclude = True; "
                                   "[setattr(v, 'use_pass_cryptomatte_object', True) for v in scene.view_layers]")
        self.blender(blend, "-E", "ETENDUE", "-f", "1")
        _, attributes = header(image)
        manifests = {}
        for name, value in attributes.items():
            if name.startswith("cryptomatte/") and name.endswith("/name"):
                manifests[value.decode()] = set(json.loads(attributes[name.removesuffix("name") + "manifest"]))
        self.assertIn("Ball", manifests["ViewLayer.CryptoObject"])
        self.assertNotIn("Ball", manifests["Without.CryptoObject"])

    def test_what_the_exporter_does_not_know(self):
        """An image at a Diffuse BSDF, fog around the camera, collections that hide, catchers and overrides, in the files."""
        node = ("t = bpy.data.materials['Blue'].node_tree; d = next(n for n in t.nodes if n.type == 'BSDF_DIFFUSE'); ",
                "i = t.nodes.new('ShaderNodeTexImage'); i.image = bpy.data.images.new('paint', 8, 8); "
                "i.image.pixels.foreach_set([0.0, 1.0, 0.0, 1.0] * 64); t.links.new(i.outputs[0], d.inputs[0]); "
                "bpy.data.objects['Floor'].is_shadow_catcher = True; bpy.data.objects['Ball'].is_holdout = True; l = bpy.context.view_layer; "
                "c = bpy.data.collections.new('Away'); scene.collection.children.link(c); b = bpy.data.objects['Cube']; "
                "scene.collection.objects.unlink(b); c.objects.link(b); l.layer_collection.children['Away'].indirect_only = True; "
                "m = bpy.data.materials.new('Fog'); m.use_nodes = True; n = m.node_tree.nodes; n.remove(n['Principled BSDF']); "
                "v = n.new('ShaderNodeVolumeScatter'); v.inputs['Density'].default_value = 0.01; "
                "m.node_tree.links.new(v.outputs[0], n['Material Output'].inputs['Volume']); "
                "bpy.ops.mesh.primitive_cube_add(size=40); bpy.context.object.data.materials.append(m); ")
        for override in ("", "o = l.material_override = bpy.data.materials.new('Clay'); o.diffuse_color = (1, 0, 0, 1)"):
            blend, image = self.simple("".join(node) + override)
            answer = self.folder / "answer.json"
            self.inside("files", blend, answer)
            found = json.loads(answer.read_text())
            entries, names = found["render"]["materials"], found["materials"]
            if override:
                self.assertEqual(entries["Clay"], {"diffuse": {"albedo": [1.0, 0.0, 0.0]}})
                self.assertTrue(all(name.startswith("Clay") for name in found["used"]), found["used"])
                continue
            self.assertEqual(names["Blue"]["pbrMetallicRoughness"]["baseColorTexture"], {"index": 0})
            self.assertEqual((entries["Blue"]["metallic"], entries["Fog"]["ior"], entries["Fog"]["solid"]), (0.0, 1.0, True))
            self.assertTrue(entries["Grey that catches shadows"]["shadow_catcher"])
            self.assertTrue(entries["Blue that is a holdout"]["holdout"])
            self.assertIs(entries["Red hidden from the camera"]["visible_to_camera"], False)
            self.assertEqual(found["notes"], [])

    def test_the_shader_that_a_mix_has_chosen_is_shown(self):
        """Of two Principled BSDFs, the exporter takes the first, with its image and its light."""
        blend, _ = self.simple(
            "t = bpy.data.materials['Blue'].node_tree; n = t.nodes; "
            "m = n.new('ShaderNodeMixShader'); m.inputs[0].default_value = 1.0; "
            "i = n.new('ShaderNodeTexImage'); i.image = bpy.data.images.new('paint', 8, 8); "
            "a, b = (n.new('ShaderNodeBsdfPrincipled') for _ in 'ab'); b.inputs['Base Color'].default_value = (0, 1, 0, 1); "
            "b.inputs['Metallic'].default_value = 1.0; t.links.new(i.outputs[0], a.inputs['Base Color']); "
            "e = next(s for s in a.inputs if s.name in ('Emission', 'Emission Color')); e.default_value = (1, 0, 0, 1); "
            "t.links.new(a.outputs[0], m.inputs[1]); t.links.new(b.outputs[0], m.inputs[2]); "
            "t.links.new(m.outputs[0], next(o for o in n if o.type == 'OUTPUT_MATERIAL').inputs[0])")
        answer = self.folder / "answer.json"
        self.inside("files", blend, answer)
        found = json.loads(answer.read_text())
        self.assertFalse({"pbrMetallicRoughness", "emissiveFactor"} & set(found["materials"]["Blue"]), found["materials"]["Blue"])
        entry = found["render"]["materials"]["Blue"]
        self.assertEqual((entry["base_color"], entry["metallic"], found["notes"]), ([0.0, 1.0, 0.0], 1.0, []))

    def test_an_error_is_said(self):
        for change, program, expected in (
                ("bpy.context.view_layer.etendue.layers = 'glass=lpe:C (T'", PROGRAM, "render.json#/aovs/0: .*glass"),
                ("bpy.context.view_layer.etendue.layers = 'depth'", PROGRAM, "'depth' is no layer"),
                ("pass", self.folder / "missing", ".*'etendue' is not found")):
            self.environment["ETENDUE"] = str(program)
            blend, _ = self.simple(change)
            self.assertRegex(self.blender(blend, "-E", "ETENDUE", "-f", "1", code=1), f"Error: {expected}")
        self.assertEqual(self.left_over(), [])

    def test_a_fault_of_the_add_on_is_an_error(self):
        blend, image = self.simple()
        said = self.blender(blend, "--python-expr", "import etendue.engine as e; e.export_scene = None", "-E", "ETENDUE", "-f", "1",
                            code=1)
        self.assertIn("Error: this is a fault of the add-on, TypeError", said)
        self.assertFalse(image.exists())

    def test_nothing_is_left_of_a_blender_that_was_killed(self):
        blend, image = self.simple("scene.etendue.samples = 1000000")
        process = self.start(blend, "-E", "ETENDUE", "-f", "1")
        for line in process.stdout:
            if "Rendering" in line:
                break
        process.kill()
        process.communicate(timeout=60)
        for _ in range(50):
            if not processes_with(str(self.temporary)):
                break
            time.sleep(0.1)
        self.assertEqual(processes_with(str(self.temporary)), [])
        self.assertEqual(len(self.left_over()), 1)
        self.blender(blend, "--python-expr", "import bpy; bpy.context.scene.etendue.samples = 1", "-E", "ETENDUE", "-f", "1")
        self.assertEqual(self.left_over(), [])

    def test_it_is_cancelled_at_once(self):
        blend, image = self.simple("scene.etendue.samples = 1000000")
        process = self.start(blend, "-E", "ETENDUE", "-f", "1")
        for line in process.stdout:
            if "Rendering" in line:
                break
        time.sleep(0.5)
        began = time.monotonic()
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        self.assertLess(time.monotonic() - began, 5.0)
        self.assertEqual(self.left_over(), [])
        self.assertEqual(processes_with(str(self.temporary)), [])


class Export(InBlender):
    def test_what_artists_do_with_objects_arrives(self):
        said = self.inside("artists", self.folder, PROGRAM)
        found = json.loads((self.folder / "answer.json").read_text())
        self.assertTrue(found["put back"], said)
        self.assertEqual((found["left"], found["mode"]), ([], "POSE"))
        self.assertEqual(sorted(found["differences"]), ["Base", "Dolly", "Kid", "KidLamp", "KidView", "Top"])
        for name, difference in found["differences"].items():
            self.assertLess(difference, 1e-5, name)
        # Sources are rendered where they are instanced alone; linked and local data are told apart.
        places = found["places"]
        self.assertEqual([places[name] for name in ("Base", "Top", "Box", "Box [library.blend]")], [2, 2, 1, 1])
        self.assertEqual(found["blue"], ["Paint [library.blend]"])
        self.assertEqual([found["material of"][name] for name in ("Box", "Box [library.blend]", "Node", "Made")],
                         ["Paint", "Paint [library.blend]", "Set", "Only"])
        self.assertEqual([found["indices"]["object_id"][name] for name in ("Box", "Box [library.blend]")], [3, 7])
        # Three cubes each; eight rows of a ring for each of its four points, with a section of four sides.
        self.assertEqual(found["triangles"], {"Monitor": 36, "Eye": 36, "Within": 36, "Ring": 256})
        self.assertEqual(found["colors"], {"Used": "VEC3", "Unused": None})
        # Each of the six faces has a green of its own at its four corners.
        self.assertEqual(found["painted"], [[0.0, 1.0 + face, 0.0] for face in range(6) for _ in range(4)])
        self.assertEqual(found["closed"], {"plane": False, "Ring": True, "Text": True})
        self.assertEqual(found["lights"], ["KidLamp", "POINT"])
        self.assertEqual(found["areas"], ["rectangle", "rectangle"])
        # Hand hangs on a bone, Top moves within its instances.
        self.assertEqual(found["moves"], ["Dolly", "Hand", "Top"])
        self.assertAlmostEqual(found["shutter"][1], 0.02 / 24.0)
        # A metre a frame from before to after, though faster at the moment; the shutter is open for 0.02 frames.
        self.assertAlmostEqual(found["way of Dolly"][0], 0.02, places=5)
        corners = [[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-7.0, -3.0)]  # of Whole and of Mesh
        self.assertEqual(found["stands"], sorted(2 * corners))
        self.assertEqual(found["notes"], ["image 'tile.1001.png': of its UDIM tiles, only the first is brought over",
                                          "instances on points, faces or particles do not move while the shutter is open: 'Own'",
                                          "instances of meshes that geometry nodes make are not brought over: 'Own'"])
        self.assertEqual(found["reason"], ["it is odd", "ValueError: odd"])


class Rest(InBlender):
    def test_the_zip_is_an_add_on(self):
        file = self.folder / "etendue.zip"
        write_zip(ROOT / "addons/blender/etendue", file)
        shutil.rmtree(self.folder / "scripts/addons/etendue")
        kept = self.folder / "kept"
        kept.mkdir()
        self.environment["ETENDUE"] = str(self.folder / "missing")
        self.assertIn(f"Etendue's files are in {kept}", self.inside("install", file, PROGRAM, kept))
        self.assertEqual(len(list(kept.iterdir())), 1)
        self.inside("install", file, PROGRAM, "")  # outside of Blender's own folder, which goes
        self.assertEqual([path.parent for path in self.temporary.rglob("etendue-*")], [self.temporary])
        self.assertTrue((self.folder / "scripts/addons/etendue/engine.py").is_file())
        names = {path.relative_to(kept).as_posix().partition("/")[2] for path in kept.rglob("*")}
        self.assertLessEqual({"scene/scene.glb", "scene/render.json", "image.exr"}, names)

    def test_panels(self):
        answer = self.folder / "answer.json"
        said = self.inside("panels", answer)
        self.assertNotIn("rror", said)
        found = json.loads(answer.read_text())
        self.assertLessEqual({"ETENDUE_RENDER_PT_sampling", "EEVEE_MATERIAL_PT_surface", "DATA_PT_lens", "EEVEE_WORLD_PT_surface",
                              "ETENDUE_LIGHT_PT_light", "DATA_PT_camera_dof"}, set(found["names"]))
        self.assertFalse([name for name in found["names"] if name.startswith(("DATA_PT_EEVEE", "DATA_PT_area", "DATA_PT_spot"))])
        self.assertEqual(found["left"], [])
        self.assertEqual(found["caustics"], {"auto": True, "path": False, "bdpt": True})

    def test_what_needs_numpy(self):
        self.inside("units")


if __name__ == "__main__":
    if PROGRAM is None or not os.access(PROGRAM, os.X_OK):
        sys.exit(__doc__)
    numpy = ["blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python-expr", "import numpy"]
    if not shutil.which("blender") or subprocess.run(numpy, env={**os.environ, "PATH": PATH}, capture_output=True).returncode:
        print("blender_render_test: Skipped\nthere is no Blender with numpy; 'apt-get install blender python3-numpy' brings them")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1] + sys.argv[2:])
