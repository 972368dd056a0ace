"""Panels of the engine, and those of Blender that it shares."""

from __future__ import annotations

from collections.abc import Iterator

import bpy

ENGINE = "ETENDUE"
# Beginnings of the names of Blender's panels for all engines that show what this one does not look at.
NOT_OURS = ("VIEWLAYER_PT_filter", "VIEWLAYER_PT_layer_passes", "VIEWLAYER_PT_freestyle", "RENDER_PT_simplify",
            "RENDER_PT_freestyle", "RENDER_PT_stereoscopy", "RENDER_PT_gpencil", "DATA_PT_camera_stereoscopy",
            "MATERIAL_PT_freestyle", "DATA_PT_light", "DATA_PT_area", "DATA_PT_spot", "DATA_PT_falloff_curve")
# Panels of Eevee's and Cycles' that show what this engine reads.
SHARED = {"EEVEE_MATERIAL_PT_context_material", "EEVEE_MATERIAL_PT_surface", "EEVEE_WORLD_PT_surface",
          "MATERIAL_PT_preview", "DATA_PT_camera_dof", "DATA_PT_camera_dof_aperture"}


class RenderPanel:
    """Shares place and layout among the panels of the engine."""

    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    COMPAT_ENGINES = {ENGINE}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.engine in cls.COMPAT_ENGINES

    def column(self) -> bpy.types.UILayout:
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        return self.layout.column()


class ETENDUE_RENDER_PT_sampling(RenderPanel, bpy.types.Panel):
    bl_label = "Sampling"

    def draw(self, context: bpy.types.Context) -> None:
        settings, column = context.scene.etendue, self.column()
        column.prop(settings, "integrator")
        column.prop(settings, "samples")
        column.prop(settings, "time")
        column.prop(settings, "error")
        limits = column.column()
        limits.active = settings.error > 0.0
        limits.prop(settings, "adaptive")
        limits.prop(settings, "min_samples")
        column.prop(settings, "denoise")
        column.prop(settings, "seed")


class ETENDUE_RENDER_PT_paths(RenderPanel, bpy.types.Panel):
    bl_label = "Light Paths"

    def draw(self, context: bpy.types.Context) -> None:
        settings, column = context.scene.etendue, self.column()
        column.prop(settings, "max_depth")
        if settings.integrator in ("path", "direct"):
            column.prop(settings, "light_samples")
        column.prop(settings, "clamp_indirect")
        column.prop(settings, "robust")


class ETENDUE_RENDER_PT_caustics(RenderPanel, bpy.types.Panel):
    bl_label = "Caustics"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.scene.etendue.integrator in ("auto", "bdpt", "vcm")

    def draw(self, context: bpy.types.Context) -> None:
        settings, column = context.scene.etendue, self.column()
        column.prop(settings, "heuristic")
        column.prop(settings, "connections")
        if settings.integrator in ("auto", "vcm"):
            column.prop(settings, "merge")
            column.prop(settings, "merge_radius")


class ETENDUE_RENDER_PT_film(RenderPanel, bpy.types.Panel):
    bl_label = "Film"

    def draw(self, context: bpy.types.Context) -> None:
        scene, column = context.scene, self.column()
        column.prop(scene.etendue, "filter")
        column.prop(scene.etendue, "filter_radius")
        column.prop(scene.render, "film_transparent")
        column.prop(scene.etendue, "working_space")
        column.prop(scene.etendue, "preview")


class ETENDUE_RENDER_PT_motion_blur(RenderPanel, bpy.types.Panel):
    bl_label = "Motion Blur"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context: bpy.types.Context) -> None:
        self.layout.prop(context.scene.render, "use_motion_blur", text="")

    def draw(self, context: bpy.types.Context) -> None:
        scene, column = context.scene, self.column()
        column.active = scene.render.use_motion_blur
        column.prop(scene.etendue, "shutter_position")
        column.prop(scene.render, "motion_blur_shutter")


class ETENDUE_RENDER_PT_stereoscopy(RenderPanel, bpy.types.Panel):
    bl_label = "Stereoscopy"
    bl_context = "output"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.scene.render.use_multiview

    def draw(self, context: bpy.types.Context) -> None:
        column = self.column()
        column.label(text="Renders fail while this is on", icon="ERROR")
        column.prop(context.scene.render, "use_multiview", text="Stereoscopy")


class ETENDUE_VIEWLAYER_PT_layer(RenderPanel, bpy.types.Panel):
    bl_label = "Override"
    bl_context = "view_layer"

    def draw(self, context: bpy.types.Context) -> None:
        layer, column = context.view_layer, self.column()
        column.prop(layer, "material_override")
        if hasattr(layer, "world_override"):
            column.prop(layer, "world_override")
        column.prop(layer, "samples")
        column.prop(layer, "use_sky", text="Environment")
        column.prop(layer, "use_motion_blur", text="Motion Blur")


