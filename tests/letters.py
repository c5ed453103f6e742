"""Count the letters in a photograph: bright patches, of which those with a hole are O's."""

import numpy as np
from scipy import ndimage


def letters(light, share=0.4):
    """(number of O's, number of X's) among the patches brighter than `share` of the brightest."""
    smooth = ndimage.gaussian_filter(np.asarray(light, float), 0.004 * light.shape[0])
    bright = smooth > share * np.percentile(smooth, 99.9)
    labels, count = ndimage.label(bright, np.ones((3, 3)))
    sizes = ndimage.sum_labels(bright, labels, np.arange(1, count + 1))
    found = {True: 0, False: 0}
    for k in np.flatnonzero(sizes > 0.4 * np.median(sizes)) + 1:
        patch = labels == k
        hole = ndimage.binary_fill_holes(patch).sum() - patch.sum()
        found[bool(hole > 0.05 * patch.sum())] += 1
    return found[True], found[False]
