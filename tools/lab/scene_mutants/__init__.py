"""Mutants of scenes, and what the program makes of them, for tools/lab/mutate_scenes."""
