"""Mutations of what is not JSON: values of accessors, compressed data, images, files and the scene file's own bytes."""

import struct

from .model import at
from .structure import choose, places

FORMATS = {5120: "b", 5121: "B", 5122: "h", 5123: "H", 5125: "I", 5126: "f"}
COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
FLOATS = tuple(struct.unpack("<f", struct.pack("<I", bits))[0] for bits in (
    0x7FC00000, 0x7F800000, 0xFF800000, 0x7F7FFFFF, 0xFF7FFFFF, 0x00000001, 0x80000000, 0x00800000, 0, 0x3F800000, 0xBF800000)) + (
    1e30, -1e30, 1e20, 1e15, 1e-20, 1e-30, 1e9, 1e-6)
ACCESSOR_USES = {"indices", "input", "output", "inverseBindMatrices"}


def used_accessors(model):
    """Places that name an accessor."""
    return [one for one in places(model) if isinstance(one.value, int) and not isinstance(one.value, bool) and
            (one.name in ACCESSOR_USES or one.kind[-2:-1] == ("attributes",) or "targets" in one.kind[-3:])]


def values_of(model, accessor):
    """Buffer, offset of the first value, stride, format and number of values; None where they are not in a buffer."""
    view = at(model.document, "bufferViews", at(accessor, "bufferView"))
    code, width = FORMATS.get(hashable(at(accessor, "componentType"))), COMPONENTS.get(hashable(at(accessor, "type")))
    data = model.buffer(at(view, "buffer")) if isinstance(at(view, "buffer"), int) else None
    places_in = [at(view, "byteOffset") or 0, at(accessor, "byteOffset") or 0, at(view, "byteStride") or 0]
    count = at(accessor, "count")
    if data is None or code is None or width is None or not all(isinstance(one, int) for one in (*places_in, count)):
        return None
    size = struct.calcsize(code)
    offset, stride = places_in[0] + places_in[1], places_in[2] or size * width
    if offset < 0 or stride < 0 or not 0 < count <= 1 << 22 or offset + stride * (count - 1) + size * width > len(data):
        return None
    return view["buffer"], offset, stride, code, width, count


def hashable(value):
    return None if isinstance(value, (dict, list)) else value


def change_values(model, random, _):
    """One, some or all values of an accessor."""
    place = choose(random, used_accessors(model))
    if place is None:
        return None
    found = values_of(model, at(model.document, "accessors", place.value))
    if found is None:
        return None
    buffer, offset, stride, code, width, count = found
    data = bytearray(model.buffer(buffer))
    size = struct.calcsize(code)
    extreme = random.choice(FLOATS) if code == "f" else random.choice((0, 1, count - 1, count, count + 1, (1 << 8 * size) - 1))
    share = random.choice((0.0, 0.1, 1.0))
    axis = random.choice((None, *range(width)))
    elements = {random.randrange(count)} | {index for index in range(count) if random.random() < share}
    for index in elements:
        for component in range(width):
            if axis in (None, component):
                put(data, offset + stride * index + size * component, code, extreme)
    model.set_buffer(buffer, bytes(data))
    return f"{place.pointer}: {len(elements)} of {count} values are {extreme}"


def put(data, at_byte, code, value):
    if code != "f":
        size = struct.calcsize(code)
        data[at_byte:at_byte + size] = (value & ((1 << 8 * size) - 1)).to_bytes(size, "little")
    else:
        struct.pack_into("<f", data, at_byte, value)


def scale_values(model, random, _):
    """All values of an accessor of floats, multiplied."""
    place = choose(random, used_accessors(model))
    found = None if place is None else values_of(model, at(model.document, "accessors", place.value))
    if found is None or found[3] != "f":
        return None
    buffer, offset, stride, code, width, count = found
    data = bytearray(model.buffer(buffer))
    factor = random.choice((0.0, -1.0, 1e-20, 1e-10, 1e-4, 1e4, 1e10, 1e16, 1e19, 1e25, 1e30))
    for index in range(count):
        for component in range(width):
            where = offset + stride * index + 4 * component
            (value,) = struct.unpack_from("<f", data, where)
            try:
                struct.pack_into("<f", data, where, value * factor)
            except OverflowError:
                struct.pack_into("<f", data, where, float("inf"))
    model.set_buffer(buffer, bytes(data))
    return f"{place.pointer}: all {count} values times {factor}"


