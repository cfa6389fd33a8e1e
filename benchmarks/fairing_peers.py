#!/usr/bin/env python3
"""Times the fairing fits of build/batten beside SciPy's make_smoothing_spline and the dense method.

    python3 benchmarks/fairing_peers.py [--batten=build/batten] [--rounds=3] [--sizes=10000,1000000]
        [--smoothing=build-bench/benchmarks/smoothing_benchmark]

Processor seconds of the solvers alone, one after the other in each round; a ratio is formed within
its round, and the median of the rounds is shown with the lowest and the highest. Both sides solve
the same problem: one cubic with a knot at every place, one given weight, two coordinates (SciPy
coordinate by coordinate). Their curves are compared first: no times without the same answer.

Beside SciPy both sides have solved before in their process; what the first solve of a process takes
(`batten fit`), with memory that the system hands out page by page, is shown behind it.
"""
import argparse
import json
import math
import os
import statistics
import subprocess
import tempfile
import time

import numpy
from scipy.interpolate import BSpline, make_smoothing_spline


# Those of smoothing_benchmark.cc.
SIZES = ("10000", "1000000")


def make_data(n):
    """Places in [0, 1] and two noisy waves, from a linear congruence."""
    state = 12345
    numbers = []
    for _ in range(3 * n):
        state = (6364136223846793005 * state + 1442695040888963407) % 2**64
        numbers.append((state >> 11) / 2.0**53)
    steps = 0.5 + numpy.array(numbers[: n - 1])
    t = numpy.concatenate([[0.0], numpy.cumsum(steps)]) / steps.sum()
    t[-1] = 1.0
    x = numpy.sin(9 * t) + 0.1 * numpy.array(numbers[n : 2 * n])
    y = numpy.cos(7 * t) + 0.1 * numpy.array(numbers[2 * n :])
    return t, x, y


def write_data(folder, t, x, y):
    with open(os.path.join(folder, "points.csv"), "w") as file:
        file.write("x,y,t\n")
        file.writelines(f"{a!r},{b!r},{c!r}\n" for a, b, c in zip(x.tolist(), y.tolist(), t.tolist()))
    with open(os.path.join(folder, "knots.txt"), "w") as file:
        knots = [0.0] * 3 + t.tolist() + [1.0] * 3
        file.write("\n".join(repr(u) for u in knots) + "\n")


def fit(batten, folder, solver, weight):
    """With the given weight, or with "gcv" by that rule."""
    out = os.path.join(folder, "fit.json")
    fairing = (["--fairing=gcv"] if weight == "gcv" else
               [f"--terms=interpolation,fairing/weight={weight!r}"])
    subprocess.run(
        [batten, "fit", os.path.join(folder, "points.csv"), "--parameters=given",
         "--knots=" + os.path.join(folder, "knots.txt"), "--quiet", "--solver=" + solver,
         *fairing, "--out=" + out],
        check=True, stdout=subprocess.DEVNULL)
    with open(out) as file:
        return json.load(file)


def check_curve(result, theirs, t):
    spline = result["spline"]
    ours = BSpline(numpy.array(spline["knots"]), numpy.array(spline["control_points"]), 3)
    places = numpy.linspace(t[0], t[-1], 2001)
    worst = max(numpy.abs(ours(places)[:, c] - theirs[c](places)).max() for c in (0, 1))
    # SciPy solves normal equations, whose condition grows with the fourth power of the number of
    # points at a fixed number of bends: at 1e6 of them 1e12 and more, which leaves four digits.
    if worst > (1e-6 if len(t) <= 100_000 else 1e-3):
        raise SystemExit(f"the curves differ by {worst}: no times")


def shown(name, ratios, wanted):
    text = f"{name}: {statistics.median(ratios):.1f} times ({min(ratios):.1f} to {max(ratios):.1f})"
    print(f"{text}, wanted {wanted}", flush=True)


