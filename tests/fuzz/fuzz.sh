#!/usr/bin/env bash
# Reads files of every format that are changed at random.
#   fuzz.sh build SOURCE BUILD    builds fuzz_formats with sanitizers
#   fuzz.sh run BUILD SECONDS [--seed N ...]
#   fuzz.sh hours HOURS [FOLDER]  with Clang's libFuzzer, which finds its own way into the code: an equal share of the time
#                                 for each format. What it learns is kept in FOLDER (default: build/fuzz_corpus).
set -euo pipefail
source_folder=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../.." && pwd)
# Sanitizers make everything five times as slow, and keep what was freed for a while.
export ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=0:max_allocation_size_mb=2048:quarantine_size_mb=16
export UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1

case ${1:-} in
  build)
    cmake -S "$2" -B "$3" -DCMAKE_BUILD_TYPE=RelWithDebInfo -DFLANEUR_ASAN=ON > "$3.log" 2>&1 || { cat "$3.log"; exit 1; }
    cmake --build "$3" --target fuzz_formats
    ;;
  run)
    "$2/bin/fuzz_formats" --seconds "$3" --most-s 5 --most-mib 2500 --failures "$2/failures" "${@:4}"
    ;;
  hours)
    build=$source_folder/build/libfuzzer
    corpus=${3:-$source_folder/build/fuzz_corpus}
    names=$(sed -n 's/.*Target{"\([a-z0-9]*\)".*/\1/p' "$source_folder/tests/fuzz/targets.cpp")
    cmake -S "$source_folder" -B "$build" -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ \
          -DCMAKE_BUILD_TYPE=RelWithDebInfo -DFLANEUR_ASAN=ON -DFLANEUR_FUZZ=ON -DFLANEUR_WERROR=OFF
    cmake --build "$build" --target $(printf 'fuzz_%s ' $names)
    each=$(awk -v hours="$2" -v n="$(wc -w <<< "$names")" 'BEGIN { printf "%d", hours * 3600 / n }')
    for name in $names; do
      mkdir -p "$corpus/$name" "$corpus/failures"
      dictionary=$source_folder/tests/fuzz/dictionaries/$name.dict
      seeds=$source_folder/tests/data/fuzz/$name
      "$build/bin/fuzz_$name" "$corpus/$name" $([[ -d $seeds ]] && echo "$seeds") \
          $([[ -f $dictionary ]] && echo "-dict=$dictionary") -max_len=1000000 -max_total_time="$each" -timeout=5 \
          -rss_limit_mb=2500 -artifact_prefix="$corpus/failures/$name-" || failed=1
    done
    exit "${failed:-0}"
    ;;
  *)
    sed -n '2,7s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
    exit 2
    ;;
esac
