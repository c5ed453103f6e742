"""The lab, an application of spincyl: reads measured data, and fits bodies, losses and motions to them.

It reads tables, Tracker's projects and sound, compares steady states and spin-downs with those of a body, and
draws the comparison. Users find its names in `spincyl.data`, and its figures in `spincyl.plot`. The lab draws
with the studio, which does not know the lab.
"""
