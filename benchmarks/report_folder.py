#!/usr/bin/env python3
"""Writes a folder as `batten compare` and `batten bench` leave it, to measure and test the report.

    benchmarks/report_folder.py FOLDER [--cells=2000]

Made-up numbers, fixed seed: 20 problems of 80 control points, 20 solvers, 5 repetitions, traces of
20 to 2000 iterations, 40 iterates each, some runs that failed (with a log), are refuted, skipped or
overlapped, and options, messages and logs that hold HTML.
"""
import json
import math
import pathlib
import random
import sys

HOSTILE = "</script><b>bold</b><!-- <script> \u2028 \" ' & {{summary}}"
NUM_SOLVERS, NUM_REPETITIONS, NUM_CONTROL_POINTS, NUM_ITERATES = 20, 5, 80, 40


def circle(count, radius):
    angles = [2 * math.pi * k / count for k in range(count)]
    return [[radius * math.cos(a), radius * math.sin(a)] for a in angles]


def trace(rate, iterations, minimum):
    lines = ["iteration,energy_calls,gradient_calls,jacobian_calls,products,projections,seconds,"
             "cpu_seconds,energy,gradient_norm,step_norm,energy_interpolation"]
    for k in range(iterations + 1):
        energy = minimum + 100 * rate ** (2 * k)
        lines.append(f"{k},{k},{k + 1},0,0,0,{1e-5 * (k + 1)},{1e-5 * (k + 1)},{energy!r},"
                     f"{20 * rate ** k!r},{rate ** k!r},{energy!r}")
    return "\n".join(lines) + "\n"


def iterates(rate, iterations):
    lines = []
    for j in range(min(NUM_ITERATES, iterations + 1)):
        k = max(j, round(iterations * (j / (NUM_ITERATES - 1)) ** 2))
        points = circle(NUM_CONTROL_POINTS, 1 - 0.5 * rate ** k)
        lines.append(json.dumps({"iteration": k, "control_points": points}))
    return "\n".join(lines) + "\n"


def cell(index, generator):
    solver = index // NUM_REPETITIONS % NUM_SOLVERS
    problem = index // (NUM_REPETITIONS * NUM_SOLVERS)
    rate = 0.3 + 0.69 * generator.random()
    reached = math.ceil(math.log(1e-10) / math.log(rate))
    end = {3: "stalled", 7: "skipped", 11: "crashed"}.get(generator.randrange(40), "gradient_small")
    iterations = {"stalled": reached // 2, "gradient_small": reached}.get(end)
    minimum = 1.0 + problem
    row = {
        "format": "batten.cell/1", "problem": f"problem_{problem}", "solver": f"solver_{solver}",
        "stop": end, "message": "" if end == "gradient_small" else HOSTILE,
        "verified": None if iterations is None else generator.randrange(50) != 0, "failure": "",
        "iterations": iterations, "repetitions": 1, "repetition": index % NUM_REPETITIONS,
        "mode": "race", "gradient_tolerance": 1e-10, "max_iterations": 10000, "seed": 1,
        "options": {"memory": "5", "note": HOSTILE}, "notes": [{"name": "rate", "value": str(rate)}],
        "version": "0.1.0", "commit": "made-up", "compiler": "none",
        "minimum_energy": None if iterations is None else minimum,
        "findings": ["claim_fails"] if index % 97 == 5 else [],
        "overlapped": generator.randrange(20) == 0, "key": f"{index:016x}", "disagreement": None,
    }
    numbers = ["energy_calls", "gradient_calls", "jacobian_calls", "products", "projections",
               "setup_seconds", "solve_seconds", "seconds", "cpu_seconds", "start_energy",
               "start_gradient_norm", "energy", "gradient_norm", "gradient_floor", "gap", "rms", "max",
               "rms_orthogonal", "max_orthogonal", "audit_energy", "audit_gradient_norm"]
    for k, name in enumerate(numbers):
        row[name] = None if iterations is None else generator.random() * 10 ** (k % 4)
    if iterations is not None:
        energy = minimum + 100 * rate ** (2 * iterations)
        row.update(energy_calls=iterations, gradient_calls=iterations + 1, jacobian_calls=0,
                   products=0, start_energy=minimum + 100, energy=energy, audit_energy=energy,
                   seconds=1e-5 * iterations, start_gradient_norm=20,
                   gradient_norm=20 * rate ** iterations)
    return row, rate, minimum


def main():
    folder = pathlib.Path(sys.argv[1])
    options = dict(a[2:].split("=") for a in sys.argv[2:])
    for name in ("traces", "iterates", "curves", "logs"):
        (folder / name).mkdir(parents=True, exist_ok=True)
    generator = random.Random(20240501)
    rows = []
    for index in range(int(options.get("cells", 2000))):
        row, rate, minimum = cell(index, generator)
        rows.append(json.dumps(row))
        if row["stop"] == "crashed":
            (folder / "logs" / (row["key"] + ".log")).write_text(f"signal 11\n{HOSTILE}\n")
        if row["iterations"] is None:
            continue
        (folder / "traces" / (row["key"] + ".csv")).write_text(trace(rate, row["iterations"], minimum))
        (folder / "iterates" / (row["key"] + ".jsonl")).write_text(iterates(rate, row["iterations"]))
        (folder / "curves" / (row["problem"] + ".json")).write_text(json.dumps({
            "format": "batten.curve/1", "degree": 3, "periodic": True,
            "knots": [k - 3 for k in range(NUM_CONTROL_POINTS + 7)],
            "points": circle(100, 0.9989)}))
    (folder / "cells.jsonl").write_text("\n".join(rows) + "\n")
    (folder / "manifest.json").write_text(json.dumps({"format": "batten.manifest/1", "suite": HOSTILE}))


main()