def damaged(data, random, begin=0, end=None):
    """`data` with some bytes between begin and end wrong, cut off, or more than there were; and what was done."""
    end = len(data) if end is None else min(end, len(data))
    if end <= begin:
        return data + b"\0", "one byte more"
    what = random.randrange(6)
    if what == 0:
        cut = random.randrange(begin, end)
        return data[:cut], f"cut off at {cut} of {len(data)}"
    if what == 1:
        return data[:-1], "without its last byte"
    if what == 2:
        return data + data[begin:end], "longer"
    changed = bytearray(data)
    count = random.choice((1, 1, 2, 8))
    # The beginning has sizes and counts.
    last = end if what == 3 else min(end, begin + 64)
    for _ in range(count):
        changed[random.randrange(begin, last)] = random.choice((0, 1, 127, 128, 255, random.randrange(256)))
    return bytes(changed), f"{count} bytes wrong"


def change_view(model, random, _):
    """Bytes of a buffer view, which may be compressed or an image."""
    views = [one for one in places(model) if one.kind == ("bufferViews", "*") and isinstance(one.value, dict)]
    if not views:
        return None
    place = random.choice(views)
    source = random.choice((place.value, *(at(place.value, "extensions", name) for name in
                                           ("EXT_meshopt_compression", "KHR_meshopt_compression")
                                           if isinstance(at(place.value, "extensions", name), dict))))
    numbers = [source.get("buffer"), source.get("byteOffset", 0), source.get("byteLength")]
    if not all(isinstance(one, int) for one in numbers):
        return None
    buffer, begin, length = numbers
    data = model.buffer(buffer)
    if data is None or begin < 0 or length < 0:
        return None
    data, what = damaged(data, random, begin, begin + length)
    model.set_buffer(buffer, data)
    return f"{place.pointer}: {what}"


def change_image(model, random, _):
    """Bytes of an image or of another file, inside or beside the scene file."""
    uris = [one for one in places(model) if one.name == "uri" and isinstance(one.value, str) and
            "buffers" not in one.kind and one.value.startswith("data:")]
    views = [view for view in (at(image, "bufferView") for image in model.document.get("images", []))
             if isinstance(view, int)] if isinstance(model.document.get("images"), list) else []
    choices = [("uri", one) for one in uris] + [("file", name) for name in model.files if not name.endswith(".bin")] + \
        [("view", view) for view in views]
    if not choices:
        return None
    kind, what = random.choice(choices)
    if kind == "file":
        model.files[what], said = damaged(model.files[what], random)
        return f"{what}: {said}"
    if kind == "uri":
        text, said = damaged(what.value.encode("utf-8", "replace"), random, what.value.find(",") + 1)
        what.value = text.decode("latin-1")
        return f"{what.pointer}: {said}"
    view = at(model.document, "bufferViews", what)
    numbers = [at(view, "buffer"), at(view, "byteOffset") or 0, at(view, "byteLength")]
    data = model.buffer(numbers[0]) if all(isinstance(one, int) for one in numbers) else None
    if data is None or numbers[1] < 0:
        return None
    data, said = damaged(data, random, numbers[1], numbers[1] + numbers[2])
    model.set_buffer(numbers[0], data)
    return f"image in buffer view {what}: {said}"


def change_buffer(model, random, _):
    """A whole buffer."""
    buffers = model.document.get("buffers")
    if not isinstance(buffers, list) or not buffers:
        return None
    index = random.randrange(len(buffers))
    data = model.buffer(index)
    if data is None:
        return None
    data, what = damaged(data, random)
    model.set_buffer(index, data)
    return f"/buffers/{index}: {what}"


def change_text(model, random, _):
    """Bytes of the scene file itself, whatever they are."""
    seed = random.random()

    def change(text):
        return damaged(text, type(random)(seed))[0]

    model.damage.append(change)
    return "bytes of the scene file"


MUTATIONS = {"values": change_values, "values scaled": scale_values, "bytes of a view": change_view,
             "bytes of an image": change_image, "bytes of a buffer": change_buffer, "bytes of the file": change_text}