class ETENDUE_VIEWLAYER_PT_passes(RenderPanel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context: bpy.types.Context) -> None:
        from .passes import MATTES, OWN, STANDARD
        layer, column = context.view_layer, self.column()
        for name in dict.fromkeys(name for name, _ in STANDARD):
            column.prop(layer, name)
        for name in dict.fromkeys(name for name, _ in OWN):
            column.prop(layer.etendue, name)
        column.separator()
        for name, _, _ in MATTES:
            column.prop(layer, name)
        column.prop(layer, "pass_cryptomatte_depth")
        column.separator()
        column.prop(layer.etendue, "layers")


class ETENDUE_OBJECT_PT_visibility(RenderPanel, bpy.types.Panel):
    bl_label = "Visibility"
    bl_context = "object"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        item, column = context.object, self.column()
        column.prop(item, "hide_render", text="Show in Renders", invert_checkbox=True)
        column.prop(item, "visible_camera", text="Camera")
        column.prop(item, "is_shadow_catcher")
        column.prop(item, "is_holdout")
        if hasattr(getattr(item, "cycles", None), "use_motion_blur"):
            column.prop(item.cycles, "use_motion_blur", text="Motion Blur")


class WorldPanel(RenderPanel):
    """A panel of the scene's world, shown if there is one."""

    bl_context = "world"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.world is not None


class ETENDUE_WORLD_PT_visibility(WorldPanel, bpy.types.Panel):
    bl_label = "Visibility"

    def draw(self, context: bpy.types.Context) -> None:
        world, column = context.world, self.column()
        for owner, name in ((world, "visible_camera"), (getattr(world, "cycles_visibility", None), "camera")):
            if hasattr(owner, name):
                column.prop(owner, name, text="Camera")
                break


class ETENDUE_WORLD_PT_mist(WorldPanel, bpy.types.Panel):
    bl_label = "Mist Pass"

    def draw(self, context: bpy.types.Context) -> None:
        column = self.column()
        for name in ("start", "depth", "falloff"):
            column.prop(context.world.mist_settings, name)


class ETENDUE_LIGHT_PT_light(RenderPanel, bpy.types.Panel):
    bl_label = "Light"
    bl_context = "data"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.light is not None

    def draw(self, context: bpy.types.Context) -> None:
        light = context.light
        self.layout.row().prop(light, "type", expand=True)
        column = self.column()
        column.prop(light, "color")
        column.prop(light, "energy")
        names = {"POINT": ("shadow_soft_size",), "SPOT": ("shadow_soft_size", "spot_size", "spot_blend", "show_cone"),
                 "SUN": ("angle",), "AREA": ("shape", "size", "spread")}[light.type]
        for name in ("exposure", *names):
            if hasattr(light, name):
                column.prop(light, name)
            if name == "size" and light.shape in ("RECTANGLE", "ELLIPSE"):
                column.prop(light, "size_y")


class ETENDUE_CAMERA_PT_panorama(RenderPanel, bpy.types.Panel):
    bl_label = "Panorama"
    bl_context = "data"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and getattr(context.camera, "type", "") == "PANO"

    def draw(self, context: bpy.types.Context) -> None:
        column = self.column()
        owner = next((owner for owner in (context.camera, getattr(context.camera, "cycles", None))
                      if hasattr(owner, "panorama_type")), None)
        if owner is None:
            column.label(text="Equirectangular")
            return
        column.prop(owner, "panorama_type")
        if "FISHEYE" in owner.panorama_type:
            column.prop(owner, "fisheye_fov")
            if owner.panorama_type == "FISHEYE_EQUISOLID":
                column.prop(owner, "fisheye_lens")


CLASSES = (ETENDUE_RENDER_PT_sampling, ETENDUE_RENDER_PT_paths, ETENDUE_RENDER_PT_caustics, ETENDUE_RENDER_PT_film,
           ETENDUE_RENDER_PT_motion_blur, ETENDUE_RENDER_PT_stereoscopy, ETENDUE_VIEWLAYER_PT_layer, ETENDUE_VIEWLAYER_PT_passes,
           ETENDUE_OBJECT_PT_visibility, ETENDUE_WORLD_PT_visibility, ETENDUE_WORLD_PT_mist, ETENDUE_LIGHT_PT_light,
           ETENDUE_CAMERA_PT_panorama)


def shared_panels() -> Iterator[type]:
    """Blender's panels that are to be shown with this engine, too."""
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", ())
        if panel.__name__ in SHARED or ("BLENDER_RENDER" in engines and not panel.__name__.startswith(NOT_OURS)):
            yield panel


def register() -> None:
    for item in CLASSES:
        bpy.utils.register_class(item)
    for panel in shared_panels():
        panel.COMPAT_ENGINES.add(ENGINE)


def unregister() -> None:
    for panel in shared_panels():
        panel.COMPAT_ENGINES.discard(ENGINE)
    for item in reversed(CLASSES):
        bpy.utils.unregister_class(item)
