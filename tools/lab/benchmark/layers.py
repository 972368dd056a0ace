"""The layers whose cost tools/lab/bench measures: what `--aov` is given for so many of them."""

PASSES = ["passes"]  # ten layers of light
FIRST_HITS = ["depth", "P", "N", "Ng", "uv", "albedo", "albedo_diffuse", "albedo_specular", "object_id", "material_id",
              "motion"]
COSTS = ["samples", "variance", "rays"]
PATHS = [f"p{edges}=lpe:C .{{{edges - 1}}} L" for edges in range(2, 10)] + [
    "caustics", "caustics_seen", "direct", "indirect", "mirrored=lpe:C S+ .* L", "twice=lpe:C D D L",
    "seen=lpe:C [GS] D L", "rest=lpe:!C D* L"]
SETS = {0: [], 1: ["direct"], 4: ["direct", "indirect", "albedo", "N"], 10: PASSES,
        40: PASSES + FIRST_HITS + COSTS + PATHS}
