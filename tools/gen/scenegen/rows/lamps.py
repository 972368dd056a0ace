"""A row of spheres under every kind of lamp that a glTF file can bring, in the light of a cube map of its own."""

from ..images import png, to_srgb_byte
from ..vector import look_at
from .stage import COLUMNS, LOWER, UPPER, Stage, parameter

FACE_SIDE = 16
# Candela at 0, 15, 30, 45 and 60 degrees from the axis: a ring of light around a dimmer middle.
PROFILE = b"""IESNA:LM-63-2002
TILT=NONE
1 -1 1 5 1 1 2 0 0 0
1 1 0
0 15 30 45 60
0
4 10 30 12 0
"""


def lamps():
    """A measured lamp on the left, a point in the middle, a spot on the right; one sphere more is not visible."""
    stage = Stage(lit=False)
    gltf = stage.scene.gltf
    for column in range(COLUMNS):
        stage.add_ball(UPPER, column, base_color=(0.7, 0.7, 0.7), roughness=parameter(column, 0.3, 1.0))
        stage.add_ball(LOWER, column, base_color=(0.6, 0.2 + 0.1 * column, 0.6 - 0.1 * column))
    stage.scene.files["lamp.ies"] = PROFILE
    gltf.use_extension("EXT_lights_ies")
    gltf.use_extension("KHR_lights_punctual")
    gltf.use_extension("EXT_lights_image_based")
    gltf.use_extension("KHR_node_visibility")
    extensions = gltf.document.setdefault("extensions", {})
    extensions["EXT_lights_ies"] = {"lights": [{"uri": "lamp.ies"}]}
    extensions["KHR_lights_punctual"] = {"lights": [
        {"type": "point", "color": [1.0, 0.8, 0.6], "intensity": 4.0},
        {"type": "spot", "color": [0.6, 0.8, 1.0], "intensity": 25.0,
         "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.35}}]}
    for name, place, target, light in (
            ("measured", (-2.0, 2.6, 1.0), (-1.6, 0.0, 0.0), {"EXT_lights_ies": {"light": 0, "multiplier": 0.6}}),
            ("bulb", (0.0, 2.9, 1.2), (0.0, 0.0, 0.0), {"KHR_lights_punctual": {"light": 0}}),
            ("spot", (2.6, 3.2, 2.0), (1.7, 0.8, -0.6), {"KHR_lights_punctual": {"light": 1}})):
        gltf.add_node(name, translation=place, rotation=look_at(place, target), extensions=light)
    extensions["EXT_lights_image_based"] = {"lights": [{
        "intensity": 0.4, "specularImageSize": FACE_SIDE,
        "irradianceCoefficients": [[0.3, 0.3, 0.3]] + [[0.0, 0.0, 0.0]] * 8,
        "specularImages": [[_face(gltf, shade) for shade in (0.1, 0.2, 0.9, 0.05, 0.5, 0.3)]]}]}
    gltf.document["scenes"][0]["extensions"] = {"EXT_lights_image_based": {"light": 0}}
    stage.add_ball(LOWER, 2, base_color=(1.0, 0.0, 1.0))
    hidden = gltf.document["nodes"][-1]
    hidden["translation"] = [0.0, 1.0, 2.0]
    hidden["extensions"] = {"KHR_node_visibility": {"visible": False}}
    return stage.finish(environment=None)


def _face(gltf, shade):
    """A face of the cube map: a ramp of bluish light that ends at `shade`."""
    def texel(x, y):
        value = shade * (1.0 + x + y) / (2.0 * FACE_SIDE)
        return [to_srgb_byte(c * value) for c in (0.7, 0.9, 1.0)]

    pixels = bytes(c for y in range(FACE_SIDE) for x in range(FACE_SIDE) for c in texel(x, y))
    return gltf.add_image(f"face {shade}", png(FACE_SIDE, FACE_SIDE, pixels))
