"""Objects that look like Blender's, as far as the add-on looks at them."""

import math
import sys
from pathlib import Path
from types import SimpleNamespace

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "addons/blender"))

IDENTITY = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]


class Socket:
    """An input or output; `source` is the node whose first output is linked to it, or a pair of a node and a name."""

    def __init__(self, name, default_value=None, source=None):
        self.name = self.identifier = name
        self.is_linked, self.links = source is not None, []
        self.default_value = (1.0, 1.0, 1.0, 1.0) if source is not None and "Color" in name else default_value
        if source is not None:
            node, output = source if isinstance(source, tuple) else (source, 0)
            self.links = [SimpleNamespace(from_node=node, from_socket=node.outputs[output])]


def is_source(value):
    return isinstance(value, Node) or isinstance(value, tuple) and len(value) > 0 and isinstance(value[0], Node)


class Node(SimpleNamespace):
    """`inputs` maps names to values, or to what is linked: nodes, or pairs of a node and the name of its output; `value` is
    that of its outputs. Numbers after a double underscore tell inputs of one name apart, as `Shader__2`."""

    def __init__(self, kind, inputs=None, outputs=("Out",), value=None, **properties):
        sockets = {name: Socket(name.split("__")[0], source=given) if is_source(given) else Socket(name.split("__")[0], given)
                   for name, given in (inputs or {}).items()}
        super().__init__(**{"type": kind, "name": kind, **properties}, inputs=Inputs(sockets),
                         outputs=Inputs({name: Socket(name, value) for name in outputs}))


class Inputs(dict):
    """Sockets by name or number, and as a list."""

    def __getitem__(self, key):
        return list(self.values())[key] if isinstance(key, int) else super().__getitem__(key)

    def __iter__(self):
        return iter(list(self.values()))


def mix(share, first=None, second=None):
    return Node("MIX_SHADER", {"Fac": share, "Shader": first, "Shader__2": second})


def group(inner, name="BSDF", **inputs):
    """A group whose output is that of a node inside."""
    output = Node("GROUP_OUTPUT", {name: inner}, is_active_output=True)
    return Node("GROUP", inputs, (name,), node_tree=SimpleNamespace(nodes=all_before(output)))


def image(name="image", space="sRGB", **properties):
    return SimpleNamespace(**{"name": name, "size": (2, 2), "source": "FILE", "is_float": False,
                              "colorspace_settings": SimpleNamespace(name=space), **properties})


def mapping(vector=None, kind="POINT", place=(0.0, 0.0, 0.0), turn=(0.0, 0.0, 0.0), scale=(1.0, 1.0, 1.0)):
    return Node("MAPPING", {"Vector": vector, "Location": place, "Rotation": turn, "Scale": scale}, vector_type=kind)


def texture(picture, vector=None, **properties):
    return Node("TEX_IMAGE", {"Vector": vector}, ("Color", "Alpha"), image=picture,
                **{"projection": "FLAT", "extension": "REPEAT", **properties})


def tree(kind, surface=None, **inputs):
    """A node tree with its output."""
    output = Node(kind, {"Surface": surface, "Volume": None, "Displacement": None, **inputs}, is_active_output=True)
    return SimpleNamespace(nodes=all_before(output))


def all_before(node):
    """The node and those that lead to it, the nearest first."""
    found = {id(node): node}
    waiting = [node]
    while waiting:
        for socket in waiting.pop(0).inputs:
            for link in socket.links:
                if id(link.from_node) not in found:
                    found[id(link.from_node)] = link.from_node
                    waiting.append(link.from_node)
    return list(found.values())


def material(name, surface=None, **inputs):
    return SimpleNamespace(name=name, use_nodes=True, node_tree=tree("OUTPUT_MATERIAL", surface, **inputs))


def principled(**inputs):
    return Node("BSDF_PRINCIPLED", {name.replace("_", " "): value for name, value in inputs.items()})


def world(background=None, **properties):
    mist = SimpleNamespace(start=2.0, depth=8.0, falloff="INVERSE_QUADRATIC")
    return SimpleNamespace(use_nodes=True, mist_settings=mist, color=(0.1, 0.2, 0.3), node_tree=tree("OUTPUT_WORLD", background), **properties)


def light(kind, **properties):
    defaults = {"energy": 10.0, "color": (1.0, 0.5, 0.25), "use_nodes": False, "node_tree": None, "shadow_soft_size": 0.0,
                "angle": 0.0, "spread": math.pi, "shape": "SQUARE", "size": 1.0, "size_y": 1.0, "spot_size": 1.0,
                "spot_blend": 0.5}
    return SimpleNamespace(type=kind, **{**defaults, **properties})


def camera(kind="PERSP", **properties):
    dof = SimpleNamespace(use_dof=False, focus_object=None, focus_distance=5.0, aperture_fstop=2.8, aperture_blades=0,
                          aperture_rotation=0.0, aperture_ratio=1.0)
    defaults = {"shift_x": 0.0, "shift_y": 0.0, "clip_start": 0.1, "clip_end": 100.0, "lens": 50.0, "sensor_fit": "AUTO",
                "sensor_width": 36.0, "sensor_height": 24.0, "dof": dof}
    return SimpleNamespace(type=kind, **{**defaults, **properties})


def item(name, data, kind, matrix=None, **properties):
    return SimpleNamespace(name=name, data=data, type=kind, matrix_world=matrix or IDENTITY, **properties)


class Block:
    """A data-block: told from others by what it is and not by its name; it has custom properties."""

    def __init__(self, name, library=None, **properties):
        self.name, self.library, self.custom = name, library, {}
        self.name_full = f"{name} [{library}]" if library else name
        self.__dict__.update({"type": "MESH", "parent": None, "is_instancer": False, "instance_type": "NONE", "modifiers": [],
                              "particle_systems": [], **properties})

    def __setitem__(self, key, value):
        self.custom[key] = value

    def __delitem__(self, key):
        del self.custom[key]

    def keys(self):
        return self.custom.keys()


def scene(**settings):
    defaults = {"integrator": "path", "samples": 32, "time": 0.0, "error": 0.0, "adaptive": True, "min_samples": 48, "seed": 3,
                "max_depth": 12, "light_samples": 1, "heuristic": "balance", "connections": 0, "merge": "sds",
                "merge_radius": 1.5, "clamp_indirect": 0.0, "robust": 1, "denoise": False, "filter": "blackman-harris",
                "filter_radius": 0.0, "working_space": "REC709"}
    render = SimpleNamespace(resolution_x=200, resolution_y=100, resolution_percentage=50, pixel_aspect_x=1.0,
                             pixel_aspect_y=1.0, use_border=False, border_min_x=0.25, border_max_x=0.75, border_min_y=0.0,
                             border_max_y=0.5, film_transparent=False, motion_blur_shutter=0.5, fps=25, fps_base=1.0)
    return SimpleNamespace(render=render, etendue=SimpleNamespace(**{**defaults, **settings}), world=None,
                           camera=item("View", camera(), "CAMERA"))


def view_layer(**flags):
    own = {name: flags.pop(name) for name in list(flags) if name in ("use_pass_volume", "layers", "use_pass_caustics")}
    return SimpleNamespace(pass_cryptomatte_depth=6, etendue=SimpleNamespace(**{"layers": "", **own}), **flags)
