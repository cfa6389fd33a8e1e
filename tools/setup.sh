#!/usr/bin/env bash
# Installs what is missing to build Batten on Debian 12. Needs no root when nothing is missing.
#   tools/setup.sh run|test|ci|page|bench    (test, page and bench include run, ci includes test)
set -euo pipefail

fail() {
  echo "setup.sh: $*" >&2
  exit 1
}

run=(cmake g++ gnuplot-nox libceres-dev libeigen3-dev libgflags-dev libgoogle-glog-dev
     libmd-dev libmd4c-dev libmd4c-html0-dev libpugixml-dev ninja-build nlohmann-json3-dev)
test=("${run[@]}" libgmock-dev libgtest-dev liblbfgs-dev libnlopt-dev)
ci=("${test[@]}" clang-format clang-tidy git parallel)
page=("${run[@]}" chromium fonts-dejavu-core python3)
bench=("${run[@]}" libbenchmark-dev liblbfgs-dev libsisl-dev python3-scipy)

case "${1-}" in
  run) wanted=("${run[@]}") ;;
  test) wanted=("${test[@]}") ;;
  ci) wanted=("${ci[@]}") ;;
  page) wanted=("${page[@]}") ;;
  bench) wanted=("${bench[@]}") ;;
  *) echo "setup.sh: unknown set of packages \"${1-}\"; known: run test ci page bench" >&2; exit 2 ;;
esac

command -v dpkg-query >/dev/null ||
  fail "no dpkg here; install by hand what docs/dependencies.md lists"

missing=()
for package in "${wanted[@]}"; do
  state=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$state" = installed ] || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

if [ "$(id -u)" -eq 0 ]; then
  as_root=(env)
elif command -v sudo >/dev/null; then
  as_root=(sudo env)
else
  fail "missing: ${missing[*]}; run me as root, or install sudo"
fi

apt() {
  "${as_root[@]}" DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=120 -qq "$@" \
    </dev/null
}

echo "Installing: ${missing[*]}"
apt update || fail "apt-get update failed; is the network up?"
# Only the last line of a long log is worth reading, and only when it failed.
log=$(mktemp)
trap 'rm -f "$log"' EXIT
apt install -y --no-install-recommends "${missing[@]}" >"$log" 2>&1 ||
  fail "apt-get install ${missing[*]} failed: $(grep -E '^(E|W):' "$log" | tail -n 1)"
