"""Checks a sphere map without Orbflow: no fold, and the sphere covered once."""

import numpy as np
from inputs import Points, Triangles


def folds_and_degree(sphere: Points, triangles: Triangles) -> tuple[int, float]:
    """Triangles with det <= 0, and the sum of the signed solid angles over 4 pi.

    Points are read from a file with rounded digits and put back on the unit sphere, so a triangle
    thinner than the rounding may count as a fold here that is none in the program.
    """
    unit = sphere / np.linalg.norm(sphere, axis=1, keepdims=True)
    a, b, c = (unit[triangles[:, k]] for k in range(3))
    det = np.einsum("ij,ij->i", a, np.cross(b, c))
    dots = sum(np.einsum("ij,ij->i", p, q) for p, q in ((a, b), (b, c), (c, a)))
    angles = 2 * np.arctan2(det, 1 + dots)
    return int((det <= 0).sum()), float(angles.sum() / (4 * np.pi))
