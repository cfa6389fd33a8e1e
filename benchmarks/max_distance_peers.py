#!/usr/bin/env python3
"""Control points that `batten fit --max_distance` needs beside FITPACK and SISL, and the time.

    python3 benchmarks/max_distance_peers.py [--batten=build/batten] [--sisl=.../max_distance_sisl]
        [--files=a.csv,b.csv] [--bounds=1e-2,1e-3,1e-4]

A bound is a share of the longest side of the data's box. Each peer's own tolerance (s of splprep;
eeps of s1961) is bisected, in its logarithm, to the curve of the fewest control points whose
largest foot-point distance is within the bound. Distances of all curves are measured here, by one
plain route: dense samples, then Newton's steps from the nearest ones. Shown are control points
(free ones: a closed curve's are counted once) and processor seconds of the last call alone, with
the seconds of the whole bisection beside them.
"""
import argparse
import csv
import json
import os
import statistics
import subprocess
import tempfile
import time
import warnings

import numpy
from scipy.interpolate import BSpline, splprep
from scipy.spatial import cKDTree

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "data")
FILES = ["coasts/great_britain_10m.csv", "curves3d/gps_hike_xyz_open.csv",
         "animals/rhino_2000.csv", "animals/cat_2000.csv", "animals/squirrel_2000.csv",
         "animals/dolphin_2000.csv", "airfoils/naca2412_open.csv",
         "curves3d/protein_3aid_a_ca_open.csv"]
STEPS = 24  # of a bisection


def read_points(path):
    with open(path) as file:
        rows = [[float(x) for x in row] for row in list(csv.reader(file))[1:]]
    points = numpy.array(rows)
    keep = numpy.concatenate([[True], numpy.any(points[1:] != points[:-1], axis=1)])
    return points[keep]


def largest_distance(knots, coefficients, degree, begin, end, points):
    """At the feet that dense samples and Newton's steps find; never too small but for a foot that
    the samples miss."""
    curve = BSpline(knots, coefficients, degree)
    breaks = numpy.unique(numpy.clip(knots, begin, end))
    inner = numpy.linspace(0.0, 1.0, 65)[:-1]
    samples = (breaks[:-1, None] + numpy.diff(breaks)[:, None] * inner).ravel()
    samples = numpy.append(samples, end)
    tree = cKDTree(curve(samples))
    best = numpy.full(len(points), numpy.inf)
    _, nearest = tree.query(points, k=3)
    for choice in nearest.T:
        low, high = samples[numpy.maximum(choice - 1, 0)], samples[numpy.minimum(choice + 1, len(samples) - 1)]
        t = samples[choice]
        for _ in range(12):
            r, d1, d2 = curve(t) - points, curve(t, nu=1), curve(t, nu=2)
            best = numpy.minimum(best, numpy.linalg.norm(r, axis=1))
            g, h = (r * d1).sum(1), (d1 * d1).sum(1) + (r * d2).sum(1)
            h = numpy.where(h > 0.0, h, (d1 * d1).sum(1))
            t = numpy.clip(t - g / numpy.where(h > 0.0, h, 1.0), low, high)
        best = numpy.minimum(best, numpy.linalg.norm(curve(t) - points, axis=1))
    return best.max()


def bisect(try_tolerance, bound, low, high):
    """The fewest control points of all tries within the bound, the tolerance of the largest
    distance within it being sought; seconds of that try and of all."""
    best, total = None, 0.0
    for _ in range(STEPS):
        middle = (low * high) ** 0.5
        begin = time.process_time()
        result = try_tolerance(middle)
        seconds = time.process_time() - begin if result is None or result[2] is None else result[2]
        total += seconds
        if result is not None and result[1] <= bound:
            if best is None or result[0] <= best[0]:
                best = (result[0], seconds)
            low = middle
        else:
            high = middle
    return None if best is None else (best[0], best[1], total)


def fitpack(points, closed, degree, bound):
    size = numpy.ptp(points, axis=0).max()
    if closed:
        points = numpy.vstack([points, points[:1]])

    def attempt(s):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            begin = time.process_time()
            try:
                (knots, coefficients, _), _ = splprep(points.T, s=s, per=int(closed), k=degree)
            except Exception:
                return None
            seconds = time.process_time() - begin
        n = len(knots) - degree - 1 - (degree if closed else 0)
        distance = largest_distance(knots, numpy.array(coefficients).T, degree, knots[degree],
                                    knots[-degree - 1], points)
        return n, distance, seconds

    return bisect(attempt, bound, len(points) * (1e-4 * bound) ** 2, len(points) * (10.0 * bound) ** 2 + 1e-300 * size)


def sisl(program, points, closed, degree, bound):
    process = subprocess.Popen([program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    process.stdin.write(f"{points.shape[1]} {int(closed)} {degree} {len(points)}\n")
    process.stdin.write(" ".join(repr(x) for x in points.ravel().tolist()) + "\n")

    def attempt(tolerance):
        process.stdin.write(f"{tolerance!r}\n")
        process.stdin.flush()
        words = process.stdout.readline().split()
        if len(words) != 4:
            return None
        knots = numpy.array([float(x) for x in process.stdout.readline().split()])
        rows = numpy.array([float(x) for x in process.stdout.readline().split()])
        coefficients = rows.reshape(-1, points.shape[1])
        distance = largest_distance(knots, coefficients, degree, knots[degree], knots[-degree - 1], points)
        return int(words[0]), distance, float(words[1])

    result = bisect(attempt, bound, 0.01 * bound, 30.0 * bound)
    process.stdin.close()
    process.wait()
    return result


def ours(batten, path, points, closed, degree, bound, folder):
    out = os.path.join(folder, "fit.json")
    command = [batten, "fit", path, f"--max_distance={bound!r}", f"--degree={degree}", "--quiet",
               "--out=" + out] + (["--closed"] if closed else [])
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    with open(out) as file:
        result = json.load(file)
    spline = result["spline"]
    knots = numpy.array(spline["knots"])
    control_points = numpy.array(spline["control_points"])
    n = len(control_points)
    if closed:
        control_points = control_points[numpy.arange(n + degree) % n]
    distance = largest_distance(knots, control_points, degree, knots[degree], knots[-degree - 1], points)
    if not distance <= bound * (1.0 + 1e-9):
        raise SystemExit(f"{path}: {distance} is above the bound {bound}")
    return n, result["cpu_seconds"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--batten", default="build/batten")
    parser.add_argument("--sisl", default="")
    parser.add_argument("--files", default=",".join(FILES))
    parser.add_argument("--bounds", default="1e-2,1e-3,1e-4")
    parser.add_argument("--degree", type=int, default=3)
    parser.add_argument("--peers_only", action="store_true")
    arguments = parser.parse_args()
    ratios = {"FITPACK": [], "SISL": []}
    for name in arguments.files.split(","):
        path = name if os.path.exists(name) else os.path.join(DATA, name)
        points = read_points(path)
        closed = not os.path.splitext(path)[0].endswith("_open")
        size = numpy.ptp(points, axis=0).max()
        for share in map(float, arguments.bounds.split(",")):
            bound = share * size
            f = fitpack(points, closed, arguments.degree, bound)
            s = sisl(arguments.sisl, points, closed, arguments.degree, bound) if arguments.sisl else None
            print(name, share, "FITPACK", f, "SISL", s, flush=True)


main()
