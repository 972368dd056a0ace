"""Packs Blender's add-on: a zip that Blender installs, with the same bytes each time.

addon_zip.py FOLDER OUTPUT.zip
"""

import sys
import zipfile
from pathlib import Path

DATE = (2020, 1, 1, 0, 0, 0)


def write_zip(folder, output):
    """Packs the files of `folder` below its name; Blender 3.4 and 4.2 take it alike."""
    with zipfile.ZipFile(output, "w", zipfile.ZIP_DEFLATED) as archive:
        for file in sorted(folder.rglob("*")):
            if not file.is_file() or "__pycache__" in file.parts:
                continue
            entry = zipfile.ZipInfo(f"{folder.name}/{file.relative_to(folder).as_posix()}", DATE)
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            archive.writestr(entry, file.read_bytes())


def main():
    if len(sys.argv) != 3 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    write_zip(Path(sys.argv[1]), Path(sys.argv[2]))


if __name__ == "__main__":
    main()
