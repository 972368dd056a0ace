"""A row of spheres that come in every way a mesh can."""

import math
from array import array

from ..gltf import BYTE, FLOAT, SHORT
from ..mesh import mapped_sphere
from . import textures
from .stage import BALL, COLUMNS, LOWER, RADIUS, UPPER, Stage

VARIANT = "painted"


def geometry():
    """Quantised, instanced, morphed, of another variant's material, without normals; five texture transforms."""
    stage = Stage()
    gltf = stage.scene.gltf
    gray = gltf.add_material("gray", base_color=(0.5, 0.5, 0.5), roughness=0.4)
    red = gltf.add_material("red", base_color=(0.7, 0.1, 0.05), roughness=0.4)
    for column, make in enumerate((_quantized, _instanced, _morphed, _varied, _flat)):
        make(stage, stage.place(UPPER, column, RADIUS + 0.01), gray, red)
    bands = stage.texture("bands", textures.color_bands())
    for column, transform in enumerate((
            {}, {"offset": [0.1, 0.3]}, {"rotation": 0.6}, {"scale": [3.0, 0.7]},
            {"offset": [0.2, 0.1], "rotation": -0.9, "scale": [2.0, 1.5]})):
        texture = {"index": bands, "extensions": {"KHR_texture_transform": transform}}
        stage.add_ball(LOWER, column, roughness=0.5, base_color_texture=texture)
    gltf.use_extension("KHR_texture_transform")
    scene = stage.finish(variant=VARIANT)
    assert len(scene.gltf.document["meshes"]) >= 2 * COLUMNS
    return scene


def _quantized(stage, place, gray, _):
    """Positions of 16 bits and normals of 8, both normalised."""
    gltf = stage.scene.gltf
    gltf.use_extension("KHR_mesh_quantization", required=True)
    positions = array("h", (round(32767 * p / RADIUS) for p in BALL.positions))
    normals = array("b", (round(127 * n) for n in BALL.normals))
    # Vertices start at multiples of 4 bytes.
    attributes = {"POSITION": gltf.add_accessor(positions, SHORT, "VEC3", with_bounds=True, normalized=True, stride=8),
                  "NORMAL": gltf.add_accessor(normals, BYTE, "VEC3", normalized=True, stride=4)}
    stage.add_primitive("quantized", BALL, attributes, gray, place, scale=(RADIUS, RADIUS, RADIUS))


def _instanced(stage, place, gray, _):
    """Eight of half the size at the corners of a cube, every other one flattened."""
    gltf = stage.scene.gltf
    gltf.use_extension("EXT_mesh_gpu_instancing", required=True)
    corners = [(x, y, z) for x in (-0.22, 0.22) for y in (-0.22, 0.22) for z in (-0.22, 0.22)]
    translations = array("f", (c for corner in corners for c in corner))
    scales = array("f", (s for i in range(8) for s in (0.45, 0.2 if i % 2 else 0.45, 0.45)))
    attributes = {"TRANSLATION": gltf.add_accessor(translations, FLOAT, "VEC3"),
                  "SCALE": gltf.add_accessor(scales, FLOAT, "VEC3")}
    stage.add_primitive("instanced", BALL, _smooth(gltf), gray, place,
                        extensions={"EXT_mesh_gpu_instancing": {"attributes": attributes}})


def _morphed(stage, place, gray, _):
    """Half way to a body with a waist."""
    gltf = stage.scene.gltf
    target = array("f")
    for i in range(0, len(BALL.positions), 3):
        x, y, z = BALL.positions[i:i + 3]
        waist = -0.8 * math.cos(3.0 * y / RADIUS) ** 2
        target.extend((waist * x, 0.0, waist * z))
    mesh = stage.add_primitive("morphed", BALL, _smooth(gltf), gray, place)
    mesh["primitives"][0]["targets"] = [{"POSITION": gltf.add_accessor(target, FLOAT, "VEC3", with_bounds=True)}]
    mesh["weights"] = [0.5]


def _varied(stage, place, gray, red):
    """Gray in the file's own state, red in the variant that is shown."""
    gltf = stage.scene.gltf
    gltf.use_extension("KHR_materials_variants")
    gltf.document.setdefault("extensions", {})["KHR_materials_variants"] = {
        "variants": [{"name": "bare"}, {"name": VARIANT}]}
    mesh = stage.add_primitive("varied", BALL, _smooth(gltf), gray, place)
    mesh["primitives"][0]["extensions"] = {
        "KHR_materials_variants": {"mappings": [{"material": red, "variants": [1]}]}}


def _flat(stage, place, gray, _):
    """Without normals: every triangle of it is flat."""
    gltf = stage.scene.gltf
    coarse = mapped_sphere(RADIUS, columns=12, rows=6)
    positions = {"POSITION": gltf.add_accessor(coarse.positions, FLOAT, "VEC3", with_bounds=True)}
    stage.add_primitive("flat", coarse, positions, gray, place)


def _smooth(gltf):
    return {"POSITION": gltf.add_accessor(BALL.positions, FLOAT, "VEC3", with_bounds=True),
            "NORMAL": gltf.add_accessor(BALL.normals, FLOAT, "VEC3")}
