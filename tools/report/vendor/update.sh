#!/usr/bin/env bash
# Fetches the pinned releases of Vega by npm, takes the minified bundles and the licences of all that
# is in them, and compares with SHA256SUMS.
#   tools/report/vendor/update.sh            fails unless every file is the one recorded
#   tools/report/vendor/update.sh --accept   after a change of versions below: records the new sums
set -euo pipefail
folder=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

packages=(vega@6.4.0 vega-lite@6.5.0 vega-embed@7.3.0)
bundles=(vega/build/vega.min.js vega-lite/build/vega-lite.min.js
         vega-embed/build/vega-embed.min.js)
# Types, and what only the command-line programs that come along need: in no bundle.
not_bundled=' ansi-regex ansi-styles cliui commander emoji-regex escalade get-caller-file
 get-east-asian-width string-width strip-ansi wrap-ansi y18n yargs yargs-parser d3-dsv iconv-lite
 node-fetch rw safer-buffer tr46 webidl-conversions whatwg-url '
is_bundled() {
  [[ $1 != @types/* && ! $not_bundled =~ [[:space:]]"${1%%/node_modules/*}"[[:space:]] &&
     ! $not_bundled =~ [[:space:]]"${1##*/node_modules/}"[[:space:]] ]]
}

case "${1-}" in
  '' | --accept) ;;
  *) echo "update.sh: found $1; allowed: nothing or --accept" >&2; exit 2 ;;
esac

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
echo '{"private": true}' >package.json
npm install --ignore-scripts --no-audit --no-fund --silent "${packages[@]}"

mkdir new
for bundle in "${bundles[@]}"; do
  # Maps of the minified text are not shipped: a page must ask for no other file.
  sed '/^\/\/# sourceMappingURL=/d' "node_modules/$bundle" >"new/$(basename "$bundle")"
done

{
  echo "Licences of ${packages[*]} and of what their minified bundles contain."
  find node_modules -mindepth 2 -maxdepth 4 -iname 'licen[sc]e*' -type f | LC_ALL=C sort |
    while read -r licence; do
      package=$(dirname "${licence#node_modules/}")
      is_bundled "$package" || continue
      version=$(node -p "require('./node_modules/$package/package.json').version")
      printf '\n==== %s %s\n\n' "$package" "$version"
      tr -d '\r' <"$licence" | sed 's/[ \t]*$//'
    done
} >new/LICENSES.txt

cd new
if [ "${1-}" = --accept ]; then
  sha256sum -- * >"$folder/SHA256SUMS"
else
  sha256sum --check --quiet "$folder/SHA256SUMS"
fi
cp -- * "$folder/"
echo "${packages[*]}: $(du -cb -- *.js | tail -n 1 | cut -f 1) bytes of script"
