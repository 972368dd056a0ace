"""Mutations of JSON: each changes one place of a model, says which, and returns None where the model has no such place."""

import json

from .model import ROOT, Literal, Pairs, at

NUMBERS = (0, Literal("-0"), Literal("-0.0"), 1, -1, 0.5, 1e-30, 1e-45, 1e15, 1e18, 1e30, -1e30, 3.4028235e38, 1e39, 1e308, -1e308,
           Literal("1e400"), Literal("1e-400"), 127, 255, 256, 65535, 65536, 2**24, 2**31 - 1, 2**31, -2**31, 2**32 - 1,
           2**32, 2**53, 2**63 - 1, 2**63, 2**64, -2**63, 10**30, Literal("NaN"), Literal("Infinity"), "NaN", "1")
STRINGS = ("", " ", "a" * 70000, "../" * 8 + "etc/passwd", "..", "/etc/passwd", "/dev/zero", "file:///etc/passwd", "%2e%2e%2fx",
           "a\x00b", "\x1b[31m\r\n", "\ud800", "\u202e\U0001f600", "data:", "data:;base64,", "data:image/png;base64,AAAA",
           "{}", "%", "%zz", "http://localhost/x", ".", "scene.gltf", "scene.bin", "CON", "a/../b", "a\\..\\b")
OTHERS = (None, True, False, 0, -1, 0.5, "", "text", [], {}, [[]], [0], {"a": 0}, [None], [{}])
ENUMS = (0, 1, 2, 3, 4, 5, 6, 7, 5120, 5121, 5122, 5123, 5124, 5125, 5126, 5130, 9728, 9729, 9984, 9985, 9986, 9987, 33071,
         33648, 10497, 34962, 34963, "SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4", "OPAQUE", "MASK", "BLEND",
         "perspective", "orthographic", "translation", "rotation", "scale", "weights", "pointer", "LINEAR", "STEP",
         "CUBICSPLINE", "point", "spot", "directional", "image/png", "image/jpeg", "image/webp", "ATTRIBUTES", "TRIANGLES",
         "INDICES", "NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL", "POSITION", "NORMAL", "TANGENT", "TEXCOORD_0",
         "COLOR_0", "JOINTS_0", "WEIGHTS_0")
ENUM_KEYS = {"componentType", "type", "mode", "magFilter", "minFilter", "wrapS", "wrapT", "target", "alphaMode", "path",
             "interpolation", "mimeType", "filter"}
INDEX_KEYS = {"scene", "nodes", "children", "mesh", "skin", "camera", "material", "indices", "index", "source", "sampler",
              "bufferView", "buffer", "input", "output", "node", "joints", "skeleton", "inverseBindMatrices", "light",
              "variants", "texCoord", "byteOffset", "byteLength", "byteStride", "count", "attributes", "targets", "image",
              "lightProfile", "translation", "rotation", "scale"}
ARRAYS = ("scenes", "nodes", "meshes", "accessors", "bufferViews", "buffers", "materials", "textures", "images", "samplers",
          "skins", "animations", "cameras")


class Place:
    """One value: in `container` under `key`, as a member of which `kind` tells the same in all elements of arrays."""

    def __init__(self, container, key, pointer, kind):
        self.container, self.key, self.pointer, self.kind = container, key, pointer, kind

    @property
    def value(self):
        return self.container[self.key]

    @value.setter
    def value(self, value):
        self.container[self.key] = value

    @property
    def name(self):
        """The key, or that of the array which the value is in."""
        return next((part for part in reversed(self.kind) if part != "*"), "")

    def say(self, what):
        shown = json.dumps(what) if not isinstance(what, (Literal, Pairs)) else str(what)
        return f"{self.pointer} = {shown if len(shown) < 80 else shown[:77] + '...'}"


def members(container):
    return list(container.items() if isinstance(container, dict) else enumerate(container))


def places(model):
    """All of the document and of render.json."""
    found = []

    def walk(container, pointer, kind):
        for key, value in members(container):
            # A mutation before this one may have left objects with one key twice.
            if isinstance(value, Pairs):
                continue
            inner = kind + ("*" if isinstance(container, list) else key,)
            found.append(Place(container, key, f"{pointer}/{key}", inner))
            if isinstance(value, (dict, list)):
                walk(value, f"{pointer}/{key}", inner)

    walk(model.document, "", ())
    walk(model.settings, "render.json#", ("render.json",))
    return found


