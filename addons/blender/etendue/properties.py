"""Settings of the engine, as Blender keeps them: of scenes, of view layers, and of users."""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty, StringProperty

INTEGRATORS = (
    ("auto", "Automatic", "Path tracing, bidirectional or vertex merging: what a short pilot finds to be quickest"),
    ("path", "Path tracing", "From the camera; lights are sampled at every surface"),
    ("bdpt", "Bidirectional", "From the camera and from the lights: light through doors, simple caustics"),
    ("vcm", "Vertex merging", "Bidirectional, with merging: caustics under water, in mirrors and through glass"),
    ("light", "Light tracing", "From the lights alone: caustics on diffuse surfaces"),
    ("direct", "Direct light", "One scattering between light and camera"),
    ("naive", "Naive", "From the camera, without sampling lights: slow, and right"),
    ("hemisphere", "Hemisphere", "From the camera, with directions sampled uniformly: slower still, for teaching"),
    ("whitted", "Whitted", "Mirrors, glass and direct light, after Whitted"),
    ("albedo", "Albedo", "The colour of surfaces"),
    ("normals", "Normals", "The normals of surfaces"),
)


class EtendueSceneSettings(bpy.types.PropertyGroup):
    integrator: EnumProperty(name="Integrator", items=INTEGRATORS, default="auto", description="How light is found")
    samples: IntProperty(name="Samples", default=128, min=1, soft_max=4096, max=16777216,
                         description="Samples of each pixel; with an error to reach, the most of them")
    time: FloatProperty(name="Time Limit", default=0.0, min=0.0, unit="TIME_ABSOLUTE", step=100,
                        description="Seconds after which no new pass begins; 0 for no limit")
    error: FloatProperty(name="Error", default=0.0, min=0.0, max=1.0, precision=3,
                         description="Relative error at which the render ends: 0.05 is a clean preview, 0.01 a clean image; "
                                     "0 for none")
    adaptive: BoolProperty(name="Adaptive", default=True, description="Give each pixel as many samples as the error needs")
    min_samples: IntProperty(name="Min Samples", default=48, min=1, max=16777216,
                             description="Samples that every pixel gets before any is left out")
    seed: IntProperty(name="Seed", default=0, min=0, description="Seed of everything random")
    max_depth: IntProperty(name="Path Length", default=32, min=1, soft_max=64, max=1024,
                           description="Longest paths from camera to light, in edges; 1 is emission seen directly")
    light_samples: IntProperty(name="Light Samples", default=1, min=1, max=64,
                               description="Lights that are sampled at what the eye sees directly")
    heuristic: EnumProperty(name="Heuristic", items=(("balance", "Balance", "Weights by densities"),
                                                     ("power", "Power", "Weights by their squares")), default="balance",
                            description="How strategies of bidirectional paths are weighted")
    connections: IntProperty(name="Light Cache", default=0, min=0, max=999,
                             description="Light vertices that each eye vertex connects to, of many samples; "
                                         "0 for those of its own sample")
    merge: EnumProperty(name="Merge", items=(("sds", "Between Mirrors", "Only what no connection finds"),
                                             ("all", "All", "At every rough surface"), ("none", "None", "No merging")),
                        default="sds", description="Where eye paths take light from photons")
    merge_radius: FloatProperty(name="Radius", default=1.5, min=0.01, max=100.0,
                                description="How far photons count in the first sample, in pixels; later samples take less")
    clamp_indirect: FloatProperty(name="Clamp Indirect", default=0.0, min=0.0,
                                  description="Largest contribution of indirect light: fewer fireflies, and light is missing; "
                                              "0 for no limit")
    robust: IntProperty(name="Median of Means", default=1, min=1, max=31,
                        description="Parts of the samples whose means the median is taken of, against fireflies; "
                                    "1 for the plain mean")
    denoise: BoolProperty(name="Denoise", default=False, description="Take out the noise when the image is finished")
    filter: EnumProperty(name="Pixel Filter", items=(("blackman-harris", "Blackman-Harris", "Smooth, without ringing"),
                                                     ("box", "Box", "Each pixel its own samples"),
                                                     ("gaussian", "Gaussian", "Smooth and wide"),
                                                     ("mitchell", "Mitchell", "Sharp, with negative parts")),
                         default="blackman-harris", description="How samples make pixels")
    filter_radius: FloatProperty(name="Radius", default=0.0, min=0.0, max=8.0,
                                 description="Radius of the pixel filter in pixels, at least 0.1; "
                                             "0 for that filter's own")
    working_space: EnumProperty(name="Working Space", items=(
        ("REC709", "Linear Rec.709", "The space that Cycles computes in"),
        ("ACESCG", "ACEScg", "The space that the program computes in by itself: saturated colours mix otherwise")),
        default="REC709", description="Space in which light is computed; what comes back is in linear Rec.709")
    shutter_position: EnumProperty(name="Shutter Position", items=(
        ("START", "Start on Frame", "It opens at the frame"), ("CENTER", "Center on Frame", "The frame is in its middle"),
        ("END", "End on Frame", "It closes at the frame")), default="CENTER",
        description="Where the frame lies in the shutter's time")
    preview: FloatProperty(name="Preview Every", default=2.0, min=0.2, max=3600.0, unit="TIME_ABSOLUTE",
                           description="Seconds between two images while the render goes on")


class EtendueViewLayerSettings(bpy.types.PropertyGroup):
    use_pass_volume: BoolProperty(name="Volume", description="Passes VolumeDir and VolumeInd")
    use_pass_albedo: BoolProperty(name="Albedo", description="Share of light that surfaces scatter")
    use_pass_caustics: BoolProperty(name="Caustics", description="Diffuse surfaces lit through glass or by way of mirrors")
    use_pass_samples: BoolProperty(name="Samples", description="Samples of each pixel")
    layers: StringProperty(name="Layers", description="More layers, such as: key=light:Key; glass=lpe:C T .* L")


class EtenduePreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: StringProperty(name="Program", subtype="FILE_PATH",
                            description="The program 'etendue'; if this is empty, it is looked for")
    keep_files: BoolProperty(name="Keep Files", default=False,
                             description="Keep the folders with the exported scenes and images, and say where they are")
    folder: StringProperty(name="Temporary Folder", subtype="DIR_PATH",
                           description="Where these folders are made; if this is empty, in Blender's temporary folder")

    def draw(self, _context: bpy.types.Context) -> None:
        from .program import find_program
        layout = self.layout
        layout.prop(self, "program")
        found = find_program(bpy.path.abspath(self.program) if self.program else "")
        layout.label(text=f"Found: {found}" if found else "No program found", icon="CHECKMARK" if found else "ERROR")
        layout.prop(self, "folder")
        layout.prop(self, "keep_files")


CLASSES = (EtendueSceneSettings, EtendueViewLayerSettings, EtenduePreferences)


def preferences() -> EtenduePreferences | None:
    """The user's; None where the add-on runs without being enabled, as in tests."""
    addon = bpy.context.preferences.addons.get(__package__)
    return addon.preferences if addon else None


def register() -> None:
    for item in CLASSES:
        bpy.utils.register_class(item)
    bpy.types.Scene.etendue = PointerProperty(type=EtendueSceneSettings)
    bpy.types.ViewLayer.etendue = PointerProperty(type=EtendueViewLayerSettings)


def unregister() -> None:
    del bpy.types.ViewLayer.etendue
    del bpy.types.Scene.etendue
    for item in reversed(CLASSES):
        bpy.utils.unregister_class(item)
