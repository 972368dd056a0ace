"""Hashes by which a tool knows again what it has measured: of the same program and the same scene."""

import hashlib


def file_digest(file):
    return hashlib.sha256(file.read_bytes()).hexdigest()


def folder_digest(folder):
    """Of the names and the contents of all files below it."""
    digest = hashlib.sha256()
    for file in sorted(file for file in folder.rglob("*") if file.is_file()):
        digest.update(f"{file.relative_to(folder)}\0{file_digest(file)}\n".encode())
    return digest.hexdigest()


def joined_digest(*parts):
    """Of texts, short enough for the name of a file: 16 digits."""
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:16]
