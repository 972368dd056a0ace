"""Blender's passes and the layers of the program that they are. Needs nothing of Blender."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

# Changes of the numbers on their way: none; Y up to Z up; over the diffuse albedo; that albedo, white where light has none; ones;
# V up, and whether there is anything; Blender's pass index in place of the program's number.
AS_IS, TO_Z_UP, OVER_ALBEDO, ALBEDO, WHITE, UV, INDEX = (
    "as is", "to z up", "over albedo", "albedo", "white", "uv", "index")


@dataclass(frozen=True)
class Pass:
    """A pass of a view layer: Blender's name, channels and kind; the layer of the program, and the channels that it has."""

    name: str
    channels: str
    kind: str
    source: str
    layer: str = ""
    letters: str = ""
    change: str = AS_IS

    def names(self) -> list[str]:
        """The channels of the EXR, in the order of the pass."""
        return [f"{self.layer or self.source}.{letter}" for letter in self.letters or self.channels]


# Attribute of the view layer, pass. Diffuse light comes over its colour, as Blender's compositor has it.
STANDARD = (
    ("use_pass_z", Pass("Depth", "Z", "VALUE", "depth")),
    ("use_pass_mist", Pass("Mist", "Z", "VALUE", "mist")),
    ("use_pass_position", Pass("Position", "XYZ", "VECTOR", "P", change=TO_Z_UP)),
    ("use_pass_normal", Pass("Normal", "XYZ", "VECTOR", "N", change=TO_Z_UP)),
    ("use_pass_vector", Pass("Vector", "XYZW", "VECTOR", "vector")),
    ("use_pass_object_index", Pass("IndexOB", "X", "VALUE", "object_id", change=INDEX)),
    ("use_pass_material_index", Pass("IndexMA", "X", "VALUE", "material_id", change=INDEX)),
    ("use_pass_uv", Pass("UV", "UVA", "VECTOR", "uv", letters="UV", change=UV)),
    ("use_pass_diffuse_direct", Pass("DiffDir", "RGB", "COLOR", "diffuse_direct", change=OVER_ALBEDO)),
    ("use_pass_diffuse_indirect", Pass("DiffInd", "RGB", "COLOR", "diffuse_indirect", change=OVER_ALBEDO)),
    ("use_pass_diffuse_color", Pass("DiffCol", "RGB", "COLOR", "albedo_diffuse", change=ALBEDO)),
    ("use_pass_glossy_direct", Pass("GlossDir", "RGB", "COLOR", "specular_direct")),
    ("use_pass_glossy_indirect", Pass("GlossInd", "RGB", "COLOR", "specular_indirect")),
    ("use_pass_glossy_color", Pass("GlossCol", "RGB", "COLOR", "", change=WHITE)),
    ("use_pass_transmission_direct", Pass("TransDir", "RGB", "COLOR", "transmission_direct")),
    ("use_pass_transmission_indirect", Pass("TransInd", "RGB", "COLOR", "transmission_indirect")),
    ("use_pass_transmission_color", Pass("TransCol", "RGB", "COLOR", "", change=WHITE)),
    ("use_pass_emit", Pass("Emit", "RGB", "COLOR", "emission")),
    ("use_pass_environment", Pass("Env", "RGB", "COLOR", "background")),
)
# Attribute of the view layer's `etendue`.
OWN = (
    ("use_pass_volume", Pass("VolumeDir", "RGB", "COLOR", "volume_direct")),
    ("use_pass_volume", Pass("VolumeInd", "RGB", "COLOR", "volume_indirect")),
    ("use_pass_albedo", Pass("Albedo", "RGB", "COLOR", "albedo")),
    ("use_pass_caustics", Pass("Caustics", "RGB", "COLOR", "caustics")),
    ("use_pass_samples", Pass("Samples", "X", "VALUE", "samples")),
)
MATTES = (("use_pass_cryptomatte_object", "CryptoObject", "cryptomatte_object"),
          ("use_pass_cryptomatte_material", "CryptoMaterial", "cryptomatte_material"),
          ("use_pass_cryptomatte_asset", "CryptoAsset", "cryptomatte_asset"))
