"""Tools as modules, for tests of their parts."""

import importlib.util
import sys
from importlib.machinery import SourceFileLoader
from pathlib import Path

TOOLS = Path(__file__).resolve().parents[2] / "tools"


def load_tool(name):
    """The module of tools/NAME, a script without a suffix."""
    if str(TOOLS) not in sys.path:
        sys.path.insert(0, str(TOOLS))
    module_name = "tool_" + name.replace("-", "_")
    loader = SourceFileLoader(module_name, str(TOOLS / name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(module_name, loader))
    sys.modules[module_name] = module  # where dataclasses look for their own
    loader.exec_module(module)
    return module
