"""Generates the scenes of scenes/ from published measurements and closed forms. Entry: tools/gen/make_scenes.py."""