def repeated(smoothing, solver, n, weight):
    """Seconds of a solve by the benchmark program, which repeats it."""
    name = f"Smooth/{solver}/{n}/{shown_weight(weight)}/manual_time"
    with tempfile.NamedTemporaryFile(suffix=".json") as out:
        subprocess.run([smoothing, f"--benchmark_filter=^{name}$", f"--benchmark_out={out.name}",
                        "--benchmark_min_time=2"],
                       check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        (entry,) = json.load(out)["benchmarks"]
    if entry.get("error_occurred"):
        raise SystemExit(f"{name}: {entry['error_message']}")
    return entry["real_time"] * 1e-3


def shown_weight(weight):
    """As smoothing_benchmark.cc writes it: 1e-8."""
    return f"{weight:.0e}".replace("e-0", "e-")


def compare_with_scipy(arguments, n, weight):
    t, x, y = make_data(n)
    wanted = {"banded_qr": 20, "banded_cholesky": 100}
    ratios = {solver: [] for solver in wanted}
    firsts = {solver: [] for solver in wanted}
    with tempfile.TemporaryDirectory() as folder:
        write_data(folder, t, x, y)
        make_smoothing_spline(t, x, lam=weight)
        for _ in range(arguments.rounds):
            begin = time.process_time()
            theirs = [make_smoothing_spline(t, values, lam=weight) for values in (x, y)]
            seconds = time.process_time() - begin
            for solver in wanted:
                result = fit(arguments.batten, folder, solver, weight)
                if solver == "banded_qr":
                    check_curve(result, theirs, t)
                firsts[solver].append(seconds / result["cpu_seconds"])
                ratios[solver].append(seconds / repeated(arguments.smoothing, solver, n, weight))
    for solver, least in wanted.items():
        shown(f"{n} points, weight {weight:g}, {solver} against make_smoothing_spline",
              ratios[solver], f"{least}; first solve of a process "
              f"{statistics.median(firsts[solver]):.1f}")


def compare_with_dense(batten, rounds):
    t, x, y = make_data(1000)
    ratios = []
    with tempfile.TemporaryDirectory() as folder:
        write_data(folder, t, x, y)
        for _ in range(rounds):
            dense = fit(batten, folder, "dense_qr", 1e-8)["cpu_seconds"]
            ratios.append(dense / fit(batten, folder, "banded_cholesky", 1e-8)["cpu_seconds"])
    shown("1000 points, banded_cholesky against dense_qr", ratios, "1000")


def time_choice(batten, n, rounds):
    """GCV's choice in the same kind of fit, in times of one solve at the weight that it finds."""
    t, x, y = make_data(n)
    ratios = []
    with tempfile.TemporaryDirectory() as folder:
        write_data(folder, t, x, y)
        for _ in range(rounds):
            choice = fit(batten, folder, "banded_qr", "gcv")["fairing_choice"]
            solve = fit(batten, folder, "banded_qr", choice["weight"])["seconds"]
            ratios.append(choice["seconds"] / solve)
    text = f"{statistics.median(ratios):.1f} solves ({min(ratios):.1f} to {max(ratios):.1f})"
    print(f"{n} points, choice by GCV from {choice['solves']} weights: {text}, wanted at most 30",
          flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--batten", default="build/batten")
    parser.add_argument("--smoothing", default="build-bench/benchmarks/smoothing_benchmark")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--sizes", default="10000,1000000")
    arguments = parser.parse_args()
    sizes = arguments.sizes.split(",")
    if not set(sizes) <= set(SIZES):
        parser.error(f"--sizes: found {arguments.sizes}; allowed: {', '.join(SIZES)}")
    for program in (arguments.batten, arguments.smoothing):
        if not os.path.isfile(program):
            parser.error(f"{program} is not there; build it first (docs/benchmarks.md)")
    load = os.getloadavg()[0]
    print(f"load average {load:.1f}" + (": **busy**" if load > math.ceil(0.5) else ""))
    compare_with_dense(arguments.batten, arguments.rounds)
    time_choice(arguments.batten, 10_000, arguments.rounds)
    for size in map(int, sizes):
        # The weights of smoothing_benchmark.cc, which says why.
        for weight in (1e-8 * size / 10000.0, 1e-12):
            compare_with_scipy(arguments, size, weight)


if __name__ == "__main__":
    main()
