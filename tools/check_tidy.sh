#!/usr/bin/env bash
# Runs clang-tidy over the sources of the libraries and the program.
#   tools/check_tidy.sh
# Tests are left out: they take as long as all the rest, and nothing ships in them.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# A configuration of its own: clang does not read GCC's precompiled headers.
build=build-tidy
cmake --preset release -B "$build" -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON -DBATTEN_BUILD_TESTS=OFF \
  >/dev/null
cmake --build "$build" --target batten_report_assets >/dev/null
# It reports its progress, colours and thousands of hidden warnings of other people's headers even
# where nobody looks; only what it found is of interest.
run-clang-tidy -p "$build" -j 2 -quiet -extra-arg=-Wno-unknown-warning-option \
  "^$PWD/(splines|cost_functions|problems|solvers|experiments|tools)/" 2>&1 |
  sed -E 's/\x1b\[[0-9;]*m//g; /^\S*clang-tidy(-[0-9]+)? /d; /^[0-9]+ warnings?( and [0-9]+ errors?)? generated\.$/d'
