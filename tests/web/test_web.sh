#!/usr/bin/env bash
# test_web.sh build SOURCES FOLDER: all that a page is made of, in FOLDER. test_web.sh run PROGRAM.js: with node.
# test_web.sh same WALK_THE_TOUR.js PLAYER PACK SECONDS: both walk everybody along the same ways, bit for bit.
# test_web.sh page FLANEUR PACK FOLDER_OF_TESTS PLAYER_FOLDER: the site of a tour in a browser.
# test_web.sh visitor FLANEUR PACK FOLDER_OF_TESTS PLAYER_FOLDER: somebody does whatever they like in it for a while.
# test_web.sh stills FLANEUR PACK FOLDER_OF_TESTS PLAYER_FOLDER DRAW_STILL.js: its pictures are those of the player.
# Ends with status 77, skipped, where this machine has no Emscripten or cannot fetch the sources of libraries.
set -euo pipefail
for command in emcc node; do
  command -v "$command" > /dev/null || { echo "skipped: there is no $command (Debian packages emscripten, nodejs)"; exit 77; }
done
export NODE_PATH=/usr/share/nodejs${NODE_PATH:+:$NODE_PATH}  # where Debian keeps what Emscripten asks node for
case $1 in
  run | same) [ -e "$2" ] || { echo "skipped: $2 was not built"; exit 77; } ;;&
  build)
    "$2/scripts/web_sources.sh" "$3/sources" || { echo "skipped: no sources of libraries"; exit 77; }
    cmake -S "$2" -B "$3" -G Ninja -DCMAKE_BUILD_TYPE=Release \
      -DCMAKE_TOOLCHAIN_FILE=/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake
    cmake --build "$3"
    ;;
  run) node --no-experimental-fetch "$2" ;;
  same)
    folder=$(mktemp -d)
    trap 'rm -rf "$folder"' EXIT
    node --no-experimental-fetch "$2" "$4" "$5" "$folder/web.csv"
    "$3" "$4" --headless --no-draw --seconds "$5" --trajectories "$folder/native.csv"
    [ "$(wc -l < "$folder/native.csv")" -gt 10000 ] || { echo "too few rows to compare"; exit 1; }
    cmp "$folder/web.csv" "$folder/native.csv"
    ;;
  page | visitor | stills)
    [ -e "$3" ] || { echo "skipped: $3 has not been baked"; exit 77; }
    command -v chromium > /dev/null || { echo "skipped: there is no chromium"; exit 77; }
    [ -e "$5/player.wasm" ] || { echo "skipped: the page's player was not built"; exit 77; }
    [ -e "$4/node_modules/puppeteer-core" ] || { echo "skipped: npm ci --prefix $4 has not been called"; exit 77; }
    [ "$1" != page ] || exec node "$4/page_test.mjs" "$2" "$3" "$5"
    folder=$(mktemp -d)
    trap 'rm -rf "$folder"' EXIT
    "$2" web "$3" -o "$folder/site" --player "$5"
    [ "$1" != visitor ] || { node "$4/random_visitor.mjs" "$folder/site" 45 7; exit; }
    mkdir "$folder/stills"
    stills=$4/../../data/stills
    node "$4/stills.mjs" "$folder/site" "$6" "$folder/stills" 320x180 "$stills"/*.toml
    python3 "$4/../../cli/stills_test.py" --compare "$folder/stills"
    ;;
  *) echo "test_web.sh: error: '$1' is neither build, run, same, page, visitor nor stills" >&2; exit 2 ;;
esac
