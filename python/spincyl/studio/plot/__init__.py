"""Figures of bodies and motions with matplotlib; users find them in `spincyl.plot`."""
