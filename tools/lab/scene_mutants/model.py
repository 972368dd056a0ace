"""Models in memory: the JSON of a scene and of its render.json, and the files beside them."""

import base64
import json
import os
import shutil
import struct
import subprocess
import sys
from pathlib import Path
from urllib.parse import unquote

ROOT = Path(__file__).resolve().parents[3]
GLB, JSON_CHUNK, BINARY_CHUNK = 0x46546C67, 0x4E4F534A, 0x004E4942
LARGEST = 1 << 20  # bytes of a base with all its files
DATA_URI = "data:application/octet-stream;base64,"


class Literal(str):
    """Text that stands in JSON as it is."""


class Pairs(list):
    """Members of an object, [key, value] each, some of which may have one key."""


def json_text(value):
    """JSON of `value`, in which `Literal` and `Pairs` may occur; characters that are no text are escaped."""
    if isinstance(value, Literal):
        return str(value)
    if isinstance(value, (dict, Pairs)):
        members = value.items() if isinstance(value, dict) else value
        return "{" + ",".join(f"{json.dumps(key)}:{json_text(one)}" for key, one in members) + "}"
    if isinstance(value, list):
        return "[" + ",".join(map(json_text, value)) + "]"
    return json.dumps(value)


class Model:
    """One scene. `files` holds what lies beside `main`, by relative path; `binary` is the chunk of a GLB."""

    def __init__(self, name, main, document, settings, files, binary=None):
        self.name, self.main = name, main
        self.document, self.settings, self.files, self.binary = document, settings, dict(files), binary
        self.damage = []  # functions of the bytes of the scene file, applied when it is written

    def copy(self):
        return Model(self.name, self.main, json.loads(json.dumps(self.document)), json.loads(json.dumps(self.settings)),
                     self.files, self.binary)

    def buffer(self, index):
        """The bytes of a buffer; None if it has none that can be found."""
        uri = self._buffer_uri(index)
        if uri is None:
            return self.binary if index == 0 else None
        if uri.startswith("data:"):
            try:
                return base64.b64decode(uri.partition(",")[2])
            except ValueError:
                return None
        return self.files.get(unquote(uri))

    def set_buffer(self, index, data):
        uri = self._buffer_uri(index)
        if uri is None:
            self.binary = data
        elif uri.startswith("data:"):
            self.document["buffers"][index]["uri"] = DATA_URI + base64.b64encode(data).decode()
        else:
            self.files[unquote(uri)] = data

    def _buffer_uri(self, index):
        uri = at(self.document, "buffers", index, "uri")
        return uri if isinstance(uri, str) else None

    def _scene_bytes(self):
        text = json_text(self.document).encode()
        if self.main.endswith(".glb"):
            text += b" " * (-len(text) % 4)
            chunks = struct.pack("<II", len(text), JSON_CHUNK) + text
            if self.binary is not None:
                binary = self.binary + bytes(-len(self.binary) % 4)
                chunks += struct.pack("<II", len(binary), BINARY_CHUNK) + binary
            text = struct.pack("<III", GLB, 2, 12 + len(chunks)) + chunks
        for change in self.damage:
            text = change(text)
        return text

    def write(self, folder):
        for name, data in self.files.items():
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
        folder.mkdir(parents=True, exist_ok=True)
        (folder / self.main).write_bytes(self._scene_bytes())
        (folder / "render.json").write_text(json_text(self.settings), encoding="utf-8")


def at(value, *path):
    """What is at a path of keys and indices; None if nothing is."""
    for key in path:
        try:
            value = value[key]
        except (KeyError, IndexError, TypeError):
            return None
    return value


def read_glb(data):
    """JSON and binary chunk."""
    (size,) = struct.unpack_from("<I", data, 12)
    text, rest = data[20:20 + size], data[20 + size:]
    return json.loads(text), rest[8:8 + struct.unpack_from("<I", rest)[0]] if rest else None


def files_beside(document, folder):
    """Those that buffers, images and profiles name, by relative path."""
    found, uris = {}, []

    def look(value):
        for key, one in value.items() if isinstance(value, dict) else enumerate(value):
            if key == "uri" and isinstance(one, str):
                uris.append(one)
            elif isinstance(one, (dict, list)):
                look(one)

    look(document)
    for uri in uris:
        path = folder / unquote(uri)
        if not uri.startswith("data:") and path.is_file():
            found[unquote(uri)] = path.read_bytes()
    return found


def read_model(path, folder_name):
    """The model of a scene file with its render.json; None if it is no base: not JSON, or large."""
    data, binary = path.read_bytes(), None
    try:
        document, binary = read_glb(data) if path.suffix == ".glb" else (json.loads(data), None)
    except (ValueError, struct.error):
        return None
    if not isinstance(document, dict):
        return None
    settings_file = path.parent / "render.json"
    settings = json.loads(settings_file.read_text()) if settings_file.is_file() else {}
    files = files_beside(document, path.parent)
    for name in (at(settings, "environment", "image"), *(at(light, "ies") for light in settings.get("lights", {}).values())):
        if isinstance(name, str):
            files[name] = (path.parent / name).read_bytes()
    if len(data) + sum(map(len, files.values())) > LARGEST:
        return None
    settings = {key: value for key, value in settings.items() if key not in ("crop", "frames", "scene")}
    return Model(f"{folder_name}/{path.name}", "scene" + path.suffix, document, settings, files, binary)


def models_below(folder, prefix):
    """All models below `folder` that may serve as bases, in an order that is the same everywhere."""
    paths = sorted(path for path in folder.rglob("*") if path.suffix in (".gltf", ".glb"))
    models = (read_model(path, f"{prefix}/{path.parent.relative_to(folder)}") for path in paths)
    return [model for model in models if model is not None]


def generated_models(encoder, scratch):
    """The scenes of scenes/ and the rows of materials, which use every extension that is rendered."""
    environment = {**os.environ, "ETENDUE_ENCODE_GLTF": str(encoder)}
    for program, folder in (("make_scenes.py", "scenes"), ("make_material_rows.py", "rows")):
        subprocess.run([sys.executable, "-B", ROOT / "tools/gen" / program, "-o", scratch / folder], check=True,
                       env=environment, stdout=subprocess.DEVNULL)
    for settings in sorted((ROOT / "scenes").glob("*/render.json")):
        shutil.copy(settings, scratch / "scenes" / settings.parent.name)
    return models_below(scratch / "scenes", "scenes") + models_below(scratch / "rows", "rows")


def seeds_of_fuzzing():
    """Small models of the fuzzer, each with all files that lie beside its inputs."""
    beside = {path.name: path.read_bytes() for path in sorted((ROOT / "tests/fuzz/beside").iterdir())}
    models = models_below(ROOT / "tests/fuzz/corpus", "corpus")
    for model in models:
        model.files.update(beside)
    return models
