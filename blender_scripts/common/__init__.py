"""Helpers that every Blender script of the pipeline shares."""
