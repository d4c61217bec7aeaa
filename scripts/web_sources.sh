#!/usr/bin/env bash
# web_sources.sh FOLDER: sources of libraries that the page compiles itself, for Debian has them only for its own
# machines. Of the very version whose headers are installed, from the archive, by apt and its signatures.
set -euo pipefail
folder=$(mkdir -p "$1" && cd "$1" && pwd)
version=$(dpkg-query -W -f '${source:Version}' libdraco-dev)
[ -e "$folder/draco/$version" ] && exit 0

apt=$(mktemp -d)
trap 'rm -rf "$apt"' EXIT
mkdir -p "$apt"/{lists/partial,cache/archives/partial,source}
echo "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] http://deb.debian.org/debian bookworm main" \
  > "$apt/sources.list"
apt_get() {
  apt-get -q -o Dir::Etc::sourcelist="$apt/sources.list" -o Dir::Etc::sourceparts=/dev/null \
    -o Dir::State::lists="$apt/lists" -o Dir::Cache="$apt/cache" -o APT::Sandbox::User= "$@"
}
{
  apt_get update
  cd "$apt/source"
  apt_get source --download-only "draco=$version"
} > "$apt/log" 2>&1 || {
  tail -n 3 "$apt/log" >&2
  echo "web_sources.sh: error: apt-get could not fetch the source of draco $version; is there a network?" >&2
  exit 2
}
rm -rf "$folder/draco"
mkdir -p "$folder/draco"
tar xf "$apt"/source/draco_*.orig.tar.* -C "$folder/draco" --strip-components=1 --wildcards '*/src/draco/*'
touch "$folder/draco/$version"
