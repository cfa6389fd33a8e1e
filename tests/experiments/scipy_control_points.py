"""Writes scipy_control_points.csv, the answers that scipy_agreement_test.cc holds banded_qr against.

Run from the top folder: python3 tests/experiments/scipy_control_points.py (SciPy 1.10, NumPy 1.24).
"""

import numpy as np
from scipy.interpolate import BSpline, make_lsq_spline


def read(path, moved):
    """Points, moved by so many sizes of the data along each axis."""
    points = np.loadtxt('data/' + path, delimiter=',', skiprows=1)
    return points + moved * (points.max(0) - points.min(0)).max()


def closed(points, n):
    """Uniform cubic: the basis unrolled, the first three functions once more."""
    m = len(points)
    unrolled = BSpline.design_matrix(np.arange(m) / m, np.arange(-3, n + 4) / n, 3).toarray()
    matrix = unrolled[:, :n].copy()
    matrix[:, :3] += unrolled[:, n:]
    return np.linalg.lstsq(matrix, points, rcond=None)[0]


def clamped(points, n, power):
    """Averaged knots of The NURBS Book, 9.68 and 9.69."""
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1) ** power
    t = np.append(0, np.cumsum(steps)) / steps.sum()
    t[-1] = 1
    jd = np.arange(1, n - 3) * len(points) / (n - 3)
    i = jd.astype(int)
    a = jd - i
    inner = (1 - a) * t[i - 1] + a * t[i]
    return make_lsq_spline(t, points, np.r_[[0] * 4, inner, [1] * 4], 3).c


with open('tests/experiments/scipy_control_points.csv', 'w', encoding='ascii') as out:
    out.write('problem,moved,index,coordinates\n')
    for moved in (0.0, 1e6):
        fits = {
            'rhino': closed(read('animals/rhino_100.csv', moved), 80),
            'squirrel': closed(read('animals/squirrel_120.csv', moved), 80),
            'dolphin': closed(read('animals/dolphin_80.csv', moved), 40),
            'cat': closed(read('animals/cat_110.csv', moved), 83),
            'airfoil': clamped(read('airfoils/naca2412_open.csv', moved), 40, 1),
            'protein': clamped(read('curves3d/protein_3aid_a_ca_open.csv', moved), 60, 0.5),
        }
        for name, control_points in fits.items():
            for index, point in enumerate(control_points):
                out.write(f'{name},{moved!r},{index},' + ','.join(repr(float(c)) for c in point) +
                          '\n')
