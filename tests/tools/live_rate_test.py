"""Tests of where tools/lab/live-rate moves the camera, and of what its figures are made of."""

import contextlib
import io
import math
import struct
import threading
import unittest

from tool_module import load_tool

tool = load_tool("lab/live-rate")


class Program:
    """Answers as 'etendue live' does: with a new image for every second question."""

    def __init__(self):
        self.asked = 0
        self.places = []

    def status(self, after=None):
        self.asked += 1
        return {"serial": self.asked, "images": [{"version": self.asked // 2}, None],
                "own_camera": [3, 5, 0, 0, 1, 0, 0, 1, 0]}

    def ask(self, path, body=None):
        return b"\x89PNG\r\n\x1a\n" + struct.pack(">I4sII", 13, b"IHDR", 80, 45)

    def orbit(self, place, stop):
        self.places.append(place)
        stop.wait()


class LiveRate(unittest.TestCase):
    def test_the_camera_goes_around_its_target(self):
        place = [3, 5, 0, 1, 1, 1, 0, 1, 0]
        for angle in (0, 1, 2.5):
            eye = tool.orbited(place, angle)
            self.assertAlmostEqual(math.hypot(eye[0] - 1, eye[2] - 1), math.hypot(2, 1))
            self.assertEqual(eye[3:], place[3:])
            self.assertEqual(eye[1], 5)
        self.assertGreater(math.dist(tool.orbited(place, 1)[:3], place[:3]), 1)

    def test_pauses_and_widths(self):
        times = [1 + 0.1 * i for i in range(20)] + [3.4]
        text = tool.summary(times, [40] * 15 + [80] * 6, 320)
        self.assertIn("8.3 images a second", text)
        self.assertIn("at most 100 ms", text)
        self.assertIn("median width 40 of 320", text)

    def test_an_image_counts_once_and_after_the_first_second(self):
        program = Program()
        times, widths = tool.measure(program, 0.05)
        self.assertGreater(len(times), 1)
        self.assertLess(len(times), program.asked / 2)
        self.assertGreaterEqual(min(times), 1)
        self.assertEqual(set(widths), {80})
        self.assertEqual(program.places, [[3, 5, 0, 0, 1, 0, 0, 1, 0]])
        self.assertEqual(threading.active_count(), 1)

    def test_what_is_no_picture_is_refused(self):
        with self.assertRaises(RuntimeError):
            tool.png_size(b"not found\n")

    def test_a_program_that_is_missing(self):
        output = io.StringIO()
        with self.assertRaises(SystemExit) as end, contextlib.redirect_stderr(output):
            tool.parsed_arguments(["--bin", "/no/such/folder"])
        self.assertEqual(end.exception.code, 2)
        self.assertIn("/no/such/folder/etendue is missing", output.getvalue())


if __name__ == "__main__":
    unittest.main()
