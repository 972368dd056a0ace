"""Materials: the entries of `materials` of render.json, and what is to change of them in the GLB. Needs nothing of Blender."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

from . import textures, volumes
from .nodes import VERTICES, Seen, active_output, behind, place, places
from .written import Document, Written

OLD_SHEEN, OLD_SHEEN_ROUGHNESS = 0.2, 0.3
BLACK, GREY, WHITE = [0.0] * 3, [0.8] * 3, [1.0] * 3
COLOR, TRANSMISSION = ("Base Color",), ("Transmission Weight", "Transmission")
EMISSION = ("Emission Color", "Emission")
# Names of factors, those of inputs, and values of the Principled BSDF.
FACTORS = (("metallic", ("Metallic",), 0.0), ("roughness", ("Roughness",), 0.5), ("transmission", TRANSMISSION, 0.0))
# Other inputs, of which only constants are brought over.
CONSTANTS = (("IOR",), ("Sheen Weight", "Sheen"), ("Sheen Tint",), ("Sheen Roughness",), ("Thin Film Thickness",),
             ("Thin Film IOR",), ("Anisotropic Rotation",), ("Tangent",))
GLOSSY = ("BSDF_GLOSSY", "BSDF_ANISOTROPIC")
BODY = 0.85  # least coverage at which a body without transparency is nearer to Cycles than a transparent sheet


def clamped(color: Any) -> list[float]:
    return [min(max(channel, 0.0), 1.0) for channel in color]


def diffuse_of(albedo: list[float]) -> Document:
    return {"diffuse": {"albedo": albedo}}


def material(material: Any, closed: bool, written: Written, whole: bool = False, name: str = "",
             with_groups: bool = False) -> Document:
    """The entry of `materials`: what the exporter drops of the Principled BSDF, and what can be read of other shaders.
    `closed`: all meshes that have it bound a volume; `whole`: the exporter has not seen the material; `name`: that in the
    file, where it is another; `with_groups`: the exporter sees what groups have."""
    if not material.use_nodes or material.node_tree is None:
        return diffuse_of(clamped(list(material.diffuse_color)[:3]))
    output = active_output(material.node_tree, "OUTPUT_MATERIAL")
    seen = {} if whole else exported(material.node_tree, with_groups)
    reader = Reader(name or material.name, closed, written, seen)
    if output is None:
        return reader.nothing("it has no output")
    ends = Seen(output)
    if ends.source("Displacement") is not None:
        reader.note("its displacement is not brought over")
    shader, volume = ends.source("Surface"), ends.source("Volume")
    if shader is not None:
        if getattr(material, "blend_method", "") == "CLIP":
            written.blended.add(reader.name)
        result = reader.surface(shader)
        reader.notes_of_textures(shader)
        settings = getattr(material, "cycles", None)
        if reader.name in written.blended and not getattr(settings, "use_transparent_shadow", True):
            reader.note("its shadow is as transparent as itself, though Transparent Shadows are off")
        reader.strip()
        return reader.filled(result, volume) if volume is not None else result
    reader.strip()
    return reader.nothing("it has no surface") if volume is None else reader.fog(volume)


def exported(tree: Any, with_groups: bool) -> dict[str, tuple[str, ...]]:
    """Returns where the Principled BSDF and the Emission are that the exporter takes: the first of each that leads to the
    active output, be it Eevee's and whatever is mixed."""
    outputs = [node for node in tree.nodes if node.type == "OUTPUT_MATERIAL" and node.is_active_output]
    behind_them = [seen for node in outputs for seen in textures.all_behind(Seen(node))]
    result = {}
    for kind in ("BSDF_PRINCIPLED", "EMISSION"):
        here = {place(seen) for seen in behind_them if seen.type == kind}
        first = next((at for at in places(tree, with_groups) if at in here), None)
        if first is not None:
            result[kind] = first
    return result


