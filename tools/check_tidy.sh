#!/usr/bin/env bash
# Runs clang-tidy over the sources of the libraries and the program.
#   tools/check_tidy.sh [BUILD_DIR]     (default: build, which must have been configured)
# Tests are left out: they take as long as all the rest, and nothing ships in them.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

build=${1-build}
[ -f "$build/compile_commands.json" ] || {
  echo "check_tidy.sh: no $build/compile_commands.json; run: cmake --preset release" >&2
  exit 2
}
# It reports its progress, colours and thousands of hidden warnings of other people's headers even
# where nobody looks; only what it found is of interest.
run-clang-tidy -p "$build" -j 2 -quiet -extra-arg=-Wno-unknown-warning-option \
  "^$PWD/(splines|cost_functions|problems|solvers|experiments|tools)/" 2>&1 |
  sed -E 's/\x1b\[[0-9;]*m//g; /^\S*clang-tidy(-[0-9]+)? /d; /^[0-9]+ warnings?( and [0-9]+ errors?)? generated\.$/d'
