#!/usr/bin/env bash
# Runs clang-tidy over the sources of the libraries and the program.
#   tools/check_tidy.sh
# Tests are left out: they take as long as all the rest, and nothing ships in them.
#
# Most of its time goes into the headers of Ceres, Eigen and the standard library, so six sources are
# read as one. Where two of the six give one name to things of their own, each is read alone.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Configurations of their own: clang does not read GCC's precompiled headers.
alone=build-tidy
together=build-tidy-together
configure() {
  cmake --preset release -B "$1" -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON -DBATTEN_BUILD_TESTS=OFF \
    -DCMAKE_UNITY_BUILD="$2" -DCMAKE_UNITY_BUILD_BATCH_SIZE=6 >/dev/null
  cmake --build "$1" --target batten_report_assets >/dev/null
}
rm -rf "$together"  # it would keep units of files that are gone
configure "$alone" OFF
configure "$together" ON

# As in .clang-tidy, and the sources that a unit includes.
ours='(^|/)(splines|cost_functions|problems|solvers|experiments|tools)/[a-z0-9_]+\.(h|cc)$'

# tidy BUILD SOURCE: only what it found is of interest, not the thousands of warnings it hides.
tidy() {
  clang-tidy -p "$1" -quiet -extra-arg=-Wno-unknown-warning-option \
    -checks=-bugprone-suspicious-include -header-filter="$ours" "$2" 2>/dev/null
}

# check UNIT: status 1 on a finding; a source that cannot be read is one.
check() {
  local unit=$1 sources source found status=0
  mapfile -t sources < <(sed -n 's/^#include "\(.*\)"$/\1/p' "$unit")
  if tidy "$together" "$unit" >/dev/null; then
    printf 'clean: %s\n' "${sources[@]#"$PWD"/}"
    return 0
  fi
  for source in "${sources[@]}"; do
    if found=$(tidy "$alone" "$source"); then
      echo "clean: ${source#"$PWD"/}"
    else
      echo "$found"
      status=1
    fi
  done
  return "$status"
}
export alone together ours
export -f tidy check

find "$together" -path '*/batten*.dir/Unity/*.cxx' -print0 |
  xargs -0 -P 2 -I{} bash -c 'check "$PWD/$1"' check {}
