"""A scene of so many triangles that a file of it has no place among the scenes: a matte height field under an even sky."""

import json
import struct
import subprocess
import sys
from pathlib import Path

MAKER = Path(__file__).resolve().parents[3] / "tests/bench/make_large_glb.py"
TRIANGLES = 2_300_000
MATERIAL = "ground"


def parts_of(glb):
    """The document and the buffer of a GLB that has one of each."""
    contents = glb.read_bytes()
    length, = struct.unpack_from("<I", contents, 12)
    return json.loads(contents[20:20 + length]), contents[20 + length + 8:]


def make_height_field(folder, triangles=TRIANGLES):
    """Leaves it as a scene directory, unless it is there."""
    if (folder / "render.json").exists():
        return
    folder.mkdir(parents=True, exist_ok=True)
    glb = folder / "large.glb"
    subprocess.run([sys.executable, "-B", MAKER, glb, "--triangles", str(triangles)], check=True, stdout=subprocess.DEVNULL)
    document, buffer = parts_of(glb)
    glb.unlink()
    document["materials"] = [{"name": MATERIAL, "pbrMetallicRoughness": {"metallicFactor": 0.0}}]
    document["meshes"][0]["primitives"][0]["material"] = 0
    # What is told apart by name has to have one.
    document["cameras"][0]["name"] = document["nodes"][-1]["name"] = "camera"
    document["buffers"][0]["uri"] = "scene.bin"
    (folder / "scene.bin").write_bytes(buffer)
    (folder / "scene.gltf").write_text(json.dumps(document))
    # Last: where it is, everything is.
    (folder / "render.json").write_text(json.dumps({
        "integrator": {"max_depth": 16}, "environment": {"color": [1, 1, 1]},
        "materials": {MATERIAL: {"diffuse": {"albedo": [0.6, 0.5, 0.4]}}}}))
