#!/usr/bin/env bash
# Fetches uPlot, which draws the curves of report.html, by npm into PREFIX: a fixed version, with the checksum that the
# registry published. Without it reports show the same plots as pictures.
#
#   cmake/fetch_uplot.sh PREFIX      -> PREFIX/uPlot.iife.min.js, uPlot.min.css, LICENSE
set -euo pipefail

version=1.6.32
sha512=2883159c6ebccefbb95d751b0b82d010f9e1c0ec41b8bc96d401eda66e882935c89a46cb824332fa369b8cb8122cc6ac36e186cd09bf7a9ded3a4c93c6989023

prefix=$(realpath -m "${1:?usage: fetch_uplot.sh PREFIX}")
[ -f "$prefix/LICENSE" ] && exit 0

say() { printf 'uplot: %s\n' "$*"; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

if ! command -v npm >/dev/null && command -v apt-get >/dev/null && [ "$(id -u)" = 0 ]; then
  say "installing npm"
  DEBIAN_FRONTEND=noninteractive apt-get -qq -y --no-install-recommends install npm >/dev/null </dev/null
fi
command -v npm >/dev/null || { say "no npm: reports will show pictures of their curves"; exit 1; }

cd "$work"
npm pack --silent "uplot@$version" >/dev/null
echo "$sha512  uplot-$version.tgz" | sha512sum --check --quiet
tar -xzf "uplot-$version.tgz"
mkdir -p "$prefix"
# The licence is copied last: it marks a complete folder.
cp package/dist/uPlot.iife.min.js package/dist/uPlot.min.css package/LICENSE "$prefix/"
say "uPlot $version is in $prefix"
