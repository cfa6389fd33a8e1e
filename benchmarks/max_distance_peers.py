#!/usr/bin/env python3
"""Control points that `batten fit --max_distance` needs beside FITPACK and SISL, and the time.

    python3 benchmarks/max_distance_peers.py [--batten=build/batten] [--sisl=PROGRAM]
        [--files=a.csv,b.csv] [--bounds=1e-2,1e-3,1e-4] [--degree=3]

Wants Debian's python3-scipy and, for SISL, libsisl-dev; PROGRAM is max_distance_sisl of the build
with benchmarks. Without it SISL is left out, and said so.

A bound is a share of the longest side of the data's box. Each peer's own tolerance (s of splprep;
eeps of s1961, its best of three ways to share it) is bisected, in its logarithm, to the curve of
the fewest control points whose largest foot-point distance is within the bound. Distances of all
curves are measured here, by one plain route that knows nothing of Batten: dense samples, then
golden sections around the three nearest. Control points are the free ones: those that repeat on a
closed curve count once. Times are processor seconds, of the peer's one call that made its curve and
of its whole bisection, and of our search, all in this run.
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
FILES = ["coasts/great_britain_10m.csv", "coasts/iceland_10m.csv",
         "coasts/border_dr_congo_10m.csv", "coasts/river_marne_open.csv",
         "coasts/river_seine_open.csv", "coasts/terrain_contour_500p5m_open.csv",
         "curves3d/gps_hike_xyz_open.csv", "tracks/gps_ride_open.csv", "tracks/gps_run_open.csv",
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


def refine(curve, points, low, high):
    """Distances at the minima that golden sections find in [low, high], one of each point."""
    ratio = (5.0**0.5 - 1.0) / 2.0

    def squared(t):
        return ((curve(t) - points) ** 2).sum(1)

    a, b = high - ratio * (high - low), low + ratio * (high - low)
    fa, fb = squared(a), squared(b)
    for _ in range(45):
        left = fa < fb
        low, high = numpy.where(left, low, a), numpy.where(left, b, high)
        new = numpy.where(left, high - ratio * (high - low), low + ratio * (high - low))
        value = squared(new)
        a, b, fa, fb = (numpy.where(left, new, b), numpy.where(left, a, new),
                        numpy.where(left, value, fb), numpy.where(left, fa, value))
    return numpy.sqrt(numpy.minimum(fa, fb))


def largest_distance(knots, coefficients, degree, points):
    """At the feet that dense samples and golden sections between them find: never below the true
    one. Points whose nearest sample is nearer than the largest distance so far are left alone."""
    curve = BSpline(knots, coefficients, degree)
    begin, end = knots[degree], knots[-degree - 1]
    breaks = numpy.unique(numpy.clip(knots, begin, end))
    inner = numpy.linspace(0.0, 1.0, 257)[:-1]
    samples = (breaks[:-1, None] + numpy.diff(breaks)[:, None] * inner).ravel()
    samples = numpy.append(samples, end)
    sampled, nearest = cKDTree(curve(samples)).query(points, k=3)
    order = numpy.argsort(-sampled[:, 0])
    largest = 0.0
    for first in range(0, len(points), 100):
        chosen = order[first : first + 100]
        if sampled[chosen[0], 0] <= largest:
            break
        best = sampled[chosen, 0]
        for choice in nearest[chosen].T:
            low = samples[numpy.maximum(choice - 1, 0)]
            high = samples[numpy.minimum(choice + 1, len(samples) - 1)]
            best = numpy.minimum(best, refine(curve, points[chosen], low, high))
        largest = max(largest, best.max())
    return largest


def bisect(try_tolerance, bound, low, high):
    """The fewest control points of all tries within the bound; seconds of that try and of all. The
    largest tolerance that keeps the bound is sought; a distance that is not monotone in it may hide
    fewer, so every try counts."""
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
        distance = largest_distance(knots, numpy.array(coefficients).T, degree, points)
        return n, distance, seconds

    m = len(points)
    return bisect(attempt, bound, m * (1e-4 * bound) ** 2, m * (10.0 * bound) ** 2)


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
        distance = largest_distance(knots, coefficients, degree, points)
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
    distance = largest_distance(knots, control_points, degree, points)
    if not distance <= bound * (1.0 + 1e-9):
        raise SystemExit(f"{path}: {distance} is above the bound {bound}")
    return n, result["cpu_seconds"]


def shown(result):
    return "none" if result is None else f"{result[0]} ({result[1]:.3f} / {result[2]:.2f} s)"


def summarise(peer, rows, wanted):
    counts = [mine[0] / theirs[0] for mine, theirs in rows]
    calls = [mine[1] / theirs[1] for mine, theirs in rows]
    bisections = [mine[1] / theirs[2] for mine, theirs in rows]
    print(f"control points beside {peer}: {statistics.median(counts):.2f} times "
          f"({min(counts):.2f} to {max(counts):.2f}), wanted at most {wanted}")
    print(f"time beside one call of {peer}: {statistics.median(calls):.1f} times; "
          f"beside its bisection: {statistics.median(bisections):.2f} times "
          f"({min(bisections):.2f} to {max(bisections):.2f})")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--batten", default="build/batten")
    parser.add_argument("--sisl", default="")
    parser.add_argument("--files", default=",".join(FILES))
    parser.add_argument("--bounds", default="1e-2,1e-3,1e-4")
    parser.add_argument("--degree", type=int, default=3)
    arguments = parser.parse_args()
    load = os.getloadavg()[0]
    print(f"load average {load:.1f}" + (": **busy**" if load > 0.5 else ""))
    if not arguments.sisl:
        print("SISL is left out: --sisl names no program")
    rows = {"FITPACK": [], "SISL": []}
    print("file, bound: ours (s); FITPACK, SISL (s of one call / of the bisection)")
    with tempfile.TemporaryDirectory() as folder:
        for name in arguments.files.split(","):
            path = name if os.path.exists(name) else os.path.join(DATA, name)
            points = read_points(path)
            closed = not os.path.splitext(path)[0].endswith("_open")
            for share in map(float, arguments.bounds.split(",")):
                bound = share * float(numpy.ptp(points, axis=0).max())
                mine = ours(arguments.batten, path, points, closed, arguments.degree, bound, folder)
                theirs = {"FITPACK": fitpack(points, closed, arguments.degree, bound)}
                if arguments.sisl:
                    theirs["SISL"] = sisl(arguments.sisl, points, closed, arguments.degree, bound)
                peers = ", ".join(f"{peer} {shown(result)}" for peer, result in theirs.items())
                print(f"{name}, {share:g}: {mine[0]} ({mine[1]:.2f} s); {peers}", flush=True)
                for peer, result in theirs.items():
                    if result is not None:
                        rows[peer].append((mine, result))
    for peer, compared in rows.items():
        if compared:
            summarise(peer, compared, 1)


main()
