#!/usr/bin/env bash
# From a fresh clone to a first comparison and a first fit: installs, builds, runs; results in out/demo.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

tools/setup.sh run
cmake --preset release -DBATTEN_BUILD_TESTS=OFF
cmake --build --preset release

mkdir -p out/demo
build/batten compare --problems=rhino,rhino_interpolation --solvers=all --out=out/demo
build/batten fit data/animals/rhino_100.csv --closed --control_points=80 --solver=lbfgs \
  --out=out/demo/fit.json --trace=out/demo/trace.csv --figure=out/demo/rhino.svg

echo
echo "Results are in $PWD/out/demo:"
find out/demo -type f | sort | sed 's/^/  /'
echo "The program is build/batten; try: build/batten --help"