def choose(random, found):
    """One place; every kind is as likely, however many there are of it."""
    kinds = {}
    for place in found:
        kinds.setdefault(place.kind, []).append(place)
    return random.choice(random.choice(list(kinds.values()))) if kinds else None


def choose_if(model, random, wanted):
    return choose(random, [place for place in places(model) if wanted(place)])


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def replace(place, value):
    """Puts it there; what was done in words."""
    place.value = value
    return place.say(value)


def swap_type(model, random, _):
    place = choose(random, places(model))
    old = place.value
    return replace(place, random.choice((*(one for one in OTHERS if type(one) is not type(old)), [old], {"a": old}, str(old))))


def delete(model, random, _):
    place = choose(random, places(model))
    del place.container[place.key]
    return f"{place.pointer} is gone"


def duplicate_key(model, random, _):
    place = choose_if(model, random, lambda one: isinstance(one.value, dict) and one.value)
    if place is None:
        return None
    key = random.choice(list(place.value))
    other = random.choice((place.value[key], 0, "", {}, [], None))
    place.value = Pairs([*([one, value] for one, value in place.value.items()), [key, other]])
    return f"{place.pointer}/{key} twice"


def move(model, random, _):
    """A member goes to another object."""
    every = places(model)
    source = choose(random, [one for one in every if isinstance(one.container, dict)])
    target = choose(random, [one for one in every if isinstance(one.value, dict) and one.value is not source.value])
    if target is None or is_within(source.value, target.value):
        return None
    value = source.container.pop(source.key)
    target.value[source.key] = value
    return f"{source.pointer} moved to {target.pointer}"


def is_within(outer, value):
    return outer is value or (isinstance(outer, (dict, list)) and any(is_within(one, value) for _, one in members(outer)))


def exchange(model, random, _):
    """Two values change places."""
    every = places(model)
    one, other = choose(random, every), choose(random, every)
    if is_within(one.value, other.container) or is_within(other.value, one.container):
        return None
    one.value, other.value = other.value, one.value
    return f"{one.pointer} and {other.pointer} exchanged"


def extreme_number(model, random, _):
    place = choose_if(model, random, lambda one: is_number(one.value))
    if place is None:
        return None
    old = place.value
    return replace(place, random.choice((*NUMBERS, -old, old * 1000, old / 1000, old * 1e12)))


def shift_index(model, random, _):
    """Off by one, to itself, or beyond the end of the array that it may point into."""
    place = choose_if(model, random, lambda one: isinstance(one.value, int) and not isinstance(one.value, bool) and
                      not INDEX_KEYS.isdisjoint(one.kind))
    if place is None:
        return None
    ends = [len(model.document[key]) for key in ARRAYS if isinstance(model.document.get(key), list)]
    own = next((int(part) for part in reversed(place.pointer.split("/")[:-1]) if part.isdigit()), 0)
    old = place.value
    return replace(place, random.choice((old + 1, old - 1, -1, own, 0, *ends, *(end - 1 for end in ends), old + 2, old * 2, old + 4)))


def make_cycle(model, random, _):
    """Nodes below themselves, or with two parents."""
    nodes = [node for node in model.document.get("nodes", []) if isinstance(node, dict)] \
        if isinstance(model.document.get("nodes"), list) else []
    if not nodes:
        return None
    parent, child = random.randrange(len(nodes)), random.randrange(len(nodes))
    children = nodes[parent].setdefault("children", [])
    if not isinstance(children, list):
        return None
    children.append(child)
    return f"node {parent} has the child {child}"


def resize_array(model, random, _):
    place = choose_if(model, random, lambda one: isinstance(one.value, list))
    if place is None:
        return None
    old = place.value
    new = random.choice(([], old + json.loads(json.dumps(old, default=str)), [old], old[:-1], old[1:], old[::-1], old[:1],
                         [*old, *old[-1:]], nested(old), old * 50 if len(old) < 20 else old[:1] * 1000))
    place.value = json.loads(json.dumps(new, default=str))
    return f"{place.pointer} of {len(old)} became an array of {len(new)}"


def nested(value):
    for _ in range(200):
        value = [value]
    return value


def change_string(model, random, _):
    place = choose_if(model, random, lambda one: isinstance(one.value, str) and not isinstance(one.value, Literal))
    if place is None:
        return None
    old = place.value
    strings = [one.value for one in places(model) if isinstance(one.value, str)]
    return replace(place, random.choice((*STRINGS, old + "x", old[:-1], old.upper(), "../" + old, "./" + old, old + "\x00",
                                         random.choice(strings))))


