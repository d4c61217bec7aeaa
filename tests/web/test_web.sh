#!/usr/bin/env bash
# test_web.sh build SOURCES FOLDER: all that a page is made of, in FOLDER. test_web.sh run PROGRAM.js: with node.
# Ends with status 77, skipped, where this machine has no Emscripten.
set -euo pipefail
for command in emcc node; do
  command -v "$command" > /dev/null || { echo "skipped: there is no $command (Debian packages emscripten, nodejs)"; exit 77; }
done
export NODE_PATH=/usr/share/nodejs${NODE_PATH:+:$NODE_PATH}  # where Debian keeps what Emscripten asks node for
case $1 in
  build)
    cmake -S "$2" -B "$3" -G Ninja -DCMAKE_BUILD_TYPE=Release \
      -DCMAKE_TOOLCHAIN_FILE=/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake
    cmake --build "$3"
    ;;
  run) node --no-experimental-fetch "$2" ;;
  *) echo "test_web.sh: error: '$1' is neither build nor run" >&2; exit 2 ;;
esac