# Passes of Blender's that this add-on does not offer.
BLENDERS = ("AO", "Shadow", "SubsurfaceDir", "SubsurfaceInd", "SubsurfaceCol", "Denoising Normal", "Denoising Albedo",
            "Debug Sample Count")
EXTRA = re.compile(r"^([A-Za-z0-9_-]{1,100})=((?:lpe|light):.+)$")


def is_taken(name: str) -> bool:
    """Returns whether Blender or this add-on has a pass of that name."""
    own = {item.name for _, item in (*STANDARD, *OWN)} | {"Combined", *BLENDERS}
    return name in own or any(re.fullmatch(rf"{matte}\d\d", name) for _, matte, _ in MATTES)


def extra_layers(text: str) -> Iterator[Pass]:
    """Layers of the user's, such as `key=light:Key; glass=lpe:C T .* L`."""
    names: set[str] = set()
    for item in filter(None, (item.strip() for item in text.split(";"))):
        match = EXTRA.match(item)
        if match is None:
            raise ValueError(f"'{item}' is no layer: write NAME=lpe:EXPRESSION or NAME=light:NAME")
        if is_taken(match.group(1)) or match.group(1) in names:
            raise ValueError(f"the layer '{item}' has the name of another pass: give it a name of its own")
        names.add(match.group(1))
        yield Pass(match.group(1), "RGB", "COLOR", item, layer=match.group(1))


def wanted(view_layer: Any) -> list[Pass]:
    """All passes of the view layer but the image itself."""
    result = [item for attribute, item in STANDARD if getattr(view_layer, attribute, False)]
    own = view_layer.etendue
    result += [item for attribute, item in OWN if getattr(own, attribute, False)]
    result += extra_layers(own.layers)
    pairs = (min(16, view_layer.pass_cryptomatte_depth) + 1) // 2
    for attribute, name, source in MATTES:
        if getattr(view_layer, attribute, False):
            names = [f"{name}{number:02d}" for number in range(pairs)]
            result += [Pass(layer, "rgba", "COLOR", f"{source}:{2 * pairs}", layer, "RGBA") for layer in names]
    return result


def sources(passes: list[Pass], denoise: bool) -> list[str]:
    """The layers that the program is to write for these passes."""
    result = [item.source for item in passes if item.source]
    if any(item.change == OVER_ALBEDO for item in passes):
        result.append("albedo_diffuse")
    if any(item.change == UV for item in passes):
        result.append("depth")
    if denoise:
        result.append("denoising")
    return list(dict.fromkeys(result))


def matte_key(name: str) -> str:
    """The key of a Cryptomatte in metadata: seven digits of MurmurHash3 (32 bits) of its name."""
    return f"{murmur3(name.encode()):08x}"[:7]


def murmur3(data: bytes, seed: int = 0) -> int:
    """A. Appleby's MurmurHash3_x86_32."""
    def rotated(value: int, bits: int) -> int:
        return (value << bits | value >> 32 - bits) & 0xFFFFFFFF

    state = seed
    for begin in range(0, len(data), 4):
        block = data[begin:begin + 4]
        mixed = int.from_bytes(block, "little") * 0xCC9E2D51 & 0xFFFFFFFF
        state ^= rotated(mixed, 15) * 0x1B873593 & 0xFFFFFFFF
        if len(block) == 4:
            state = rotated(state, 13) * 5 + 0xE6546B64 & 0xFFFFFFFF
    state ^= len(data)
    for shift, factor in ((16, 0x85EBCA6B), (13, 0xC2B2AE35)):
        state = (state ^ state >> shift) * factor & 0xFFFFFFFF
    return state ^ state >> 16
