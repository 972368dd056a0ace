"""Files to disk."""

import os


def write_files(directory, contents):
    """Writes the files `contents` (bytes by name), each under a temporary name first; what is there already stays."""
    directory.mkdir(parents=True, exist_ok=True)
    for name, data in contents.items():
        target = directory / name
        if target.exists() and target.read_bytes() == data:
            continue
        temporary = directory / f".{name}.{os.getpid()}"
        temporary.write_bytes(data)
        temporary.replace(target)
