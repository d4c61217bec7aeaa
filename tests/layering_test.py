"""Includes go down only: each folder may include what the table below names, and itself."""
import pathlib
import re
import sys

BASE = "runtime/base"
CORE = "pipeline/core"
# The runtime's rooms from the ground up: what each one adds to what the rooms that it names may include themselves.
ROOMS = {
    "base": [],
    "text": ["base"],
    "tour_data": ["base"],
    "pack": ["tour_data"],
    "crowd": ["tour_data"],
    "control": ["crowd"],
    "town": ["control"],
    "walk": ["town"],
    "simulation": ["walk", "pack"],
    "render": ["pack", "text"],
    "show": ["simulation", "render"],
    "visit": ["show"],
    "web": ["visit"],
    "desktop": ["visit"],
    "likeness": ["render", "desktop"],
}
ALLOWED = {
    "pipeline/core": {BASE, "runtime/tour_data"},
    "pipeline/rig": {BASE, CORE},
    "pipeline/io": {BASE, CORE, "pipeline/rig"},
    "pipeline/avatar": {BASE, CORE, "pipeline/rig", "pipeline/io"},
    "pipeline/pictures": {BASE, CORE, "runtime/tour_data"},
    "pipeline/impostor": {BASE, CORE, "pipeline/io", "pipeline/pictures", "runtime/tour_data", "runtime/pack"},
    "pipeline/footprint": {BASE, CORE, "pipeline/io"},
    "pipeline/web": {BASE, CORE, "runtime/tour_data", "runtime/pack"},
    "pipeline/pack": {BASE, CORE, "pipeline/io", "runtime/tour_data", "runtime/pack"},
}
for room, below in ROOMS.items():
    ALLOWED[f"runtime/{room}"] = {f"runtime/{b}" for b in below}.union(*(ALLOWED[f"runtime/{b}"] for b in below))
# The shared libraries, a source file each: what stands above no room that a program has of its own.
ALLOWED["library"] = {"library", CORE, "pipeline/io", "pipeline/footprint", *(f"runtime/{room}" for room in ("base", "tour_data", "crowd", "control"))}
# The one room that knows a window, a driver and a loudspeaker.
SHELL_ONLY = re.compile(r"(GLFW/|EGL/|AL/|sndfile)")
# Libraries whose types stay inside source files, and that the runtime must not know at all.
PIPELINE_ONLY = re.compile(r"(CGAL|OpenMesh|OpenImageIO|tiny_gltf|clipper|boost|proj\.h)", re.IGNORECASE)
# Where threads come from: everybody else asks for a Jobs, for a web page has none, and std::async would wait there for ever.
THREADS = re.compile(r"std::(j?thread|this_thread|async|(shared_)?future|promise|packaged_task)\b|#\s*include\s*<(thread|future)>")
MAY_START_THREADS = {"runtime/base/jobs.cpp"}
INCLUDE = re.compile(r'^\s*#\s*include\s*["<]([^">]+)[">]', re.MULTILINE)


def folder_of(path):
    parts = path.split("/")
    return parts[0] if parts[0] == "library" else "/".join(parts[:2])


def violations(root):
    for path in sorted(found for folder in ("runtime", "pipeline", "library", "include") for found in root.glob(f"{folder}/**/*")):
        if path.suffix not in {".h", ".cpp", ".c"}:
            continue
        folder = folder_of(str(path.relative_to(root)))
        if folder.startswith("runtime/") and folder not in ALLOWED:
            yield f"{path}: {folder} is no room of the table"
        text = path.read_text(encoding="utf-8")
        if str(path.relative_to(root)) not in MAY_START_THREADS:
            for found in THREADS.finditer(text):
                yield f"{path}: {found[0]} belongs in {', '.join(MAY_START_THREADS)}; ask for a Jobs (runtime/base/jobs.h)"
        for name in INCLUDE.findall(text):
            target = folder_of(name)
            yield from check_include(path.relative_to(root), folder, name, target)


def check_include(path, folder, name, target):
    ours = name.startswith(("runtime/", "pipeline/", "library/"))
    if folder == "include/flaneur" and name not in {"stdbool.h", "stdint.h"} and not name.startswith("flaneur/"):
        yield f"{path}: a public header includes nothing that is not installed beside it: {name}"
    if ours and folder in ALLOWED and target != folder and target not in ALLOWED[folder]:
        yield f"{path}: {folder} must not include {name}"
    if not ours and SHELL_ONLY.match(name) and folder.startswith("runtime/") and folder != "runtime/desktop":
        yield f"{path}: {name} belongs in runtime/desktop"
    if ours and folder == "runtime/likeness" and target == "runtime/desktop" and name != "runtime/desktop/context.h":
        yield f"{path}: of runtime/desktop only context.h is for other programs"
    if not ours and PIPELINE_ONLY.search(name):
        if folder.startswith("runtime/"):
            yield f"{path}: the runtime must not include {name}"
        elif path.suffix == ".h":
            yield f"{path}: {name} belongs in a source file, not in a header"


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    found = list(violations(root))
    print("\n".join(found) or "includes go down only")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
