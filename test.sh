#!/usr/bin/env bash
# Installs what the tests need, builds everything in build/ and runs all tests.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

tools/setup.sh test
cmake --preset release -DBATTEN_BUILD_TESTS=ON
cmake --build --preset release
ctest --preset release
