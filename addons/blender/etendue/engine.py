"""The engine: one render of one view layer, from the export to the passes."""

from __future__ import annotations

import json
import shutil
import tempfile
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy
import numpy

from . import folders, passes, scene_settings
from .child import Progress, run
from .exr import Exr, read_exr
from .export import Exported, export_scene
from .exporter import ExportError
from .pixels import combined, pixels_of
from .program import ProgramError, find_program, with_names
from .properties import preferences

IMAGE, DENOISED, PREVIEW = "image.exr", "denoised.exr", "image.preview.png"


class EtendueRenderEngine(bpy.types.RenderEngine):
    bl_idname = "ETENDUE"
    bl_label = "Etendue"
    bl_use_preview = False
    bl_use_postprocess = True
    bl_use_shading_nodes_custom = False
    bl_use_eevee_viewport = True
    bl_use_exclude_layers = True
    bl_use_spherical_stereo = False

    def render(self, depsgraph: bpy.types.Depsgraph) -> None:
        try:
            self.render_layer(depsgraph)
        except (ExportError, ProgramError, OSError, ValueError) as error:
            if not self.test_break():
                self.say_error(str(error))
        except Exception as error:  # pylint: disable=broad-except
            # Blender would save a black image and end well.
            traceback.print_exc()
            self.say_error(f"this is a fault of the add-on, {type(error).__name__}: {error}")

    def say_error(self, message: str) -> None:
        self.report({"ERROR"}, message)
        self.error_set(message)

    def update_render_passes(self, scene: bpy.types.Scene, renderlayer: bpy.types.ViewLayer) -> None:
        self.register_pass(scene, renderlayer, "Combined", 4, "RGBA", "COLOR")
        try:
            for item in passes.wanted(renderlayer):
                self.register_pass(scene, renderlayer, item.name, len(item.channels), item.channels, item.kind)
        except ValueError:
            return  # the render says what is wrong

    def render_layer(self, depsgraph: bpy.types.Depsgraph) -> None:
        given = preferences()
        program = find_program(bpy.path.abspath(given.program) if given and given.program else "")
        if program is None:
            raise ProgramError("the program 'etendue' is not found: name it in the add-on's preferences or in $ETENDUE")
        named = bpy.path.abspath(given.folder) if given and given.folder else ""
        keeps = bool(given and given.keep_files)
        folders.sweep(named or bpy.app.tempdir)
        # Blender removes its own folder when it ends.
        folder = folders.make(named or bpy.app.tempdir, (named or tempfile.gettempdir()) if keeps else "")
        try:
            self.render_in(folder, depsgraph, program)
        finally:
            if keeps:
                self.report({"INFO"}, f"Etendue's files are in {folder}")
            else:
                shutil.rmtree(folder, ignore_errors=True)

    def render_in(self, folder: Path, depsgraph: bpy.types.Depsgraph, program: Path) -> None:
        scene = depsgraph.scene.original
        view_layer = scene.view_layers[depsgraph.view_layer.name]
        if scene.render.use_multiview:
            raise ExportError("stereoscopic images are not rendered: turn Stereoscopy off in the output's properties")
        self.update_stats("", "Exporting")
        exported = export_scene(scene, view_layer, depsgraph, folder / "scene", program, self.test_break, self.camera_override)
        for note in exported.notes:
            self.report({"WARNING"}, note)
        image = folder / IMAGE
        command = [program, "render", exported.folder, "-o", image, "--float", "--no-png", *exported.arguments]
        if scene.render.threads_mode == "FIXED":
            command += ["--threads", scene.render.threads]
        size = self.size_of(scene)
        if not self.run(command, exported, lambda path: self.show_preview(path, view_layer, size), folder / PREVIEW,
                        scene.etendue.preview):
            return
        if scene.etendue.denoise:
            self.update_stats("", "Denoising")
            if not self.run([program, "denoise", image, "-o", folder / DENOISED], exported):
                return
            image = folder / DENOISED
        self.show(read_exr(image), scene, view_layer, exported.indices)

    @staticmethod
    def size_of(scene: bpy.types.Scene) -> tuple[int, int]:
        window = scene_settings.border(scene.render)
        return (window[2] - window[0], window[3] - window[1]) if window else scene_settings.image_size(scene.render)

    def run(self, command: list[Any], exported: Exported, on_preview: Callable[[Path], None] = lambda _: None,
            preview: Path | None = None, every: float = 2.0) -> bool:
        """Returns whether the program has come to its end. Its messages are told with the names of Blender's objects."""
        ended = run([str(word) for word in command], self.test_break, self.show_progress, preview, on_preview, every,
                    progress=preview is not None)
        if ended.cancelled or self.test_break():
            return False
        if ended.code != 0:
            raise ProgramError(with_names(ended.error(), exported.gltf))
        for kind, text in ended.messages:
            self.report({"WARNING" if kind == "warning" else "INFO"}, with_names(text, exported.gltf))
        return True

    def show_progress(self, progress: Progress) -> None:
        words = progress.words()
        if progress.phase == "render":
            words += f" {progress.fraction:.0%}"
            self.update_progress(progress.fraction)
        # Each is a line of Blender's in the background.
        if words != getattr(self, "words", ""):
            self.words = words
            self.update_stats("", words)

    def show_preview(self, path: Path, view_layer: bpy.types.ViewLayer, size: tuple[int, int]) -> None:
        """Shows a PNG of what there is, which Blender makes linear: values end at 1 in it."""
        result = self.begin_result(0, 0, *size, layer=view_layer.name)
        try:
            result.layers[0].load_from_file(str(path))
        except RuntimeError:
            self.end_result(result, cancel=True)
            return
        self.end_result(result)

    def show(self, exr: Exr, scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer, given: dict[str, dict[str, int]]) -> None:
        """Hands all passes over. `given` has the pass indices that are not 0, by layer and name."""
        asked = passes.wanted(view_layer)
        for item in asked:
            self.add_pass(item.name, len(item.channels), item.channels, layer=view_layer.name)
        result = self.begin_result(0, 0, exr.width, exr.height, layer=view_layer.name)
        done = False
        try:
            there = {item.name: item for item in result.layers[0].passes}
            fill(there["Combined"], combined(exr, scene.render.film_transparent))
            for item in asked:
                values = pixels_of(exr, item, given)
                if values is None:
                    self.report({"WARNING"}, f"the program has not written the pass {item.name}")
                elif item.name in there:
                    fill(there[item.name], values)
            done = True
        finally:
            self.end_result(result, cancel=not done)
        self.add_mattes(self.get_result(), exr, view_layer)

    @staticmethod
    def add_mattes(result: Any, exr: Exr, view_layer: bpy.types.ViewLayer) -> None:
        """The names of Cryptomatte, by which Blender's node and other programs find its layers."""
        for attribute, name, _ in passes.MATTES:
            manifest = exr.text(f"cryptomatte/{passes.matte_key(name)}/manifest")
            if not getattr(view_layer, attribute, False) or not manifest:
                continue
            full = f"{view_layer.name}.{name}"
            for field, value in (("name", full), ("hash", "MurmurHash3_32"), ("conversion", "uint32_to_float32"),
                                 ("manifest", json.dumps(json.loads(manifest), separators=(",", ":")))):
                result.stamp_data_add_field(f"cryptomatte/{passes.matte_key(full)}/{field}", value)


def fill(item: bpy.types.RenderPass, values: numpy.ndarray) -> None:
    """Gives a pass its pixels. Blender 3.4 counts pixels, 4.3 counts numbers."""
    try:
        item.rect.foreach_set(values.ravel())
    except TypeError:
        item.rect.foreach_set(values.reshape(-1, values.shape[-1]))


def register() -> None:
    bpy.utils.register_class(EtendueRenderEngine)


def unregister() -> None:
    bpy.utils.unregister_class(EtendueRenderEngine)
