"""Etendue as a render engine of Blender."""

bl_info = {
    "name": "Etendue",
    "author": "The Etendue authors",
    "version": (0, 2, 0),
    "blender": (3, 4, 0),
    "location": "Properties > Render > Render Engine",
    "description": "Renders with Etendue, an offline path tracer",
    "category": "Render",
}


def register():
    from . import engine, panels, properties
    properties.register()
    engine.register()
    panels.register()


def unregister():
    from . import engine, panels, properties
    panels.unregister()
    engine.unregister()
    properties.unregister()
