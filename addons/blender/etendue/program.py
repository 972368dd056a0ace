"""The program: where it is, what it knows, and what its messages mean. Needs nothing of Blender."""

from __future__ import annotations

import copy
import json
import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

PROGRAM = "etendue"
# Prefixes that `cmake --install` is usually given.
PREFIXES = ("/usr/local", "/usr", "/opt/etendue", "~/.local")
UNKNOWN = re.compile(r"^unknown key|there is no source '")
# Places in messages, `scene.glb#/nodes/3/mesh: `.
PLACE = re.compile(r"[^\s()'\"]*#/(nodes|meshes|materials|cameras|images|textures)/(\d+)[^\s()'\"]*?(?=[:,\s()'\"]|$)")
# The folder of the exported scene and of its image, of which users know nothing.
FOLDER = re.compile(r"[^\s()'\"]*/(?=(render\.json|scene\.glb|image\.exr|denoised\.exr)\b)")
KINDS = {"nodes": "object", "meshes": "mesh", "materials": "material", "cameras": "camera", "images": "image",
         "textures": "texture"}
MOST_ROUNDS = 4  # an unknown object hides its keys, which are told of in the next round

Document = dict[str, Any]


def find_program(preference: str = "", environment: Mapping[str, str] = os.environ,
                 package: Path | None = None) -> Path | None:
    """The first that is there: the preference, $ETENDUE, the prefix that this add-on is installed in, the path, prefixes."""
    if preference:
        return executable(Path(os.path.expanduser(preference)))
    if environment.get("ETENDUE"):
        return executable(Path(environment["ETENDUE"]))
    # PREFIX/share/etendue/blender/etendue
    own = (package or Path(__file__).resolve().parent).parents
    candidates = [own[3] / "bin" / PROGRAM] if len(own) > 3 else []
    found = shutil.which(PROGRAM, path=environment.get("PATH"))
    candidates += [Path(found)] if found else []
    candidates += [Path(prefix).expanduser() / "bin" / PROGRAM for prefix in PREFIXES]
    return next((program for program in map(executable, candidates) if program), None)


def executable(path: Path) -> Path | None:
    """The file, or the program in the folder, if it can be run."""
    if path.is_dir():
        path = path / PROGRAM
    return path.resolve() if path.is_file() and os.access(path, os.X_OK) else None


def child_environment(environment: Mapping[str, str] = os.environ) -> dict[str, str]:
    """The environment of the program: without $OCIO, since colour spaces are named as its own config has them."""
    return {name: value for name, value in environment.items() if name != "OCIO"}


def stub_scene(document: Document) -> Document:
    """A glTF document with the names that render.json has, and nothing to render."""
    return {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"name": "stub"}],
            "materials": [{"name": name} for name in document.get("materials", {})]}


def unknown_pointers(program: Path, document: Document) -> list[str]:
    """JSON pointers of the keys and layers that the program does not know."""
    with tempfile.TemporaryDirectory(prefix="etendue-keys-") as folder:
        (Path(folder) / "scene.gltf").write_text(json.dumps(stub_scene(document)), encoding="utf-8")
        (Path(folder) / "render.json").write_text(json.dumps(document), encoding="utf-8")
        try:
            done = subprocess.run([str(program), "inspect", folder, "--json"], capture_output=True, text=True, check=False,
                                  env=child_environment(), timeout=60)
        except subprocess.TimeoutExpired:
            raise ProgramError(f"'{program} inspect' has not come to its end in a minute") from None
    try:
        problems = json.loads(done.stdout)["problems"]
    except (ValueError, KeyError):
        raise ProgramError(f"'{program} inspect' ended with {done.returncode}: {done.stderr.strip()[-500:]}") from None
    errors = [problem for problem in problems
              if problem["severity"] == "error" and problem["file"].endswith("render.json")]
    return [error["pointer"] for error in errors if UNKNOWN.search(error["message"])]


class ProgramError(Exception):
    """The program cannot be run, or has ended otherwise than it should."""


def words_of(pointer: str) -> list[str]:
    """The keys of a JSON pointer."""
    return [word.replace("~1", "/").replace("~0", "~") for word in pointer.split("/")[1:]]


def without(document: Document, pointers: Iterable[str]) -> tuple[Document, list[str]]:
    """The document without these places, and which of them were taken out, in words. A lamp or a camera whose type is
    unknown is no such thing, and goes as a whole; what is empty then goes, too."""
    result, dropped = copy.deepcopy(document), []
    # From the last to the first, so that places in lists stay what they are.
    for pointer in sorted(set(pointers), key=sort_key, reverse=True):
        words = words_of(pointer)
        if words[0] == "lights" and words[-1] in ("type", "node") and len(words) == 3:
            words = words[:2]
        taken = take_out(result, words)
        if taken is not None:
            dropped.append(f"{words[0]}: {taken}" if words[-1].isdigit() else ".".join(words))
    for section in ("lights", "materials", "cameras", "objects"):
        entries = result.get(section)
        if isinstance(entries, dict):
            for name in [name for name, entry in entries.items() if entry == {}]:
                del entries[name]
        if entries == {}:
            del result[section]
    # Entries that go as a whole are told of once.
    return result, sorted(name for name in dropped if not any(name.startswith(f"{other}.") for other in dropped))


def sort_key(pointer: str) -> tuple[str, int]:
    head, _, last = pointer.rpartition("/")
    return (head, int(last)) if last.isdigit() else (pointer, -1)


def take_out(document: Any, words: list[str]) -> Any:
    """Removes a place from objects and lists, and returns what was there, or None."""
    for word in words[:-1]:
        document = step(document, word)
    if isinstance(document, list) and words[-1].isdigit() and int(words[-1]) < len(document):
        return document.pop(int(words[-1]))
    return document.pop(words[-1], None) if isinstance(document, dict) else None


def step(document: Any, word: str) -> Any:
    if isinstance(document, list):
        return document[int(word)] if word.isdigit() and int(word) < len(document) else None
    return document.get(word) if isinstance(document, dict) else None


def known_part(program: Path, document: Document) -> tuple[Document, list[str]]:
    """The part of render.json that this program knows, and what of it is dropped."""
    dropped: list[str] = []
    for _ in range(MOST_ROUNDS):
        pointers = unknown_pointers(program, document)
        document, more = without(document, pointers)
        if not more:
            break
        dropped += more
    return document, sorted(dropped)


def with_names(message: str, gltf: Document) -> str:
    """The message with the names that Blender has for places of the glTF file."""
    def named(match: re.Match[str]) -> str:
        kind, number = match.group(1), int(match.group(2))
        items = gltf.get(kind, [])
        name = items[number].get("name", "") if number < len(items) else ""
        if kind == "meshes" and number < len(items):
            users = [node.get("name", "") for node in gltf.get("nodes", []) if node.get("mesh") == number]
            if users:
                return f"object '{users[0]}'"
        return f"{KINDS[kind]} '{name}'" if name else match.group(0)
    return FOLDER.sub("", PLACE.sub(named, message))


def messages_of(stderr: str) -> list[tuple[str, str]]:
    """Splits what the program has said into kinds (`error`, `warning`, `note`) and texts. Lines that go on belong to the one before;
    those that begin with a path tell of files that were written."""
    found: list[tuple[str, str]] = []
    for line in stderr.splitlines():
        match = re.match(r"(?:\S+: )?(error|warning|note): (.*)", line)
        if match:
            found.append((match.group(1), match.group(2)))
        elif found and line.strip() and not line.startswith("/"):
            found[-1] = (found[-1][0], f"{found[-1][1]}\n{line.strip()}")
    return found
