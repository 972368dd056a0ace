"""What all rows share: two steps with room for five spheres each, a large lamp and a dim sky, a camera."""

import json
import math

from ..generated_scene import GeneratedScene
from ..mesh import Mesh, mapped_sphere, panel
from ..patterns import checker
from ..vector import look_at
from .textures import HEIGHT, WIDTH

COLUMNS = 5
RADIUS, SPACING, STEP_HEIGHT, STEP_DEPTH = 0.45, 1.10, 1.15, 1.20
# Rows of a stage: the parameter as a factor behind, and from a texture in front.
UPPER, LOWER = 1, 0
BALL = mapped_sphere(RADIUS, columns=96, rows=48)

CAMERA_POSITION, CAMERA_TARGET = (0.0, 2.6, 13.0), (0.0, 1.14, -0.6)
# So large that also an integrator which finds light by chance alone finds it soon.
LAMP_SIZE, LAMP_CENTER, LAMP_TARGET = (4.0, 3.0), (-3.0, 5.5, 4.5), (0.0, 1.0, -0.5)
LAMP_RADIANCE = (5.0, 4.9, 4.7)
SKY_RADIANCE = (0.40, 0.42, 0.46)
CHECKER_CELL = 0.22  # metres


def parameter(column, low=0.0, high=1.0):
    """`low` in the first column to `high` in the last one."""
    return low + (high - low) * column / (COLUMNS - 1)


class Stage:
    """A scene under construction."""

    def __init__(self, checkered=False, lit=True):
        """`checkered` walls show what is seen through the spheres; a stage that is not `lit` has no lamp."""
        self.scene = GeneratedScene()
        self.overrides = {}
        gltf = self.scene.gltf
        texture = gltf.add_texture("checker", checker(0.55, 0.08, WIDTH, HEIGHT)) if checkered else None
        floor = gltf.add_material("floor", base_color=(0.5, 0.5, 0.5))
        wall = gltf.add_material("wall", base_color=(1.0, 1.0, 1.0) if checkered else (0.4, 0.4, 0.4),
                                 base_color_texture=texture)
        self.scene.add_object("floor", _treads(), floor)
        self.scene.add_object("wall", _walls(), wall)
        if lit:
            self._add_lamp()
        gltf.add_camera("camera", CAMERA_POSITION, look_at(CAMERA_POSITION, CAMERA_TARGET),
                        yfov=math.radians(12.3), aspect_ratio=2.0)

    def texture(self, name, png):
        return self.scene.gltf.add_texture(name, png)

    def place(self, row, column, height=0.0):
        """A point over the middle of a place on a step, `height` metres above it."""
        return ((column - 0.5 * (COLUMNS - 1)) * SPACING, row * STEP_HEIGHT + height, -row * STEP_DEPTH)

    def add_ball(self, row, column, override=None, **material):
        """A sphere on a step; `material` as of GltfWriter.add_material, `override` as of render.json."""
        # A hair above the step, which it would otherwise touch in a vertex.
        self.add_body(f"{'upper' if row == UPPER else 'lower'}-{column}", BALL,
                      self.place(row, column, RADIUS + 0.01), override, **material)

    def add_body(self, name, mesh, translation, override=None, **material):
        """A closed mesh with a material of its own."""
        material_index = self.scene.gltf.add_material(name, **material)
        self.scene.add_object(name, mesh, material_index, closed=True, translation=translation)
        if override is not None:
            self.overrides[name] = override

    def add_primitive(self, name, mesh, attributes, material, place, indices=None, **node):
        """A mesh of accessors made by hand, `indices` if they are not plain ones too. Returns its entry in the file."""
        gltf = self.scene.gltf
        primitive = {"attributes": attributes, "indices": gltf.add_indices(mesh) if indices is None else indices,
                     "material": material}
        self.scene.triangles += mesh.triangle_count
        index = gltf.add("meshes", {"name": name, "primitives": [primitive]})
        gltf.add_node(name, mesh=index, translation=place, **node)
        return gltf.document["meshes"][index]

    def finish(self, **settings):
        """The scene, with its render.json; `settings` are further members of that, None to leave one out."""
        members = {
            "integrator": {"max_depth": 24}, "spp": 256, "size": [1024, 512],
            "environment": {"color": SKY_RADIANCE}, "color": {"exposure": 0.7},
            "materials": self.overrides, **settings}
        members = {key: value for key, value in members.items() if value is not None}
        self.scene.files["render.json"] = (json.dumps(members, indent=2) + "\n").encode()
        return self.scene

    def _add_lamp(self):
        lamp = self.scene.gltf.add_material("lamp", base_color=(0.0, 0.0, 0.0), emission=LAMP_RADIANCE)
        width, height = LAMP_SIZE
        self.scene.add_object("lamp", panel(width, height), lamp, translation=LAMP_CENTER,
                              rotation=look_at(LAMP_CENTER, LAMP_TARGET))


def _treads():
    half, edge = 8.0, -0.5 * STEP_DEPTH
    mesh = Mesh()
    for y, front, back in ((0.0, half, edge), (STEP_HEIGHT, edge, edge - STEP_DEPTH)):
        mesh.add_quad(((-half, y, front), (half, y, front), (half, y, back), (-half, y, back)))
    return mesh


def _walls():
    half, edge = 8.0, -0.5 * STEP_DEPTH
    mesh = Mesh()
    for z, low, high in ((edge, 0.0, STEP_HEIGHT), (edge - STEP_DEPTH, STEP_HEIGHT, half)):
        corners = ((-half, low, z), (half, low, z), (half, high, z), (-half, high, z))
        # The checker repeats after two cells.
        mesh.add_quad(corners, [(0.5 * x / CHECKER_CELL, -0.5 * y / CHECKER_CELL) for x, y, _ in corners])
    return mesh
