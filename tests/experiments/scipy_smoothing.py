#!/usr/bin/env python3
"""Writes scipy_smoothing.csv: smoothing splines by SciPy, of one coordinate over places in [0, 1].

Rows: name, kind, numbers. Kinds: x, y (the data); "weight W": the values of
make_smoothing_spline(x, y, lam=W) at the middles between neighbouring places; "gcv": the weight that
it chooses itself (lam=None). Made with SciPy 1.10.1; the random numbers are a linear congruence, so
that they are the same everywhere.
"""
import math
import os

import numpy
from scipy.interpolate import _bsplines, make_smoothing_spline


class Congruence:
    def __init__(self, seed):
        self.state = seed

    def uniform(self):
        self.state = (6364136223846793005 * self.state + 1442695040888963407) % 2**64
        return (self.state >> 11) / 2.0**53

    def normal(self):
        radius = math.sqrt(-2.0 * math.log(1.0 - self.uniform()))
        return radius * math.cos(2.0 * math.pi * self.uniform())


def data(seed, m, noise):
    random = Congruence(seed)
    steps = numpy.array([0.3 + random.uniform() for _ in range(m - 1)])
    x = numpy.concatenate([[0.0], numpy.cumsum(steps)]) / steps.sum()
    x[-1] = 1.0
    y = numpy.array([math.sin(7 * t) + 0.5 * t + noise * random.normal() for t in x])
    return x, y


def chosen_weight(x, y):
    chosen = []
    original = _bsplines._compute_optimal_gcv_parameter

    def record(*arguments):
        chosen.append(original(*arguments))
        return chosen[-1]

    _bsplines._compute_optimal_gcv_parameter = record
    make_smoothing_spline(x, y)
    _bsplines._compute_optimal_gcv_parameter = original
    return chosen[0]


def main():
    folder = os.path.dirname(os.path.abspath(__file__))
    with open(os.path.join(folder, "scipy_smoothing.csv"), "w") as file:
        for seed, m, noise in [(1, 12, 0.1), (2, 40, 0.2), (3, 40, 0.02), (4, 120, 0.3)]:
            name = f"m{m}_seed{seed}"
            x, y = data(seed, m, noise)
            middles = 0.5 * (x[1:] + x[:-1])
            rows = [("x", x), ("y", y)]
            for weight in (1e-9, 1e-6, 1e-4, 1e-3):
                rows.append((f"weight {weight!r}", make_smoothing_spline(x, y, lam=weight)(middles)))
            rows.append(("gcv", [chosen_weight(x, y)]))
            for kind, numbers in rows:
                file.write(",".join([name, kind] + [repr(float(v)) for v in numbers]) + "\n")


main()
