#!/usr/bin/env bash
# lint.sh [format|tidy] [--all|FILE ...]: whether sources are laid out as .clang-format says and free of what .clang-tidy finds.
# Neither word: both. The layout is looked at in all sources; clang-tidy looks at those that differ from the branch main and at
# what is not committed, with --all at all of pipeline/ and runtime/, else at the files named. Needs a configured build/release.
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/setup.sh"
cd "$project_folder"

part=both
case "${1:-}" in format | tidy) part=$1 && shift ;; esac

# Sources of pipeline/ and runtime/ that were changed, one a line.
changed_sources() {
  local base
  base=$(git merge-base HEAD main 2>/dev/null || git rev-parse HEAD)
  { git diff --name-only --diff-filter=d "$base" && git ls-files --others --exclude-standard; } | sort -u |
    { grep -E '^(pipeline|runtime)/.*\.cpp$' || true; }
}

check_format() {
  step "checking the layout of the sources"
  local wrong
  wrong=$(git ls-files '*.h' '*.cpp' | xargs clang-format --dry-run 2>&1 | { grep -oE '^[^ :]+\.(h|cpp)' || true; } | sort -u)
  [ -z "$wrong" ] && return
  printf '%s\n' "$wrong"
  fail "these files are laid out otherwise than .clang-format says; run: clang-format -i FILE"
}

check_faults() {
  step "running clang-tidy"
  [ -e "$build_folder/compile_commands.json" ] || fail "there is no build to take compiler options from; run: cmake --preset release"
  local sources=()
  case "${1:-}" in
    --all) mapfile -t sources < <(git ls-files 'pipeline/*.cpp' 'runtime/*.cpp') ;;
    '') mapfile -t sources < <(changed_sources) ;;
    *) sources=("$@") ;;
  esac
  if [ ${#sources[@]} -eq 0 ]; then
    say "no source was changed"
    return
  fi
  # Removed: what says how many warnings of the system's headers were not shown.
  printf '%s\n' "${sources[@]}" | xargs -P "$(nproc)" -n 4 clang-tidy -p "$build_folder" --quiet 2> >(grep -v 'warnings\? \(generated\|treated\)' >&2) ||
    fail "clang-tidy found what is listed above"
}

[ "$part" = tidy ] || check_format
[ "$part" = format ] || check_faults "$@"
