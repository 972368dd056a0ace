"""What of a scene directory Cycles is told, as plain data; or why it cannot be compared."""

import json
import math

from . import lobes

# Keys of render.json that do not change what is rendered, or that the comparison sets itself.
SET_BY_COMPARISON = {"spp", "seed", "size", "film", "color", "aovs", "aov_layout", "texture_memory", "brightest",
                     "sampler", "scene"}
CARRIED = {"integrator", "camera", "environment", "materials", "lights"}
EXTENSIONS = {"KHR_materials_emissive_strength", "KHR_materials_ior", "KHR_materials_transmission",
              "KHR_materials_volume"}
TEXTURES = ("normalTexture", "emissiveTexture")


class NotComparable(Exception):
    """The scene has something that Cycles cannot be given as it is."""


def refuse_other_keys(what, given, known):
    others = sorted(set(given) - set(known))
    if others:
        raise NotComparable(f"{what} has {', '.join(others)}, which the comparison does not carry over")


def max_bounces(max_depth):
    """Cycles' 0 bounces is direct light, paths of two edges: camera, surface, light."""
    if max_depth < 2:
        raise NotComparable("max_depth 1 is emission alone, for which Cycles has no limit of bounces")
    return max_depth - 2


def roulette_bounces(roulette_depth):
    """Bounces after which Russian roulette may end paths of Cycles where it may end ours: both spare the first
    `roulette_depth` - 1, and Cycles one more than it is told."""
    return max(0, roulette_depth - 2)


def camera(settings, document):
    chosen = settings.get("camera")
    if isinstance(chosen, dict):
        refuse_other_keys("the camera of render.json", chosen, ("name", "type", "position", "look_at", "up", "yfov"))
        if chosen.get("type", "perspective") != "perspective":
            raise NotComparable("its camera is orthographic")
        return {"yfov": chosen.get("yfov", 0.8), "position": chosen["position"], "look_at": chosen["look_at"],
                "up": chosen.get("up", [0, 1, 0])}
    cameras = document.get("cameras", [])
    names = [entry.get("name") for entry in cameras]
    if not cameras or (chosen is not None and chosen not in names):
        raise NotComparable("the file has no such camera, and the one that Etendue places is not known outside")
    entry = cameras[0 if chosen is None else names.index(chosen)]
    if entry["type"] != "perspective" or not entry.get("name"):
        raise NotComparable("its camera is orthographic or has no name")
    return {"yfov": entry["perspective"]["yfov"], "name": entry["name"]}


def environment(settings, directory):
    if "environment" not in settings:
        return None
    given = settings["environment"]
    refuse_other_keys("environment", given, ("image", "color", "scale", "rotation", "visible_to_camera"))
    return {"image": str((directory / given["image"]).resolve()) if "image" in given else None,
            "color": given.get("color", [1, 1, 1]), "scale": given.get("scale", 1.0),
            "rotation": given.get("rotation", 0.0), "visible": given.get("visible_to_camera", True)}


def lights(settings, document):
    """Intensities and colours by name: candela and lux are watts per steradian and square metre, one to one."""
    overrides = settings.get("lights", {})
    result = {}
    for entry in document.get("extensions", {}).get("KHR_lights_punctual", {}).get("lights", []):
        name = entry.get("name")
        if not name or entry["type"] == "spot":
            raise NotComparable("spot lights have other falloffs in Cycles, and lights need names")
        override = overrides.get(name, {})
        refuse_other_keys(f"light '{name}'", override, ("color", "intensity", "scale", "enabled"))
        strength = override.get("intensity", entry.get("intensity", 1.0)) * override.get("scale", 1.0)
        result[name] = {"type": entry["type"], "color": override.get("color", entry.get("color", [1, 1, 1])),
                        "intensity": strength if override.get("enabled", True) else 0.0}
    return result


