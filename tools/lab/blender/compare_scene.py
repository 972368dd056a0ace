"""Runs inside Blender: builds one scene, renders it with Cycles and with Etendue, and writes the mean of each object and how
far pixels differ.

blender -b --factory-startup --addons etendue --python compare_scene.py -- SCENE FOLDER WIDTHxHEIGHT SAMPLES"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import bpy
import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from blender import scenes  # noqa: E402
from etendue.exr import read_exr  # noqa: E402


def render(scene, path):
    """The image and, of Cycles, the pass indices."""
    scene.render.image_settings.file_format = "OPEN_EXR_MULTILAYER"
    scene.render.image_settings.color_depth = "32"
    scene.render.image_settings.exr_codec = "ZIP"
    scene.render.use_compositing = scene.render.use_sequencer = False
    scene.render.filepath = str(path)
    path.unlink(missing_ok=True)
    bpy.ops.render.render(write_still=True)
    channels = read_exr(path).channels
    image = numpy.stack([channels[f"ViewLayer.Combined.{letter}"] for letter in "RGB"], axis=-1)
    return image.astype(numpy.float64), channels.get("ViewLayer.IndexOB.X")


def main():
    name, folder, size, samples = sys.argv[sys.argv.index("--") + 1:]
    folder, size = Path(folder), tuple(map(int, size.split("x")))
    scene = scenes.build(name, size)
    bpy.context.view_layer.use_pass_object_index = True
    scenes.set_cycles(scene, int(samples))
    theirs, indices = render(scene, folder / f"{name}-cycles.exr")
    bpy.context.view_layer.use_pass_object_index = False
    scenes.set_etendue(scene, int(samples))
    ours, _ = render(scene, folder / f"{name}-etendue.exr")
    brightness = max(theirs.mean(), 1e-6)

    def far(mask):
        """Returns the root mean square of the differences of these pixels, over the mean of Cycles' whole image."""
        return float(numpy.sqrt(numpy.square(ours[mask] - theirs[mask]).mean()) / brightness)

    objects = {item.pass_index: item.name for item in bpy.data.objects if item.pass_index > 0}
    rows = {}
    for index, label in sorted(objects.items()) + [(0, "background")]:
        mask = numpy.rint(indices) == index
        if mask.sum() >= 16:
            rows[label] = {"pixels": int(mask.sum()), "cycles": theirs[mask].mean(axis=0).tolist(),
                           "etendue": ours[mask].mean(axis=0).tolist(), "pixel_difference": far(mask)}
    everywhere = numpy.ones(indices.shape, bool)
    (folder / f"{name}.json").write_text(json.dumps({"blender": bpy.app.version_string, "objects": rows,
                                                     "pixel_difference": far(everywhere)}))


if __name__ == "__main__":
    main()
