"""The targets that peers.py holds the measured times against, and the other rows it prints."""

import dataclasses

COUNTERS = ('per_point', 'per_iteration', 'per_evaluation', 'evaluations_per_iteration', 'energy',
            'peak_MiB')


@dataclasses.dataclass
class Row:
    """measured[over] / measured[under] / scale, names as in the programs' output."""
    what: str
    over: str
    under: str = ''
    target: float = 0.0
    at_least: bool = False
    unit: str = ''
    scale: float = 1.0
    in_both_builds: bool = True

    def value(self, sample):
        return sample[self.over] / (sample[self.under] if self.under else 1.0) / self.scale


LSQ = 'scipy/make_lsq_spline'
SPLPREP = 'scipy/splprep'
SPLPREP_NEST = 'scipy/splprep_nest'
CERES = 'CeresProblemEvaluate'
COMPILED = 'EnergyAndGradient/compiled'
UNCOMPILED = 'EnergyAndGradient/uncompiled'


STARTS = (('from a data set', 'FromDataSet'), ('solver alone', 'FromProblem'))


def faster(what, than, peer, ours, target=0.0):
    return Row(f'{what}: times faster than {than}', peer, ours, target, at_least=True)


def direct_fits(solver, form, than, peer, target=0.0):
    return [faster(f'`{solver}`, {form}, {text}', than, peer, f'{group}/{solver}_{form}', target)
            for text, group in STARTS]


def threaded_fits(form, than, peer, target):
    return [faster(f'`banded_cholesky` in 2 threads, {form}, {text}', than, peer,
                   f'{group}/banded_cholesky_{form}_2_threads', target)
            for text, group in STARTS]


# Iterations that cost about one of lspia, and how many times that they may.
FAMILY = {'jacobi_pia': 1.5, 'gauss_seidel_pia': 1.5, 'sor_pia': 1.5, 'polyak_lspia': 1.5,
          'nesterov_lspia': 1.5, 'chebyshev_lspia': 1.5, 'mlspia': 2.5, 'preconditioned_pia': 2.5}

TARGETS = [
    *direct_fits('banded_cholesky', 'open', 'SciPy `make_lsq_spline`', LSQ, 10),
    *direct_fits('banded_cholesky', 'closed', 'SciPy periodic `splprep`', SPLPREP, 100),
    *threaded_fits('open', 'SciPy `make_lsq_spline`', LSQ, 10),
    *threaded_fits('closed', 'SciPy periodic `splprep`', SPLPREP, 100),
    *direct_fits('banded_qr', 'open', 'SciPy `make_lsq_spline`', LSQ, 2.5),
    Row('E and g, compiled, per point', f'{COMPILED}:per_point', '', 6, unit=' ns', scale=1e-9),
    faster('E and g, compiled', '`ceres::Problem::Evaluate`', CERES, COMPILED, 30),
    faster('E and g, uncompiled', '`ceres::Problem::Evaluate`', CERES, UNCOMPILED, 3),
    *[Row(f'iteration of `{solver}`, 1e6 over 1e4 points',
          f'StepOnNormalBand/{solver}/1000000:per_iteration',
          f'StepOnNormalBand/{solver}/10000:per_iteration', 1.1)
      for solver in ('lspia', 'cg', 'lbfgs')],
    *[Row(f'iteration of `{solver}` over `lspia`, 1e4 points',
          f'StepOnNormalBand/{solver}/10000:per_iteration',
          'StepOnNormalBand/lspia/10000:per_iteration', target)
      for solver, target in FAMILY.items()],
    Row('`lbfgs` over libLBFGS per iteration, normal band', 'OurLbfgs/normal_band:per_iteration',
        'LibLbfgs/normal_band:per_iteration', 1.3),
    Row('`lbfgs` over libLBFGS per iteration, extended Rosenbrock, 2e4 variables',
        'OurLbfgs/rosenbrock:per_iteration', 'LibLbfgs/rosenbrock:per_iteration', 1.3),
    *[Row(f'peak memory, `{solver}`, 1e7 points, 1e5 control points',
          f'LargeFit/{solver}:peak_MiB', '', 2048, unit=' MiB', in_both_builds=False)
      for solver in ('banded_cholesky', 'banded_qr')],
]

