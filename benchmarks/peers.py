"""Runs the benchmarks beside SciPy, in rounds, and prints one table of ratios against the targets.

The programs must be built; run.sh does that and then calls this. docs/benchmarks.md says what is
measured and why it is fair.
"""

import argparse
import dataclasses
import datetime
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np
from scipy.interpolate import make_lsq_spline, splprep

import targets

POINTS = 1000000
CONTROL_POINTS = 10000
PROGRAMS = ('evaluation_benchmark', 'direct_benchmark', 'iteration_benchmark')
UNIT_SECONDS = {'ns': 1e-9, 'us': 1e-6, 'ms': 1e-3, 's': 1.0}
# Ours and SciPy's fits are one if their energies agree to this, relatively.
SAME_ENERGY = 1e-9
# Wall time over CPU time above which neighbours have taken the processor, and with it the caches.
BUSY = 1.05
PACKAGES = ('g++', 'libeigen3-dev', 'libceres-dev', 'liblbfgs-dev', 'libbenchmark-dev',
            'python3-scipy', 'python3-numpy')


def noise(index):
    """As Noise() in noisy_loop.h, on arrays of uint64, whose products wrap around as they must."""
    word = np.uint64
    z = (index + word(1)) * word(0x9E3779B97F4A7C15)
    z = (z ^ (z >> word(30))) * word(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> word(27))) * word(0x94D049BB133111EB)
    z ^= z >> word(31)
    return (z >> word(11)).astype(float) * 2.0**-52 - 1.0


def wave(turns):
    """As Wave() in noisy_loop.h."""
    w = 2.0 * (turns - np.floor(turns)) - 1.0
    return 4.0 * w * (np.abs(w) - 1.0)


def loop_data(num_points):
    """Parameters and points, bit for bit those of MakeNoisyLoop() in noisy_loop.h."""
    index = 3 * np.arange(num_points, dtype=np.uint64)
    t = (np.arange(num_points) + 0.4 * noise(index)) / num_points
    t[0] = 0.0
    x = 3.0 * wave(t + 0.25) + 0.5 * wave(5.0 * t) + 0.01 * noise(index + np.uint64(1))
    y = 2.0 * wave(t) + 0.4 * wave(7.0 * t) + 0.01 * noise(index + np.uint64(2))
    return t, np.column_stack([x, y])


class SciPyFits:
    """The two fits by SciPy."""

    def __init__(self):
        self.t, self.points = loop_data(POINTS)
        inner = np.arange(1, CONTROL_POINTS - 3) / (CONTROL_POINTS - 3)
        self.open_knots = np.concatenate([np.zeros(4), inner, np.ones(4)])
        self.closed_knots = np.arange(-3, CONTROL_POINTS + 4) / CONTROL_POINTS
        # FITPACK wants the first point once more at the end of the period.
        self.closed_t = np.append(self.t, 1.0)
        self.closed_points = list(np.vstack([self.points, self.points[:1]]).T.copy())

    def open_spline(self):
        return make_lsq_spline(self.t, self.points, self.open_knots, 3, check_finite=False)

    def closed_spline(self, nest=None):
        return splprep(self.closed_points, u=self.closed_t, k=3, task=-1, s=0.0, per=1,
                       t=self.closed_knots, nest=nest, full_output=1, quiet=1)

    def closed_spline_in_less_memory(self):
        """As told by default, FITPACK makes room for as many knots as there are points."""
        return self.closed_spline(self.closed_knots.size)

    def energies(self):
        residuals = self.open_spline()(self.t) - self.points
        return {'open': float(np.sum(residuals**2)), 'closed': float(self.closed_spline()[1])}

    def measure(self, repetitions):
        """Seconds of CPU time per call, and wall time over CPU time."""
        sample, wall, cpu = {}, time.perf_counter(), time.process_time()
        for name, call, calls in (('make_lsq_spline', self.open_spline, repetitions),
                                  ('splprep', self.closed_spline, 1),
                                  ('splprep_nest', self.closed_spline_in_less_memory, 1)):
            start = time.process_time()
            for _ in range(calls):
                call()
            sample['scipy/' + name] = (time.process_time() - start) / calls
        return sample, (time.perf_counter() - wall) / (time.process_time() - cpu)


