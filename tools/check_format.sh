#!/usr/bin/env bash
# Fails where clang-format would change a tracked C++ file. To mend: tools/check_format.sh --fix
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

mode=(--dry-run -Werror)
case "${1-}" in
  "") ;;
  --fix) mode=(-i) ;;
  *) echo "check_format.sh: unknown argument \"$1\"; known: --fix" >&2; exit 2 ;;
esac
git ls-files -z -- '*.h' '*.cc' | xargs -0 --no-run-if-empty clang-format "${mode[@]}"
