#!/usr/bin/env python3
"""Errors of robust fits of points of which a tenth is thrown away, as multiples of clean fits' errors.

    python3 benchmarks/robust_fits.py [--batten=build/batten] [--seeds=50] [--iterations=1000]

200 points on a closed curve of known shape with normal noise, 20 of them moved by up to half the
curve's size in each direction; 20 control points. A solver's robust fit (`loss_scale=mad`) is held
against its own plain fit of the points before they were moved, under the same guard against loops
where parameters are free or projected (--no_guard: neither has one). The error is that of the curve: the
root mean square of the distance to the truth, at the data's parameters where these are fixed, else
from the truth to the nearest of many samples. Prints a Markdown table of medians and worst seeds.
"""
import argparse
import bisect
import concurrent.futures
import json
import math
import os
import random
import statistics
import subprocess
import tempfile

POINTS, CONTROL_POINTS, DEGREE, SAMPLES = 200, 20, 3, 1500
SOLVERS = {
    'fixed': ['irls:banded_qr', 'irls:banded_cholesky', 'irls:dense_qr', 'lbfgs', 'ceres_lbfgs',
              'ceres_lm', 'newton'],
    'free': ['newton', 'foot_newton', 'lm_schur', 'varpro', 'pdm', 'tdm', 'sdm', 'gi',
             'anderson:pdm', 'lbfgs', 'ceres_lbfgs', 'ceres_lm', 'best_of:foot_newton'],
    'projected': ['newton', 'lm_schur', 'pdm', 'tdm', 'sdm', 'gi', 'anderson:pdm', 'lbfgs',
                  'ceres_lbfgs', 'ceres_lm']}
TERMS = {'fixed': 'interpolation', 'free': 'free_parameter', 'projected': 'foot_point'}


def make_points(seed):
    """The truth, its noisy points, and these with a tenth thrown away."""
    numbers = random.Random(seed)
    truth, clean = [], []
    for i in range(POINTS):
        a = 2 * math.pi * i / POINTS
        truth.append((math.cos(a) + 0.15 * math.cos(3 * a), 0.8 * math.sin(a)))
        clean.append([value + numbers.gauss(0, 0.01) for value in truth[-1]])
    thrown = [point[:] for point in clean]
    for i in numbers.sample(range(POINTS), POINTS // 10):
        thrown[i] = [value + numbers.uniform(-1, 1) for value in thrown[i]]
    return truth, clean, thrown


def curve_points(spline, parameters):
    """By de Boor's algorithm."""
    knots = spline['knots']
    control_points = spline['control_points'] + spline['control_points'][:DEGREE]
    points = []
    for t in parameters:
        span = min(max(bisect.bisect_right(knots, t) - 1, DEGREE), len(control_points) - 1)
        local = [control_points[span - DEGREE + j] for j in range(DEGREE + 1)]
        for level in range(1, DEGREE + 1):
            for j in range(DEGREE, level - 1, -1):
                low, high = knots[span - DEGREE + j], knots[span + 1 + j - level]
                share = (t - low) / (high - low)
                local[j] = [(1 - share) * a + share * b for a, b in zip(local[j - 1], local[j])]
        points.append(local[DEGREE])
    return points


def error(fit, kind, truth):
    spline = fit['spline']
    if kind == 'fixed':
        pairs = zip(curve_points(spline, fit['parameters']), truth)
        return math.sqrt(sum(math.dist(a, b) ** 2 for a, b in pairs) / POINTS)
    begin, end = spline['knots'][DEGREE], spline['knots'][-DEGREE - 1]
    curve = curve_points(spline, [begin + (end - begin) * i / SAMPLES for i in range(SAMPLES)])
    return math.sqrt(sum(min((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 for a in curve)
                         for b in truth) / POINTS)


def fit(options, points, kind, solver, term):
    with tempfile.TemporaryDirectory() as folder:
        data, out = os.path.join(folder, 'points.csv'), os.path.join(folder, 'fit.json')
        with open(data, 'w', encoding='utf-8') as file:
            file.write('x,y\n' + ''.join(f'{x!r},{y!r}\n' for x, y in points))
        ended = subprocess.run(
            [options.batten, 'fit', data, '--closed', f'--control_points={CONTROL_POINTS}',
             '--quiet', f'--parameter_kind={kind}', f'--max_iterations={options.iterations}',
             f'--terms={term}', f'--solver={solver}', f'--out={out}']
            + (['--guard=none'] if options.no_guard else []),
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
        if ended.returncode not in (0, 1):
            raise RuntimeError(ended.stderr)
        with open(out, encoding='utf-8') as file:
            return json.load(file)


def ratios(options, seed, kind, solver):
    truth, clean, thrown = make_points(seed)
    robust = [fit(options, thrown, kind, solver, f'{TERMS[kind]}/loss={loss}/loss_scale=mad')
              for loss in ('cauchy', 'tukey')]
    guards = [term['name'] for term in robust[0]['terms'] if term['name'].startswith('fairing')]
    # Solvers that take no plain fixed fit have banded_qr's.
    plain = error(fit(options, clean, kind, 'banded_qr' if kind == 'fixed' else solver,
                      ','.join([TERMS[kind]] + guards)), kind, truth)
    return [error(one, kind, truth) / plain for one in robust]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--batten', default='build/batten')
    parser.add_argument('--seeds', type=int, default=50)
    parser.add_argument('--iterations', type=int, default=1000)
    parser.add_argument('--kinds', default='fixed,free,projected')
    parser.add_argument('--no_guard', action='store_true')
    options = parser.parse_args()
    print('| parameters | solver | `cauchy`, median | worst | `tukey`, median | worst |')
    print('| --- | --- | --- | --- | --- | --- |')
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for kind in options.kinds.split(','):
            for solver in SOLVERS[kind]:
                rows = list(pool.map(lambda seed: ratios(options, seed, kind, solver),
                                     range(options.seeds)))
                cells = [f'{summary(column):.3g}' for column in zip(*rows)
                         for summary in (statistics.median, max)]
                print(f'| {kind} | `{solver}` | ' + ' | '.join(cells) + ' |', flush=True)


if __name__ == '__main__':
    main()
