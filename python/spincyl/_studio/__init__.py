"""What bodies and motions look and sound like: shapes, poses, films, photographs, scenes, cards, sound."""