class Materials:
    """Each material as one of four: diffuse, metal, plastic (a rough or smooth layer over diffuse), glass; and emission."""

    def __init__(self, settings, document, metals_source):
        self.overrides = settings.get("materials", {})
        self.document = document
        self.metals_source = metals_source

    def all(self):
        return {material["name"]: self.one(material) for material in self.document.get("materials", [])}

    def one(self, material):
        name = material["name"]
        override = self.overrides.get(name, {})
        self.refuse_unknown(material)
        kinds = [key for key in ("diffuse", "conductor", "dielectric", "subsurface") if key in override]
        result = getattr(self, kinds[0])(name, override[kinds[0]]) if kinds else self.from_gltf(material)
        surface = material.get("pbrMetallicRoughness", {})
        if "dielectric" in kinds and (surface.get("baseColorFactor", [1] * 4)[:3] != [1] * 3 or "baseColorTexture" in surface):
            raise NotComparable(f"the dielectric of '{name}' has a base colour")
        result["emission"] = self.emission(material, override)
        result["double_sided"] = material.get("doubleSided", False)
        return result

    @staticmethod
    def refuse_unknown(material):
        name = material["name"]
        refuse_other_keys(f"material '{name}'", material.get("extensions", {}), EXTENSIONS)
        if material.get("alphaMode", "OPAQUE") != "OPAQUE" or any(key in material for key in TEXTURES):
            raise NotComparable(f"material '{name}' is transparent, or has textures of normals or emission")
        if "metallicRoughnessTexture" in material.get("pbrMetallicRoughness", {}):
            raise NotComparable(f"material '{name}' has a texture of its roughness")

    @staticmethod
    def emission(material, override):
        if "emission" in override:
            color, strength = override["emission"].get("color", [1, 1, 1]), override["emission"].get("strength", 1.0)
        else:
            color = material.get("emissiveFactor", [0, 0, 0])
            strength = material.get("extensions", {}).get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1)
        return [channel * strength for channel in color]

    @staticmethod
    def diffuse(name, given):
        if given.get("roughness", 0) > 0:
            raise NotComparable(f"material '{name}' is diffuse with rough facets, where the models differ")
        return {"kind": "diffuse", "color": given.get("albedo", [0.5] * 3)}

    def conductor(self, name, given):
        fresnel = (lobes.metal(lobes.optical_constants(self.metals_source, given["metal"])) if "metal" in given
                   else lambda cosine: [1.0] * 3)
        return self.metal(fresnel, given.get("roughness", 0.0))

    @staticmethod
    def metal(fresnel, roughness):
        alpha = roughness ** 2
        return {"kind": "metal", "roughness": roughness if alpha >= lobes.SMOOTH_ALPHA else 0.0,
                "curve": lobes.over_white_lobe(lobes.reflected(fresnel, alpha), alpha)}

    @staticmethod
    def dielectric(name, given):
        refuse_other_keys(f"the dielectric of '{name}'", given, ("ior", "roughness"))
        if given.get("roughness", 0) > 0:
            raise NotComparable(f"material '{name}' is rough glass, where the models differ")
        return {"kind": "glass", "ior": given.get("ior", 1.5), "absorption": None}

    @staticmethod
    def subsurface(name, _):
        raise NotComparable(f"light walks at random in material '{name}', and Cycles' walk is another")

    def from_gltf(self, material):
        extensions = material.get("extensions", {})
        surface = material.get("pbrMetallicRoughness", {})
        base, name = surface.get("baseColorFactor", [1] * 4)[:3], material["name"]
        ior = extensions.get("KHR_materials_ior", {}).get("ior", 1.5)
        roughness, metallic = surface.get("roughnessFactor", 1.0), surface.get("metallicFactor", 1.0)
        textured = "baseColorTexture" in surface
        if "KHR_materials_transmission" in extensions:
            return self.body(name, extensions, ior, roughness, base, textured)
        if metallic not in (0.0, 1.0) or (metallic == 1.0 and textured):
            raise NotComparable(f"material '{name}' is half a metal, or one with a texture")
        if metallic == 1.0:
            return self.metal(lobes.schlick(base), roughness)
        return self.plastic(((ior - 1) / (ior + 1)) ** 2, roughness)

    @staticmethod
    def plastic(f0, roughness):
        alpha = roughness ** 2
        reflected = lobes.reflected(lobes.schlick([f0] * 3), alpha)
        return {"kind": "plastic", "roughness": roughness if alpha >= lobes.SMOOTH_ALPHA else 0.0,
                "curve": lobes.over_white_lobe(reflected, alpha),
                "passed": [[facing, *(1.0 - value for value in values)] for facing, *values in reflected]}

    @staticmethod
    def body(name, extensions, ior, roughness, base, textured):
        transmission, volume = extensions["KHR_materials_transmission"], extensions.get("KHR_materials_volume", {})
        if volume.get("thicknessFactor", 0) <= 0:
            raise NotComparable(f"material '{name}' is a thin transmissive wall, which Cycles does not have")
        if (transmission != {"transmissionFactor": 1.0} or roughness > 0 or textured or base != [1.0] * 3
                or "thicknessTexture" in volume):
            raise NotComparable(f"material '{name}' transmits otherwise than smooth clear glass does")
        absorption = None
        if "attenuationDistance" in volume:
            absorption = [-math.log(max(color, 1e-6)) / volume["attenuationDistance"]
                          for color in volume.get("attenuationColor", [1, 1, 1])]
        return {"kind": "glass", "ior": ior, "absorption": absorption}


def make_plan(directory, size, metals_source):
    """Everything that Cycles is told of the scene. Raises NotComparable, or OSError if files are missing."""
    settings = json.loads((directory / "render.json").read_text())
    gltf = directory / settings.get("scene", "scene.gltf")
    document = json.loads(gltf.read_text())
    refuse_other_keys("render.json", settings, SET_BY_COMPARISON | CARRIED)
    integrator = settings.get("integrator", {})
    refuse_other_keys("the integrator", integrator, ("type", "max_depth", "roulette_depth", "light_samples"))
    refuse_other_keys("the file", document.get("extensionsRequired", []),
                      EXTENSIONS | {"KHR_lights_punctual", "EXT_mesh_gpu_instancing"})
    if document.get("animations"):
        raise NotComparable("it is animated")
    plan = {"gltf": str(gltf.resolve()), "size": size, "camera": camera(settings, document),
            "max_bounces": max_bounces(integrator.get("max_depth", 32)),
            "roulette_bounces": roulette_bounces(integrator.get("roulette_depth", 3)),
            "environment": environment(settings, directory), "lights": lights(settings, document),
            "materials": Materials(settings, document, metals_source).all()}
    if not plan["environment"] and not plan["lights"] and not any(
            any(material["emission"]) for material in plan["materials"].values()):
        raise NotComparable("it has no light, and the one that Etendue adds is not known outside")
    return plan
