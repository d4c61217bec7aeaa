# What ./demo and ./check share: where the project is, installing what is missing, building, and plain words on failure.
# Sourced by bash, never run on its own.
set -euo pipefail

project_folder=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build_folder=$project_folder/build/release
command_name=$(basename "$0")
current_step="starting"
start_s=$SECONDS

say() { printf '%s\n' "$*"; }

# step WORDS: what is being done now; also what a failure is reported as.
step() {
  current_step=$*
  printf '\n== %s  (%d:%02d)\n' "$*" $(((SECONDS - start_s) / 60)) $(((SECONDS - start_s) % 60))
}

fail() {
  trap - ERR
  printf '\n%s: failed while %s: %s\n' "$command_name" "$current_step" "$*" >&2
  exit 1
}
trap 'fail "the command above ended with status $?"' ERR

# Packages of packages.txt that are neither installed nor there as a command of that name.
missing_packages() {
  local package
  grep -v '^#' "$project_folder/packages.txt" | while read -r package; do
    [ -n "$package" ] || continue
    dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' && continue
    command -v "$package" >/dev/null 2>&1 && continue
    printf '%s ' "$package"
  done
}

install_packages() {
  step "installing Debian packages"
  command -v dpkg-query >/dev/null || fail "this is not a Debian system; install what packages.txt lists by hand"
  local missing as_root=()
  missing=$(missing_packages)
  if [ -z "$missing" ]; then
    say "all there"
    return
  fi
  say "missing: $missing"
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || fail "packages are missing and there is no sudo; as root: apt-get install $missing"
    as_root=(sudo)
  fi
  "${as_root[@]}" apt-get update -q ||
    fail "apt-get update did not succeed; is there a network, and may this user use sudo?"
  # shellcheck disable=SC2086  # one word a package
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends $missing ||
    fail "apt-get could not install: $missing"
}

# build [TARGET ...]: all targets when none is named.
build() {
  step "building"
  (cd "$project_folder" && cmake --preset release)
  local targets=()
  [ $# -eq 0 ] || targets=(--target "$@")
  cmake --build "$build_folder" "${targets[@]}"
}