# What, name in the output, unit.
TIMES = [
    ('reading points and parameters once', 'ReadInput', 'ms'),
    *[(f'`{solver}`, {form}, {text}', f'{group}/{solver}_{form}', 'ms')
      for solver in ('banded_cholesky', 'banded_qr') for form in ('open', 'closed')
      for text, group in STARTS],
    *[(f'`banded_cholesky` in 2 threads, {form}, {text}',
       f'{group}/banded_cholesky_{form}_2_threads', 'ms')
      for form in ('open', 'closed') for text, group in STARTS],
    ('SciPy `make_lsq_spline`', LSQ, 'ms'),
    ('SciPy periodic `splprep`', SPLPREP, 'ms'),
    ('SciPy periodic `splprep`, `nest` = number of knots', SPLPREP_NEST, 'ms'),
    *[(f'`{solver}`, open, from a data set, 1e7 points, 1e5 control points', f'LargeFit/{solver}',
       'ms')
      for solver in ('banded_cholesky', 'banded_qr')],
    ('E and g per point, compiled', f'{COMPILED}:per_point', 'ns'),
    ('E alone per point, compiled', 'EnergyAlone/compiled:per_point', 'ns'),
    ('E and g per point, uncompiled', f'{UNCOMPILED}:per_point', 'ns'),
    ('E alone per point, uncompiled', 'EnergyAlone/uncompiled:per_point', 'ns'),
    ('E and g per point, `ceres::Problem::Evaluate`', f'{CERES}:per_point', 'ns'),
    ('streaming the rows, per point', 'StreamRows/static_sizes:per_point', 'ns'),
    ('keeping the rows in memory, per point', 'CompileRows:per_point', 'ns'),
    ('building the normal band, per point', 'BuildNormalBand/static_sizes:per_point', 'ns'),
    ('g by the normal band, 1e4 points', 'GradientByNormalBand/10000', 'us'),
    ('g by the normal band, 1e6 points', 'GradientByNormalBand/1000000', 'us'),
    *[(f'iteration of `{solver}` on the normal band, {text} points',
       f'StepOnNormalBand/{solver}/{points}:per_iteration', 'us')
      for solver in ('lspia', 'cg', 'lbfgs')
      for text, points in (('1e4', 10000), ('1e6', 1000000))],
    *[(f'iteration of `{solver}`, 1e4 points', f'StepOnNormalBand/{solver}/10000:per_iteration',
       'us')
      for solver in FAMILY],
    *[(f'{solver}, {what}, {text}', f'{group}/{function}:{counter}', 'us')
      for text, function in (('normal band', 'normal_band'), ('Rosenbrock', 'rosenbrock'))
      for solver, group in (('`lbfgs`', 'OurLbfgs'), ('libLBFGS', 'LibLbfgs'))
      for what, counter in (('per iteration', 'per_iteration'),
                            ('per evaluation', 'per_evaluation'))],
    ('the function that both call, normal band', 'FunctionAlone/normal_band', 'us'),
    ('the function that both call, Rosenbrock', 'FunctionAlone/rosenbrock', 'us'),
]

RATIOS = [
    *[Row(f'evaluations per iteration, {solver}, {text}',
          f'{group}/{function}:evaluations_per_iteration')
      for text, function in (('normal band', 'normal_band'), ('Rosenbrock', 'rosenbrock'))
      for solver, group in (('`lbfgs`', 'OurLbfgs'), ('libLBFGS', 'LibLbfgs'))],
    Row('run-time over static sizes: E and g, uncompiled',
        'EnergyAndGradient/uncompiled_run_time_sizes', UNCOMPILED),
    Row('run-time over static sizes: streaming the rows', 'StreamRows/run_time_sizes',
        'StreamRows/static_sizes'),
    Row('run-time over static sizes: building the normal band', 'BuildNormalBand/run_time_sizes',
        'BuildNormalBand/static_sizes'),
    Row('run-time (degree 6) over static sizes (degree 5): E and g, compiled', 'CompiledOfDegree/6',
        'CompiledOfDegree/5'),
    *direct_fits('banded_cholesky', 'closed', '`splprep` with `nest`', SPLPREP_NEST),
    *direct_fits('banded_qr', 'closed', 'SciPy periodic `splprep`', SPLPREP),
]
