"""The studio, an application of spincyl: pictures, films, pages, sound and scenes of bodies and motions.

The files here have the look and the sound of a body: its shape, its poses, films, photographs, scenes for
other programs, and cards for a notebook. `plot` has the figures, and `pages` the pages for a browser. Users
find them as `spincyl.plot`, `spincyl.view`, `spincyl.play`, `spincyl.exposure`, `spincyl.scene`, and as
methods of a motion.
"""
