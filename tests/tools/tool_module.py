"""Tools as modules, for tests of their parts."""

import importlib.util
import re
import sys
from importlib.machinery import SourceFileLoader
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2] / "tools"
FOLDERS = [str(ROOT), *(str(ROOT / folder) for folder in ("lab", "gen"))]
sys.path[:0] = [folder for folder in FOLDERS if folder not in sys.path]


def load_tool(name):
    """The module of tools/NAME, a script without a suffix, such as lab/bench."""
    module_name = "tool_" + re.sub(r"\W", "_", name)
    loader = SourceFileLoader(module_name, str(ROOT / name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(module_name, loader))
    sys.modules[module_name] = module  # where dataclasses look for their own
    loader.exec_module(module)
    return module