def negate(model, random, _):
    place = choose_if(model, random, lambda one: isinstance(one.value, bool))
    return None if place is None else replace(place, not place.value)


def change_enum(model, random, _):
    place = choose_if(model, random, lambda one: one.name in ENUM_KEYS and not isinstance(one.value, (dict, list)))
    return None if place is None else replace(place, random.choice(ENUMS))


def change_extension(model, random, others):
    """Extensions where they do not belong, without their declaration, or without their parts."""
    every = places(model)
    extensions = [one for one in every if one.kind[-2:-1] == ("extensions",)]
    objects = [one for one in every if isinstance(one.value, dict) and one.name != "extensions"]
    what = random.randrange(5)
    if what == 0:
        model.document.setdefault("extensionsRequired", [])
        if isinstance(model.document["extensionsRequired"], list):
            model.document["extensionsRequired"].append(random.choice(("KHR_unknown", "KHR_draco_mesh_compression", 1)))
        return "another extension is required"
    if what == 1:
        model.document.pop("extensionsUsed", None)
        return "extensions are not declared"
    if what == 2:
        extensions += [one for one in places(random.choice(others)) if one.kind[-2:-1] == ("extensions",)]
    source, target = choose(random, extensions), choose(random, objects)
    if source is None or target is None:
        return None
    if what == 3:
        return replace(source, random.choice(OTHERS))
    copied = json.loads(json.dumps(source.value, default=str))
    if not isinstance(target.value.setdefault("extensions", {}), dict):
        return None
    target.value["extensions"][source.key] = copied
    return f"{source.key} at {target.pointer}"


def graft(model, random, others):
    """A value of another model, where this one has one of that kind or an object that may hold it."""
    foreign = choose(random, places(random.choice(others)))
    every = [one for one in places(model) if one.kind == foreign.kind]
    copied = json.loads(json.dumps(foreign.value))
    if every:
        place = random.choice(every)
        place.value = copied
        return f"{place.pointer} of another model"
    parents = [one for one in places(model) if one.kind == foreign.kind[:-1] and isinstance(one.value, dict)]
    if not parents or not isinstance(foreign.key, str):
        return None
    place = random.choice(parents)
    place.value[foreign.key] = copied
    return f"{place.pointer}/{foreign.key} of another model"


def rewrite_accessor(model, random, _):
    """An accessor whose members fit each other, but are more, without data, or sparse."""
    place = choose_if(model, random, lambda one: one.kind == ("accessors", "*") and isinstance(one.value, dict))
    if place is None:
        return None
    accessor = place.value
    many = random.choice((0, 1, 2, 1000, 10**6, 10**7, 2**28, 2**31 - 1, 2**31, 2**32 - 1, 2**32, 2**40, 2**62, 2**63))
    view = accessor.get("bufferView", 0)
    what = random.randrange(4)
    if what == 0:
        accessor.pop("bufferView", None)
        accessor["count"] = many
        return f"{place.pointer} has {many} values and no data"
    if what == 1:
        accessor["count"] = many
        views = model.document.get("bufferViews")
        if isinstance(views, list):
            views.append({"buffer": 0, "byteLength": many, "byteOffset": random.choice((0, 1, many))})
            accessor["bufferView"] = len(views) - 1
        return f"{place.pointer} has {many} values in a view of as many bytes"
    if what == 2:
        accessor["sparse"] = {"count": random.choice((1, many)),
                              "indices": {"bufferView": view, "componentType": random.choice((5121, 5123, 5125))},
                              "values": {"bufferView": random.choice((view, 0))}}
        return f"{place.pointer} is sparse"
    accessor |= {"componentType": random.choice((5120, 5121, 5122, 5123, 5125, 5126)), "normalized": random.random() < 0.5}
    return f"{place.pointer} has another component type"


def empty_attributes(model, random, _):
    """All attributes of a primitive or of instances lose their data, and have as many values as each other."""
    place = choose_if(model, random, lambda one: one.key == "attributes" and isinstance(one.value, dict))
    if place is None:
        return None
    many = random.choice((1, 1000, 10**6, 10**7, 2**24, 2**24 + 1, 2**31))
    for index in place.value.values():
        accessor = at(model.document, "accessors", index)
        if isinstance(accessor, dict):
            accessor.pop("bufferView", None)
            accessor["count"] = many
    return f"{place.pointer} have {many} values and no data"


