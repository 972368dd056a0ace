"""Temporary folders of renders, and what becomes of those that a killed Blender has left. Needs nothing of Blender."""

from __future__ import annotations

import os
import platform
import re
import shutil
import tempfile
from pathlib import Path


def make(above: str, kept: str) -> Path:
    """Makes a folder for a render in another one, or in `kept`, if that is given, whose folders stay."""
    host = re.sub(r"\W", "", platform.node())
    return Path(tempfile.mkdtemp(prefix="etendue-", dir=kept) if kept else
                tempfile.mkdtemp(prefix=f"etendue-{host}-{os.getpid()}-", dir=above or None))


def sweep(above: str) -> None:
    """Removes folders that processes of this host have left which are no more: in that folder, and, where it is one of
    Blender's own, in those of other Blenders."""
    host, place = re.sub(r"\W", "", platform.node()), Path(above or tempfile.gettempdir())
    places = [place, *(place.parent.glob("blender_*") if place.name.startswith("blender_") else ())]
    for folder in (found for here in places for found in here.glob(f"etendue-{host}-*-*")):
        process = folder.name.removeprefix(f"etendue-{host}-").partition("-")[0]
        if process.isdigit() and not is_alive(int(process)):
            shutil.rmtree(folder, ignore_errors=True)


def is_alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:
        pass  # it is another user's
    return True