@dataclass
class Reader:
    """Reads the shaders of one material, which has this name in the file. `exported` has the places of those of which the
    exporter has written inputs, by their kinds, and `kept` the kinds that are read."""

    name: str
    closed: bool
    written: Written
    exported: dict[str, tuple[str, ...]]
    kept: set[str] = field(default_factory=set)

    def takes(self, shader: Seen) -> bool:
        """Returns whether the exporter has written the shader's inputs, which then stay in the file."""
        if self.exported.get(shader.type) != place(shader):
            return False
        self.kept.add(shader.type)
        return True

    def strip(self) -> None:
        """Has the file lose what the exporter has written of shaders that are not shown."""
        lost = set(self.exported) - self.kept
        if "BSDF_PRINCIPLED" in lost:
            self.written.bare.add(self.name)
        # Where there is an Emission, the exporter drops the light of the Principled BSDF.
        if ("EMISSION" if "EMISSION" in self.exported else "BSDF_PRINCIPLED") in lost:
            self.written.dark.add(self.name)

    def note(self, text: str) -> None:
        self.written.note(f"material '{self.name}': {text}")

    def nothing(self, why: str) -> Document:
        self.note(f"{why}, and is black as in Cycles")
        return diffuse_of(BLACK)

    def notes_of_textures(self, shader: Seen) -> None:
        exported = [self.exported[kind] for kind in self.kept]
        for text in textures.notes(shader, self.written.textures.get(self.name), exported):
            self.note(text)

    # --- what is in the way of shaders

    def surface(self, shader: Seen | None) -> Document:
        """The entry for a shader of any kind."""
        if shader is None:
            return diffuse_of(BLACK)
        known = {"BSDF_PRINCIPLED": self.principled, "EMISSION": self.emission, "MIX_SHADER": self.mix,
                 "ADD_SHADER": self.add, "BSDF_TRANSPARENT": self.transparent, "BSDF_DIFFUSE": self.diffuse,
                 "BSDF_TRANSLUCENT": self.translucent, "BSDF_GLASS": self.glass, "BSDF_REFRACTION": self.glass,
                 "SUBSURFACE_SCATTERING": self.wax, "HOLDOUT": self.holdout, **{kind: self.glossy for kind in GLOSSY}}
        self.written.shown.setdefault(self.name, []).append(shader)
        if shader.type in known:
            return known[shader.type](shader)
        self.note(f"its node '{shader.name}' is not brought over, and shown as a diffuse surface")
        return self.lambert(shader) if shader.socket("Color") is not None else diffuse_of(GREY)

    def mix(self, shader: Seen) -> Document:
        """One of two shaders: with transparency as coverage, with emission as its share of it, else the heavier one."""
        share, sides = shader.value(0), [shader.source(1), shader.source(2)]
        if share is not None and not 0.0 < share < 1.0:
            return self.surface(sides[int(share >= 1.0)])
        kinds = ["" if side is None else side.type for side in sides]
        if kinds.count("BSDF_TRANSPARENT") == 1:
            return self.covered(shader, share, sides, kinds.index("BSDF_TRANSPARENT"))
        factor = shader.source(0)
        seen_by_camera = factor is not None and factor.type == "LIGHT_PATH" and factor.output.name == "Is Camera Ray"
        chosen = sides[int(seen_by_camera if share is None else share > 0.5)]
        self.note(f"of its node '{shader.name}', only '{chosen.name if chosen is not None else 'black'}' is brought over")
        if share is not None and kinds.count("EMISSION") == 1:
            at = kinds.index("EMISSION")
            return self.lit(self.surface(sides[1 - at]), sides[at], share if at == 1 else 1.0 - share)
        return self.surface(chosen)

    def covered(self, mix: Seen, share: float | None, sides: list[Seen | None], clear: int) -> Document:
        """A shader that is mixed with transparency: a constant, or the alpha of its own image."""
        rest = sides[1 - clear]
        result = self.surface(rest)
        if share is not None:
            coverage = share if clear == 0 else 1.0 - share
            self.cover(coverage)
            return self.thin(result, coverage)
        if clear == 0 and rest is not None and "diffuse" not in result and self.masks(mix.source(0), rest):
            return self.thin(result)
        if clear != 0 or not textures.has_no_alpha(mix.source(0)):
            self.note(f"what is linked to the factor of its node '{mix.name}' is not brought over: "
                      "nothing is transparent")
        return result

    def thin(self, result: Document, coverage: float | None = None) -> Document:
        """Makes a body a sheet if its coverage is low, or an image (None): the renderer does not look at the alpha of
        bodies."""
        if "solid" in result and (coverage is None or coverage < BODY):
            del result["solid"]
            self.note("it is partly transparent, and shown as a thin sheet, which does not bend light")
        elif ("solid" in result and coverage < 1.0) or "subsurface" in result:
            self.note("it is a body, and no part of a body is transparent")
        return result

    def masks(self, mask: Seen | None, shader: Seen) -> bool:
        """Returns whether a node is the alpha of the image that the shader has as its colour, which then counts."""
        own = behind(shader.source(*COLOR, "Color"), "TEX_IMAGE")
        return mask is not None and own is not None and mask.type == "TEX_IMAGE" and mask.output.name == "Alpha" \
            and mask.node.image == own.node.image and not textures.has_no_alpha(mask) and self.fetch(own, True)

    def add(self, shader: Seen) -> Document:
        """A shader and the light of another one; else the first of two."""
        sides = [shader.source(0), shader.source(1)]
        shining = [side for side in sides if side is not None and side.type == "EMISSION"]
        others = [side for side in sides if side is not None and side.type != "EMISSION"]
        if len(shining) == 1 and others:
            return self.lit(self.surface(others[0]), shining[0])
        both = others or shining
        if len(both) == 2:
            self.note(f"of its node '{shader.name}', only '{both[0].name}' is brought over")
        return self.surface(both[0] if both else None)

    # --- shaders of one lobe

    def color(self, shader: Seen, *names: str) -> list[float]:
        """The constant colour of an input; white if the GLB gets the image that is linked to it, or has vertex colours."""
        color = shader.value(*names)
        if color is not None:
            return clamped(color)
        texture = behind(shader.source(*names), "TEX_IMAGE")
        if (texture is not None and self.fetch(texture)) or behind(shader.source(*names), *VERTICES) is not None:
            return WHITE
        self.note(f"what is linked to the colour of '{shader.name}' is not brought over")
        return GREY

    def lambert(self, shader: Seen) -> Document:
        """A diffuse surface; where the GLB has its colour, one of glTF's factors, by which that is multiplied."""
        color = self.color(shader, "Color")
        if shader.value("Color") is None and color is WHITE:
            return {"base_color": WHITE, "metallic": 0.0, "roughness": 1.0, "specular": 0.0}
        return diffuse_of(color)

    def fetch(self, texture: Seen, with_alpha: bool = False) -> bool:
        """Has the GLB get the image, and returns whether there is one."""
        if texture.node.image is None:
            return False
        self.written.textures[self.name] = textures.laid(texture, with_alpha)
        return True

    def number(self, shader: Seen, *names: str, default: float) -> float:
        """The constant number of an input with one of these names, `default` where something else is linked to it."""
        value = shader.value(*names, default=default)
        if value is None:
            self.note(f"what is linked to '{shader.socket(*names).name}' of '{shader.name}' is not brought over")
        return default if value is None else value

    def roughness(self, shader: Seen, default: float) -> float:
        if getattr(shader.node, "distribution", "") == "SHARP":
            return 0.0
        return min(max(self.number(shader, "Roughness", default=default), 0.0), 1.0)

    def flat(self, shader: Seen) -> None:
        if shader.is_linked("Normal"):
            self.note(f"the normals of '{shader.name}' are not brought over")

    def diffuse(self, shader: Seen) -> Document:
        self.flat(shader)
        result, rough = self.lambert(shader), self.roughness(shader, 0.0)
        if "diffuse" in result and rough > 0.0:
            result["diffuse"]["roughness"] = rough
        return result

    def glossy(self, shader: Seen) -> Document:
        self.flat(shader)
        result = {"base_color": self.color(shader, "Color"), "metallic": 1.0, "roughness": self.roughness(shader, 0.5)}
        stretch = min(max(self.number(shader, "Anisotropy", default=0.0), -0.99), 0.99)
        if stretch == 0.0 or result["roughness"] == 0.0:
            return result
        if shader.is_linked("Tangent"):
            self.note(f"the tangent of '{shader.name}' is not brought over")
        # This lobe is wide across the tangent, and that of the Principled BSDF along it; negative anisotropy turns it.
        turn = self.number(shader, "Rotation", default=0.0) + (0.25 if stretch > 0.0 else 0.0)
        return result | stretched(1.0 - abs(stretch), result["roughness"], turn)

    def glass(self, shader: Seen) -> Document:
        self.flat(shader)
        if shader.type == "BSDF_REFRACTION":
            self.note(f"its node '{shader.name}' reflects, too, as glass does")
        ior = self.number(shader, "IOR", default=1.45)
        if ior < 1.0:
            self.note("an index of refraction below 1 is not brought over")
        return {"base_color": self.color(shader, "Color"), "metallic": 0.0, "roughness": self.roughness(shader, 0.0),
                "transmission": 1.0, "ior": max(ior, 1.0), **({"solid": True} if self.closed else {})}

    def translucent(self, shader: Seen) -> Document:
        self.flat(shader)
        return {"base_color": BLACK, "metallic": 0.0, "roughness": 1.0, "specular": 0.0, "diffuse_transmission": 1.0,
                "diffuse_transmission_color": clamped(shader.value("Color") or self.unread(shader, "Color"))}

    def unread(self, shader: Seen, name: str) -> list[float]:
        self.note(f"what is linked to '{name}' of '{shader.name}' is not brought over")
        return GREY

    def cover(self, alpha: float) -> None:
        """Multiplies the alpha that the exporter has."""
        self.written.blended.add(self.name)
        self.written.alphas[self.name] = self.written.alphas.get(self.name, 1.0) * min(max(alpha, 0.0), 1.0)

    def transparent(self, shader: Seen) -> Document:
        color = clamped(shader.value("Color") or self.unread(shader, "Color"))
        if max(color) - min(color) > 0.01:
            self.note(f"the tint of '{shader.name}' is not brought over")
        self.cover(1.0 - sum(color) / 3.0)
        return diffuse_of(BLACK)

    def holdout(self, _: Seen) -> Document:
        return diffuse_of(BLACK) | {"holdout": True}

    def emission(self, shader: Seen) -> Document:
        return diffuse_of(BLACK) | self.shine(shader)

    def lit(self, result: Document, shader: Seen, share: float = 1.0) -> Document:
        """A surface with the light of an Emission in place of its own."""
        own = result.pop("emission", {})
        if any(own.get("color", ())) and own.get("strength", 1.0) > 0.0:
            self.note(f"beside the light of '{shader.name}', that of the surface is not brought over")
        return result | self.shine(shader, share)

    def shine(self, shader: Seen, share: float = 1.0) -> Document:
        """The light of an Emission; where its colour has an image, the exporter has the light."""
        color, strength, taken = shader.value("Color"), shader.value("Strength"), self.takes(shader)
        if color is None:
            self.cut_at_one(shader.source("Color"))
            if behind(shader.source("Color"), "TEX_IMAGE") is not None and taken and strength != 0.0:
                least = 1.0 if strength is None else max(strength, 0.0)
                return {} if share == 1.0 else {"emissive": WHITE, "emissive_strength": share * least}
            self.note(f"what is linked to the colour of '{shader.name}' is not brought over")
            color = BLACK
        if strength is None:
            self.note(f"what is linked to the strength of '{shader.name}' is not brought over")
            strength = 1.0
        return {"emission": {"color": [max(channel, 0.0) for channel in color], "strength": max(strength * share, 0.0)}}

    def cut_at_one(self, color: Seen | None) -> None:
        texture = behind(color, "TEX_IMAGE")
        if texture is not None and getattr(texture.node.image, "is_float", False):
            self.note(f"the image '{texture.node.image.name}' gives light of up to 1 alone: the exporter cuts it")

    def wax(self, shader: Seen) -> Document:
        radius, scale = shader.value("Radius"), shader.value("Scale", default=1.0)
        color = shader.value("Color")
        if not self.closed or radius is None or scale is None or color is None:
            self.note(f"its node '{shader.name}' is brought over on closed meshes without textures, else shown as a diffuse surface")
            return self.diffuse(shader)
        return body(color, radius, scale, 0.5, 1.4, shader.value("Anisotropy", default=0.0) or 0.0)

    # --- the Principled BSDF

    def principled(self, shader: Seen) -> Document:
        taken = self.takes(shader)
        alpha = shader.value("Alpha", default=1.0)
        if alpha is None and textures.has_no_alpha(shader.source("Alpha")):
            alpha = 1.0
            if taken:
                self.written.opaque.add(self.name)
                self.written.blended.discard(self.name)
        if taken and (alpha is None or alpha < 1.0):
            self.written.blended.add(self.name)
        self.check_normals(shader, taken)
        self.cut_at_one(shader.source(*EMISSION))
        for names in CONSTANTS:
            if shader.is_linked(*names):
                self.number(shader, *names, default=0.0)
        wax = self.subsurface(shader)
        if wax is not None:
            return wax if alpha == 1.0 else self.thin(wax, alpha)
        result = self.unseen(shader) if taken else self.all_of(shader)
        transmission = result.get("transmission", shader.value(*TRANSMISSION, default=0.0))
        if transmission is None or transmission > 0.0:
            if self.closed:
                result = self.thin(result | {"solid": True}, alpha)
            ior = shader.value("IOR", default=1.45)
            if ior is not None:
                result["ior"] = max(ior, 1.0)
            color = shader.value(*COLOR)
            # Since Blender 4.0, light has the colour once it has passed two of its surfaces.
            if self.closed and transmission == 1.0 and color and shader.socket("Transmission Weight") is not None:
                result["base_color"] = [math.sqrt(channel) for channel in clamped(color)]
            result |= self.rough_inside(shader, transmission)
        if shader.socket("Clearcoat") is not None:
            coat = shader.value("Clearcoat")
            if coat is None or coat > 0.0:
                # Blender before 4.0 shows a quarter of it.
                result["clearcoat"] = 0.25 * (result.get("clearcoat", 1.0) if coat is None else min(coat, 1.0))
        film = shader.value("Thin Film Thickness", default=0.0)
        if film:
            result |= {"iridescence": 1.0, "iridescence_ior": max(shader.value("Thin Film IOR", default=1.33) or 1.33, 1.0),
                       "iridescence_thickness_minimum": film, "iridescence_thickness_maximum": film}
        result |= sheen(shader)
        stretch = shader.value("Anisotropic", default=0.0)
        rough = shader.value("Roughness", default=0.5)
        if stretch is None or (stretch and rough is None):
            self.note("anisotropy by textures is not brought over")
        elif stretch > 0.0:
            result |= anisotropy(stretch, rough, shader.value("Anisotropic Rotation", default=0.0) or 0.0)
        return result

    def rough_inside(self, shader: Seen, transmission: float | None) -> Document:
        """Returns the roughness with Transmission Roughness in it, which only GGX of Blender before 4.0 has."""
        more = shader.value("Transmission Roughness", default=0.0)
        if more == 0.0 or getattr(shader.node, "distribution", "") != "GGX":
            return {}
        rough = shader.value("Roughness", default=0.5)
        if None in (more, rough) or transmission != 1.0:
            self.note("Transmission Roughness is brought over where Transmission is 1, without textures")
            return {}
        return {"roughness": 1.0 - (1.0 - min(max(rough, 0.0), 1.0)) * (1.0 - min(max(more, 0.0), 1.0))}

    def unseen(self, shader: Seen) -> Document:
        """Factors that the exporter does not read of what it has seen: what is linked to constants."""
        result: Document = {}
        for key, names, usual in FACTORS:
            value = shader.value(*names, default=usual)
            if value is not None and shader.is_linked(*names):
                result[key] = min(max(value, 0.0), 1.0)
            elif value is None and behind(shader.source(*names), "TEX_IMAGE") is None:
                result[key] = self.number(shader, *names, default=usual)
        color, source = shader.value(*COLOR), shader.source(*COLOR)
        if source is not None and (source.type == "TEX_IMAGE" or textures.is_product("Base Color", source)):
            image = behind(source, "TEX_IMAGE")
            if shader.value("Alpha", default=1.0) is not None and textures.is_darkened(image):
                self.fetch(image)
        if color is not None and shader.is_linked(*COLOR):
            result["base_color"] = clamped(color)
        elif shader.is_linked(*COLOR) and behind(shader.source(*COLOR), "TEX_IMAGE", *VERTICES) is None:
            self.note(f"what is linked to the colour of '{shader.name}' is not brought over")
            result["base_color"] = GREY
        # Where the exporter writes black as the specular colour, glTF still reflects white at grazing angles. Specular
        # has no effect on glass.
        level = shader.value("Specular", default=1.0)
        if level is None and behind(shader.source("Specular"), "TEX_IMAGE") is None:
            self.number(shader, "Specular", default=0.5)
        elif level is not None and shader.value(*TRANSMISSION, default=0.0) == 0.0 \
                and (level == 0.0 or shader.is_linked("Specular")):
            result["specular"] = min(2.0 * max(level, 0.0), 1.0)
        if "EMISSION" in self.exported:
            return result | self.glow(shader)
        # The exporter has white light where it cannot read the colour.
        if shader.value(*EMISSION, default=BLACK) is None and behind(shader.source(*EMISSION), "TEX_IMAGE") is None:
            self.note(f"the light of '{shader.name}' is not brought over")
            result["emission"] = {"color": BLACK}
        elif shader.is_linked("Emission Strength") and shader.value(*EMISSION, default=BLACK) != BLACK:
            result |= self.strength(shader)
        return result

    def strength(self, shader: Seen) -> Document:
        """Returns the light of a shader that the exporter has read and whose strength is linked. The strength is 1, as
        in the exporter, unless the link leads to a constant. If an image gives the light, the exporter has written the
        image itself, and also the strength if a Value node gives it."""
        light, strength = shader.value(*EMISSION), max(self.number(shader, "Emission Strength", default=1.0), 0.0)
        if light is None:
            source = shader.source("Emission Strength")
            return {} if source is not None and source.type == "VALUE" else {"emissive_strength": strength}
        return {"emission": {"color": [max(channel, 0.0) for channel in light], "strength": strength}}

    def all_of(self, shader: Seen) -> Document:
        """All factors of a shader that the exporter has not seen, or of which it has another in its place."""
        result: Document = {key: min(max(self.number(shader, *names, default=usual), 0.0), 1.0) for key, names, usual in FACTORS}
        result["base_color"] = self.color(shader, *COLOR)
        level = self.number(shader, "Specular IOR Level", "Specular", default=0.5)
        result["specular"] = min(2.0 * max(level, 0.0), 1.0)
        # Before Blender 4.0, Specular alone says how much reflects.
        if shader.socket("Specular IOR Level") is not None:
            result["ior"] = max(self.number(shader, "IOR", default=1.5), 1.0)
            result["specular_color"] = clamped(shader.value("Specular Tint") or WHITE)
        coat = shader.value("Coat Weight", "Clearcoat", default=0.0)
        if coat is None or coat > 0.0:
            result["clearcoat"] = min(self.number(shader, "Coat Weight", "Clearcoat", default=0.0), 1.0)
            result["clearcoat_roughness"] = min(self.number(shader, "Coat Roughness", "Clearcoat Roughness", default=0.03), 1.0)
        self.cover_by(shader)
        return result | self.glow(shader)

    def cover_by(self, shader: Seen) -> None:
        """Makes the Alpha of a shader that the exporter has not seen coverage: a constant, or that of its own image."""
        alpha = shader.value("Alpha", default=1.0)
        if alpha is None and textures.has_no_alpha(shader.source("Alpha")):
            return
        if alpha is None and not self.masks(shader.source("Alpha"), shader):
            self.note(f"what is linked to 'Alpha' of '{shader.name}' is not brought over")
        elif alpha is not None and alpha < 1.0:
            self.cover(alpha)

    def glow(self, shader: Seen) -> Document:
        """The light of a Principled BSDF that the exporter has not written."""
        light, strength = shader.value(*EMISSION, default=BLACK), shader.value("Emission Strength", default=1.0)
        if strength == 0.0 or light == BLACK:
            return {}
        if light is None or strength is None:
            self.note(f"the light of '{shader.name}' is not brought over")
            return {}
        return {"emission": {"color": [max(channel, 0.0) for channel in light], "strength": max(strength, 0.0)}}

    def check_normals(self, shader: Seen, taken: bool) -> None:
        """Takes away height images, which the exporter has for maps of normals."""
        for name in ("Normal", "Clearcoat Normal", "Coat Normal"):
            source = shader.source(name)
            if source is not None and not taken:
                self.note(f"what is linked to '{name}' of '{shader.name}' is not brought over")
            elif source is not None and not (source.type == "NORMAL_MAP"
                                             and getattr(source.node, "space", "TANGENT") == "TANGENT"):
                self.written.unbumped.add(self.name)
                self.note(f"'{source.name}' at its input {name} is not brought over: "
                          "only normal maps in tangent space are")
            elif source is not None:
                self.number(source, "Strength", default=1.0)
                image = behind(source.source("Color"), "TEX_IMAGE")
                if image is not None:
                    own = textures.laid(image, False).uv_map
                    self.written.tangents[self.name] = (own, getattr(source.node, "uv_map", ""))

    def subsurface(self, shader: Seen) -> Document | None:
        """A translucent body in place of the material, from a weight of one half on; None below that."""
        weight = shader.value("Subsurface Weight", "Subsurface", default=0.0)
        if weight is not None and weight == 0.0:
            return None
        old = shader.socket("Subsurface Color") is not None
        albedo = shader.value("Subsurface Color" if old else "Base Color")
        radius = shader.value("Subsurface Radius")
        # Blender before 4.0 scales the radius by the weight.
        scale = weight if old else shader.value("Subsurface Scale", default=1.0)
        if weight is None or weight < 0.5 or not self.closed or albedo is None or radius is None or scale is None:
            self.note("subsurface scattering is brought over from a weight of 0.5 on, without textures, on closed meshes")
            return None
        rough, ior = shader.value("Roughness", default=0.5), shader.value("IOR", "Subsurface IOR", default=1.4)
        return body(albedo, radius, scale, 0.5 if rough is None else rough, 1.4 if ior is None else ior,
                    shader.value("Subsurface Anisotropy", default=0.0) or 0.0)

    # --- volumes

    def filled(self, result: Document, volume: Seen) -> Document:
        """A surface with what fills it: its medium, where light enters it as far as can be told."""
        if result.get("solid"):
            medium = volumes.medium(volume)
            if medium is not None:
                return result | medium
            self.note(f"the volume '{volume.name}' is not brought over: only what is constant is")
        elif result.get("transmission", float("ior" in result)) > 0.0 or self.name in self.written.blended:
            self.note(f"the volume '{volume.name}' is not brought over: its surface bounds no body")
        return result

    def fog(self, volume: Seen) -> Document:
        """A body without a surface of its own; without what can be read, there is nothing."""
        medium = volumes.medium(volume) if self.closed else None
        if medium is None:
            self.note(f"the volume '{volume.name}' is not brought over: only constants in closed meshes are")
            self.written.left_out.add(self.name)
            return {}
        if volumes.glows(volume):
            self.note(f"the light of the volume '{volume.name}' is not brought over")
        return {"base_color": WHITE, "metallic": 0.0, "roughness": 0.0, "transmission": 1.0, "ior": 1.0, "solid": True, **medium}


