"""Generates the scenes of scenes/ from published measurements and closed forms. Entry: tools/make_scenes.py."""
