"""Runs inside Blender for blender_render_test.py: a function by its name, with words from the command line."""

import json
import os
import sys
from pathlib import Path

import bpy
import numpy

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tools/lab"), str(ROOT / "tests/addons")]

from blender import scenes  # noqa: E402


def output(scene, path):
    settings = scene.render.image_settings
    settings.file_format, settings.color_depth, settings.exr_codec = "OPEN_EXR_MULTILAYER", "32", "ZIP"
    scene.render.filepath = str(path)


def save(name, blend, image, samples):
    """A .blend of one of the scenes, with passes, for the command line to render."""
    scene = scenes.build(name, (96, 72))
    scenes.set_cycles(scene, int(samples))
    scene.render.engine = "CYCLES"
    scene.etendue.samples = int(samples)
    mist = scene.world.mist_settings
    mist.start, mist.depth, mist.falloff = 7.0, 6.0, "INVERSE_QUADRATIC"
    layer = bpy.context.view_layer
    for flag in ("use_pass_z", "use_pass_mist", "use_pass_object_index", "use_pass_material_index", "use_pass_normal", "use_pass_position", "use_pass_uv", "use_pass_diffuse_direct",
                 "use_pass_diffuse_indirect", "use_pass_diffuse_color", "use_pass_glossy_direct", "use_pass_glossy_indirect",
                 "use_pass_transmission_direct", "use_pass_transmission_indirect", "use_pass_emit", "use_pass_environment",
                 "use_pass_cryptomatte_object"):
        setattr(layer, flag, True)
    layer.etendue.use_pass_samples = True
    layer.etendue.layers = "sun=light:Sun"
    output(scene, image)
    bpy.ops.wm.save_as_mainfile(filepath=blend)


def save_simple(blend, image, change):
    """A ball under a sky; `change` is a line of Python."""
    scene = scenes.build("world_color", (64, 48))
    scene.etendue.samples = 4
    output(scene, image)
    exec(change, {"bpy": bpy, "scene": scene, "numpy": numpy})  # pylint: disable=exec-used
    bpy.ops.wm.save_as_mainfile(filepath=blend)


def matte(image):
    """Writes what the compositor's Cryptomatte node makes of the engine's layers as the image: the matte of the ball."""
    scene = scenes.build("world_color", (64, 48))
    scenes.set_etendue(scene, 16)
    bpy.context.view_layer.use_pass_cryptomatte_object = True
    scene.use_nodes = True
    tree = scene.node_tree
    composite = next(node for node in tree.nodes if node.type == "COMPOSITE")
    node = tree.nodes.new("CompositorNodeCryptomatteV2")
    bpy.ops.render.render()  # after which the node knows the layers and the names in them
    node.matte_id = "Ball"
    tree.links.new(node.outputs["Matte"], composite.inputs["Image"])
    settings = scene.render.image_settings
    settings.file_format, settings.color_depth, settings.exr_codec = "OPEN_EXR", "32", "ZIP"
    scene.render.filepath = image
    bpy.ops.render.render(write_still=True)


def previews(answer):
    """Writes the means of all images that are shown while one is rendered, the last of which is the image itself."""
    import etendue.engine
    scene = scenes.build("world_color", (64, 48))
    scenes.set_etendue(scene, 20000)
    scene.etendue.time, scene.etendue.preview = 3.0, 0.3
    bpy.context.scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.5  # below 1 everywhere
    means, kind = [], etendue.engine.EtendueRenderEngine

    def watched(show):
        def show_and_tell(self, *words):
            show(self, *words)
            rect = next(item.rect for item in self.get_result().layers[0].passes if item.name == "Combined")
            means.append(numpy.array(rect)[:, :3].mean(axis=0).tolist())
        return show_and_tell

    kind.show_preview, kind.show = watched(kind.show_preview), watched(kind.show)
    bpy.ops.render.render()
    Path(answer).write_text(json.dumps(means))


def panels(answer):
    """Writes which panels are drawn with the engine, and which of them stay when it goes."""
    import addon_utils
    bpy.context.scene.render.engine = "ETENDUE"

    def ours():
        return [panel for panel in bpy.types.Panel.__subclasses__() if "ETENDUE" in getattr(panel, "COMPAT_ENGINES", ())]

    names = sorted(panel.__name__ for panel in ours())
    addon_utils.disable("etendue")
    left = [panel.__name__ for panel in ours() if panel.is_registered]
    addon_utils.enable("etendue")
    Path(answer).write_text(json.dumps({"names": names, "left": left}))


def files(blend, answer):
    """Writes what the files of a scene have, and the notes."""
    from etendue import export, glb
    bpy.ops.wm.open_mainfile(filepath=blend)
    scene, layer = bpy.context.scene, bpy.context.view_layer
    folder = Path(answer).parent / "files"
    exported = export.export_scene(scene, layer, bpy.context.evaluated_depsgraph_get(), folder, Path(os.environ["ETENDUE"]))
    document = glb.read_glb(folder / "scene.glb")[0]
    used = {document["materials"][primitive["material"]]["name"] for node in document["nodes"] if "mesh" in node
            for primitive in document["meshes"][node["mesh"]]["primitives"]}
    Path(answer).write_text(json.dumps({
        "render": json.loads((folder / "render.json").read_text()), "notes": exported.notes, "used": sorted(used),
        "materials": {material["name"]: material for material in document["materials"]}}))


def install(file, program, folder):
    """Installs a zip as users do, and renders with the preferences that they can set."""
    bpy.ops.preferences.addon_install(filepath=file)
    bpy.ops.preferences.addon_enable(module="etendue")
    preferences = bpy.context.preferences.addons["etendue"].preferences
    preferences.program, preferences.folder, preferences.keep_files = program, folder, True
    scene = bpy.context.scene
    scene.render.engine, scene.etendue.samples = "ETENDUE", 1
    scene.render.resolution_x = scene.render.resolution_y = 16
    bpy.ops.render.render()


def units():
    """The tests that need no Blender, with the numpy of Blender."""
    import unittest
    import blender_addon_test
    import blender_nodes_test
    for module in (blender_addon_test, blender_nodes_test):
        if not unittest.TextTestRunner(verbosity=0).run(unittest.defaultTestLoader.loadTestsFromModule(module)).wasSuccessful():
            sys.exit(1)


if __name__ == "__main__":
    name, *words = sys.argv[sys.argv.index("--") + 1:]
    globals()[name](*words)
