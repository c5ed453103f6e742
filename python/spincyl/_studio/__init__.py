"""Shapes, poses, films, photographs, scenes, notebook cards and sound of bodies and motions."""
