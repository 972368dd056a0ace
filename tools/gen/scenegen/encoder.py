"""The codecs of glTF's compressed meshes, by tools/gen/encode_gltf.cpp, which the build makes."""

import os
import subprocess
from pathlib import Path

DEFAULT_PROGRAM = Path(__file__).resolve().parents[3] / "build" / "release" / "bin" / "encode_gltf"


def encode(data, codec, *arguments):
    """`data` (bytes) as `codec` has it. ETENDUE_ENCODE_GLTF names the program; else it is that of the release build."""
    program = Path(os.environ.get("ETENDUE_ENCODE_GLTF", DEFAULT_PROGRAM))
    if not program.exists():
        raise SystemExit(f"{program} does not exist; build the target encode_gltf, or name another program in "
                         "ETENDUE_ENCODE_GLTF")
    return subprocess.run([program, codec, *map(str, arguments)], input=data, stdout=subprocess.PIPE, check=True).stdout