LENGTHS = (0, 1e-45, 1e-30, 1e-12, 1e-6, 1e6, 1e12, 1e18, 1e20, 1e30, 1e38, 1e300, -1, -1e12)


def transform_node(model, random, _):
    """A node far away, turned, flat, tiny or huge, whether or not it had a transform."""
    place = choose_if(model, random, lambda one: one.kind == ("nodes", "*") and isinstance(one.value, dict))
    if place is None:
        return None
    axes = [random.choice(LENGTHS) if random.random() < 0.5 else 1 for _ in range(3)]
    key, value = random.choice((("translation", axes), ("scale", axes), ("scale", axes[:1] * 3), ("rotation", [*axes, 0]),
                                ("matrix", [axes[0], 0, 0, 0, axes[1], 1, 0, 0, 0, 0, axes[2], 0, *axes, 1])))
    if key == "matrix":
        for one in ("translation", "rotation", "scale"):
            place.value.pop(one, None)
    else:
        place.value.pop("matrix", None)
    place.value[key] = value
    return f"{place.pointer}/{key} = {value}"


SCHEMA = json.loads((ROOT / "scenes/render.schema.json").read_text())


def example(schema, random, model):
    """A value that the schema allows, or nearly."""
    if "$ref" in schema:
        schema = at(SCHEMA, *schema["$ref"].removeprefix("#/").split("/"))
    for choice in ("oneOf", "anyOf"):
        if choice in schema:
            return example(random.choice(schema[choice]), random, model)
    if "enum" in schema:
        return random.choice(schema["enum"])
    if "const" in schema:
        return schema["const"]
    kind = schema.get("type", "object")
    if kind == "object":
        known = schema.get("properties", {})
        required = schema.get("required", [])
        chosen = [key for key in known if key in required or random.random() < 0.4]
        return {key: example(known[key], random, model) for key in chosen}
    if kind == "array":
        least, most = schema.get("minItems", 0), schema.get("maxItems", 3)
        return [example(schema["items"], random, model) for _ in range(random.randint(least, max(least, most)))]
    if kind == "boolean":
        return random.random() < 0.5
    if kind in ("number", "integer"):
        low, high = schema.get("minimum", schema.get("exclusiveMinimum", -10)), schema.get("maximum", 10)
        value = random.choice((low, high, low + 1, random.uniform(low, min(high, low + 10)), *NUMBERS))
        return int(value) if kind == "integer" and isinstance(value, float) else value
    return random.choice(("mon:5", "cache:4", "depth", "passes", "lpe:C D L", "a=lpe:C <RD> L", "512M", "1", "ACEScg", "none",
                          "cryptomatte", "variance", "deep", *names(model), *STRINGS))


def names(model):
    return [one.value for one in places(model) if one.key == "name" and isinstance(one.value, str)]


def set_setting(model, random, _):
    """A key of render.json as its schema has it. Sequences would be renders without end."""
    key = random.choice([one for one in SCHEMA["properties"] if one not in ("frames", "scene", "$schema")])
    schema = SCHEMA["properties"][key]
    if key in ("materials", "lights"):
        listed = names(model) or ["nobody"]
        inner = schema.get("additionalProperties", {})
        value = {random.choice(listed): example(inner, random, model) for _ in range(2)}
    elif key == "aovs":
        value = [random.choice(("depth", "P", "N", "uv", "albedo", "motion", "lights", "passes", "cryptomatte", "variance",
                                "denoising", "caustics=lpe:C D S+ L", "../a=lpe:C L", "a=light:Lamp", "a/b=lpe:C L", "x:half",
                                "deep", "clamped", "rays", "cryptomatte:30", "")) for _ in range(random.randint(1, 3))]
    else:
        value = example(schema, random, model)
    if not isinstance(model.settings, dict):
        return None
    model.settings[key] = value
    return f"render.json#/{key} = {json_short(value)}"


def json_short(value):
    text = json.dumps(value)
    return text if len(text) < 80 else text[:77] + "..."


MUTATIONS = {"type swapped": swap_type, "key deleted": delete, "key twice": duplicate_key, "member moved": move,
             "values exchanged": exchange, "number": extreme_number, "index": shift_index, "cycle": make_cycle,
             "array": resize_array, "string": change_string, "boolean": negate, "enumeration": change_enum,
             "extension": change_extension, "graft": graft, "accessor": rewrite_accessor, "attributes": empty_attributes, "transform": transform_node, "setting": set_setting}