def body(albedo: Any, radius: Any, scale: float, rough: float, ior: float, forward: float) -> Document:
    """A body in which light scatters."""
    return {"subsurface": {"albedo": clamped(albedo), "radius": [max(length * scale, 1e-5) for length in radius],
                           "anisotropy": min(max(forward, -0.999), 0.999), "roughness": min(rough, 1.0),
                           "ior": min(max(ior, 1.0), 3.0)}}


def anisotropy(stretch: float, roughness: float, rotation: float) -> Document:
    """Returns glTF's factors for the lobe of the Principled BSDF, whose aspect is sqrt(1 - 0.9 stretch)."""
    return stretched(math.sqrt(1.0 - 0.9 * min(stretch, 1.0)), roughness, rotation)


def stretched(aspect: float, roughness: float, rotation: float) -> Document:
    """Returns glTF's factors for the two widths of Cycles' lobes, r² / aspect and r² aspect."""
    wide, narrow = min(roughness ** 2 / aspect, 1.0), min(roughness ** 2 * aspect, 1.0)
    strength = math.sqrt((wide - narrow) / (1.0 - narrow)) if narrow < 1.0 else 0.0
    return {"roughness": math.sqrt(narrow), "anisotropy_strength": strength, "anisotropy_rotation": 2.0 * math.pi * rotation}


def sheen(shader: Seen) -> Document:
    weight = shader.value("Sheen Weight", "Sheen", default=0.0)
    if not weight:
        return {}
    tint = shader.value("Sheen Tint", default=0.0)
    if isinstance(tint, list):  # a colour, since Blender 4.0
        color, rough = tint, shader.value("Sheen Roughness", default=0.5)
    else:
        base = shader.value("Base Color") or [1.0, 1.0, 1.0]
        luminance = 0.2126 * base[0] + 0.7152 * base[1] + 0.0722 * base[2]
        hue = [channel / luminance if luminance > 0.0 else 1.0 for channel in base]
        # Disney's sheen, which is that of Blender before 4.0, adds a fifth as much light as glTF's: the means of a ball
        # under an even sky are then alike.
        color, rough = [OLD_SHEEN * (1.0 + (tint or 0.0) * (channel - 1.0)) for channel in hue], OLD_SHEEN_ROUGHNESS
    return {"sheen_color": clamped(weight * channel for channel in color),
            "sheen_roughness": 0.5 if rough is None else min(rough, 1.0)}