def run_program(path, *flags):
    """One program's numbers by name, counters as NAME:COUNTER, all times in seconds."""
    with tempfile.NamedTemporaryFile(suffix='.json') as out:
        # It complains about its own library's build type and about clock scaling on each start.
        done = subprocess.run([path, f'--benchmark_out={out.name}', *flags],
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        if done.returncode != 0:
            sys.exit(f'{os.path.basename(path)} failed:\n{done.stderr}')
        entries = json.load(out)['benchmarks']
    sample = {}
    for entry in entries:
        name = entry['name'].replace('/manual_time', '').replace('/iterations:1', '')
        if entry.get('error_occurred'):
            sys.exit(f'{name}: {entry["error_message"]}')
        # Our own clocks, where they are used, show as real time. They count CPU time, but for
        # what runs in several threads.
        clock = 'real_time' if '/manual_time' in entry['name'] else 'cpu_time'
        sample[name] = entry[clock] * UNIT_SECONDS[entry['time_unit']]
        for counter in targets.COUNTERS:
            if counter in entry:
                sample[f'{name}:{counter}'] = entry[counter]
    return sample


@dataclasses.dataclass
class Measurements:
    """Samples of every round for the two builds, and what was not measured in rounds."""
    generic: list = dataclasses.field(default_factory=list)
    native: list = dataclasses.field(default_factory=list)
    large: dict = dataclasses.field(default_factory=dict)
    busy: float = 1.0


def measure(options):
    result = Measurements()
    folders = {'generic': options.generic, 'native': options.native}
    # First, and each in a process of its own: a process starts with its parent's peak as its own.
    for solver in ('banded_cholesky', 'banded_qr'):
        result.large.update(run_program(os.path.join(options.generic, 'direct_benchmark'),
                                        f'--benchmark_filter=LargeFit/{solver}/'))
    scipy_fits = SciPyFits()
    began = time.monotonic()
    for number in range(options.rounds):
        if number > 0 and (time.monotonic() - began) * (1 + 1 / number) > options.max_seconds:
            print(f'time is up after {number} rounds', file=sys.stderr)
            break
        print(f'round {number + 1} of {options.rounds}', file=sys.stderr)
        peers, busy = scipy_fits.measure(1 if options.quick else 3)
        result.busy = max(result.busy, busy)
        for build, folder in folders.items():
            sample = dict(peers)
            for program in PROGRAMS:
                sample.update(run_program(os.path.join(folder, program),
                                          '--benchmark_filter=-LargeFit',
                                          f'--benchmark_min_time={options.min_time}'))
            getattr(result, build).append(sample)
    check_energies(scipy_fits.energies(), result.generic[-1], result.native[-1])
    return result


def check_energies(peer_energies, *samples):
    """Ends the program unless every direct fit found the minimum that SciPy found."""
    for sample in samples:
        for name, energy in sample.items():
            if name.endswith(':energy'):
                peer = peer_energies['closed' if '_closed' in name else 'open']
                if not abs(energy - peer) <= SAME_ENERGY * peer:
                    sys.exit(f'{name} is {energy!r}, SciPy has {peer!r}: not the same fit')


def shown(value):
    return f'{value:.3g}' if value < 1000 else f'{value:,.0f}'


def target_row(row, measured):
    values = {build: [row.value({**sample, **measured.large}) for sample in samples]
              for build, samples in (('generic', measured.generic), ('native', measured.native))}
    middle = statistics.median(values['generic'])
    share = middle / row.target
    met = share >= 1.0 if row.at_least else share <= 1.0
    verdict = f'{"met" if met else "**missed**"} by {100 * abs(share - 1.0):.0f} %'
    bound = f'{"at least" if row.at_least else "at most"} {row.target:,g}{row.unit}'
    spread = f'{shown(min(values["generic"]))} to {shown(max(values["generic"]))}'
    native = shown(statistics.median(values['native'])) if row.in_both_builds else ''
    return f'| {row.what} | {bound} | {shown(middle)} | {spread} | {verdict} | {native} |'


def time_row(what, name, unit, measured):
    def middle(samples):
        return shown(statistics.median(sample[name] for sample in samples) / UNIT_SECONDS[unit])
    if name in measured.large:
        return f'| {what} | {unit} | {middle([measured.large])} | |'
    return f'| {what} | {unit} | {middle(measured.generic)} | {middle(measured.native)} |'


def machine():
    """The processor's name and the versions of what was measured."""
    with open('/proc/cpuinfo', encoding='utf-8') as cpuinfo:
        model = next((line.split(':', 1)[1].strip() for line in cpuinfo
                      if line.startswith('model name')), 'unknown')
    asked = subprocess.run(['dpkg-query', '-W', '-f', '${Package} ${Version}, ', *PACKAGES],
                           stdout=subprocess.PIPE, text=True, check=False)
    return [f'Processor: {model}', '', f'Packages: {asked.stdout.rstrip(", ")}']


def version():
    """The commit that the tree is of, where git knows it, and today's date."""
    folder = os.path.dirname(os.path.abspath(__file__))
    asked = subprocess.run(['git', '-C', folder, 'describe', '--always', '--dirty', '--abbrev=12'],
                           stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=False)
    commit = asked.stdout.strip() if asked.returncode == 0 else 'unknown'
    return f'Commit {commit}, {datetime.date.today().isoformat()}'


def render(measured, options):
    lines = ['# Benchmark results', '',
             'Written by `benchmarks/run.sh`; `docs/benchmarks.md` says what the rows mean.', '',
             version(), '', *machine(), '',
             f'Medians; rounds: {len(measured.generic)}. Cubic, 2-D, 1e6 points, 1e4 control '
             'points unless a row says otherwise. One thread and CPU time, or two threads and time '
             'on the wall where a row says so.', '']
    if options.quick:
        lines += ['**A trial (`--quick`): not for the record.**', '']
    if measured.busy > BUSY:
        lines += ['**The machine was busy (wall time up to '
                  f'{measured.busy:.2f} times CPU time): not for the record.**', '']
    lines += ['## Targets', '',
              'Judged in the build for any x86-64; a build with `-march=native` beside.', '',
              '| what | target | measured | rounds, lowest to highest | verdict | native |',
              '| --- | --- | --- | --- | --- | --- |']
    lines += [target_row(row, measured) for row in targets.TARGETS]
    lines += ['', '## Times and other ratios', '', '| what | unit | measured | native |',
              '| --- | --- | --- | --- |']
    lines += [time_row(*row, measured) for row in targets.TIMES]
    for row in targets.RATIOS:
        generic, native = (shown(statistics.median(row.value(sample) for sample in samples))
                           for samples in (measured.generic, measured.native))
        lines.append(f'| {row.what} | | {generic} | {native} |')
    return '\n'.join(lines) + '\n'


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--generic', required=True, help='folder of the programs for any x86-64')
    parser.add_argument('--native', required=True, help='folder of the programs for this processor')
    parser.add_argument('--out', help='Markdown file to write beside what is printed')
    parser.add_argument('--rounds', type=int, default=7)
    parser.add_argument('--max_seconds', type=float, default=240.0,
                        help='no round begins that would probably end later')
    parser.add_argument('--min_time', type=float, default=0.1,
                        help='seconds per benchmark and round')
    parser.add_argument('--quick', action='store_true',
                        help='one short round, to see that it works')
    options = parser.parse_args()
    if options.quick:
        options.rounds, options.min_time = 1, 0.01
    text = render(measure(options), options)
    print(text, end='')
    if options.out:
        with open(options.out, 'w', encoding='utf-8') as out:
            out.write(text)


if __name__ == '__main__':
    main()
