#!/usr/bin/env bash
# Builds the benchmarks twice, for any x86-64 and for this processor, runs both beside SciPy,
# libLBFGS and Ceres, prints the tables and writes them to benchmarks/results.md. Wants a machine
# with nothing else to do.
#   benchmarks/run.sh [--quick] [--out=FILE] [--build_root=DIR]
# --quick: one short round to see that all of it works; it writes a file only if --out names one.
set -euo pipefail

source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build_root=$source_dir
flags=()
out=
for argument in "$@"; do
  case "$argument" in
    --quick) flags+=(--quick) ;;
    --out=?*) out=$(realpath -m "${argument#*=}") ;;
    --build_root=?*) build_root=$(realpath -m "${argument#*=}") ;;
    *)
      echo "run.sh: unknown argument \"$argument\"; known: --quick --out=FILE --build_root=DIR" >&2
      exit 2
      ;;
  esac
done
if [ -z "$out" ] && [ ${#flags[@]} -eq 0 ]; then
  out=$source_dir/benchmarks/results.md
fi
[ -z "$out" ] || flags+=(--out="$out")

cd "$source_dir"
tools/setup.sh bench
for preset in bench native; do
  build_dir=$build_root/build-bench-$preset
  log=$build_dir.log
  mkdir -p "$build_root"
  echo "Building the benchmarks, preset $preset" >&2
  # What compilers warn of is judged elsewhere; GCC 12 does so in its own AVX-512 headers.
  if ! { cmake --preset "$preset" -B "$build_dir" -DBATTEN_BUILD_TESTS=OFF \
    -DBATTEN_WARNINGS_AS_ERRORS=OFF &&
    cmake --build "$build_dir" \
      --target evaluation_benchmark direct_benchmark iteration_benchmark; } >"$log" 2>&1; then
    tail -n 40 "$log" >&2
    exit 1
  fi
  rm "$log"
done

# Everything is measured in one thread.
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 PYTHONDONTWRITEBYTECODE=1
/usr/bin/python3 benchmarks/peers.py --generic="$build_root/build-bench-bench/benchmarks" \
  --native="$build_root/build-bench-native/benchmarks" "${flags[@]}"
[ -z "$out" ] || echo "Written to $out" >&2
