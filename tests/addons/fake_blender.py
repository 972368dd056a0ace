"""Objects that look like Blender's, as far as the add-on looks at them."""

import math
import sys
from pathlib import Path
from types import SimpleNamespace

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "addons/blender"))

IDENTITY = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]


class Socket:
    """An input; `source` is the node whose output is linked to it."""

    def __init__(self, default_value=None, source=None):
        self.default_value, self.is_linked = default_value, source is not None
        self.links = [SimpleNamespace(from_node=source)] if source is not None else []


class Node(SimpleNamespace):
    """`inputs` maps names to values, or to nodes that are linked."""

    def __init__(self, kind, inputs=None, **properties):
        sockets = {name: Socket(source=value) if isinstance(value, Node) else Socket(value)
                   for name, value in (inputs or {}).items()}
        super().__init__(type=kind, name=kind, inputs=Inputs(sockets), **properties)


class Inputs(dict):
    """Sockets by name or number."""

    def __getitem__(self, key):
        return list(self.values())[key] if isinstance(key, int) else super().__getitem__(key)


def tree(kind, surface=None, **inputs):
    """A node tree with its output."""
    output = Node(kind, {"Surface": surface, "Volume": None, "Displacement": None, **inputs}, is_active_output=True)
    return SimpleNamespace(nodes=[output] + ([surface] if surface is not None else []))


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


def scene(**settings):
    defaults = {"integrator": "path", "samples": 32, "time": 0.0, "error": 0.0, "adaptive": True, "min_samples": 48, "seed": 3,
                "max_depth": 12, "light_samples": 1, "heuristic": "balance", "connections": 0, "merge": "sds",
                "merge_radius": 1.5, "clamp_indirect": 0.0, "robust": 1, "denoise": False, "filter": "blackman-harris",
                "filter_radius": 0.0, "working_space": "REC709"}
    render = SimpleNamespace(resolution_x=200, resolution_y=100, resolution_percentage=50, pixel_aspect_x=1.0,
                             pixel_aspect_y=1.0, use_border=False, border_min_x=0.25, border_max_x=0.75, border_min_y=0.0,
                             border_max_y=0.5, film_transparent=False, motion_blur_shutter=0.5)
    return SimpleNamespace(render=render, etendue=SimpleNamespace(**{**defaults, **settings}), world=None,
                           camera=item("View", camera(), "CAMERA"))


def view_layer(**flags):
    own = {name: flags.pop(name) for name in list(flags) if name in ("use_pass_volume", "layers", "use_pass_caustics")}
    return SimpleNamespace(pass_cryptomatte_depth=6, etendue=SimpleNamespace(**{"layers": "", **own}), **flags)
