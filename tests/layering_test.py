"""Includes go down only: each folder may include what the table below names, and itself."""
import pathlib
import re
import sys

BASE = "runtime/base"
CORE = "pipeline/core"
ALLOWED = {
    "runtime/base": set(),
    "runtime/pack": {BASE},
    "runtime/crowd": {BASE},
    "runtime/control": {BASE, "runtime/crowd"},
    "runtime/render": {BASE, "runtime/pack"},
    "runtime/likeness": {BASE, "runtime/pack", "runtime/render"},
    "runtime/player": {BASE, "runtime/pack", "runtime/crowd", "runtime/control", "runtime/render"},
    "pipeline/core": {BASE},
    "pipeline/io": {BASE, CORE},
    "pipeline/avatar": {BASE, CORE, "pipeline/io"},
    "pipeline/impostor": {BASE, CORE, "pipeline/io", "runtime/pack"},
    "pipeline/footprint": {BASE, CORE, "pipeline/io"},
    "pipeline/pack": {BASE, CORE, "pipeline/io", "runtime/pack"},
}
# Libraries whose types stay inside source files, and that the runtime must not know at all.
PIPELINE_ONLY = re.compile(r"(CGAL|OpenMesh|OpenImageIO|tiny_gltf|clipper|boost|proj\.h)", re.IGNORECASE)
INCLUDE = re.compile(r'^\s*#\s*include\s*["<]([^">]+)[">]', re.MULTILINE)


def violations(root):
    for path in sorted([*root.glob("runtime/**/*"), *root.glob("pipeline/**/*")]):
        if path.suffix not in {".h", ".cpp", ".c"}:
            continue
        folder = "/".join(path.relative_to(root).parts[:2])
        for name in INCLUDE.findall(path.read_text(encoding="utf-8")):
            target = "/".join(name.split("/")[:2])
            yield from check_include(path.relative_to(root), folder, name, target)


def check_include(path, folder, name, target):
    ours = name.startswith(("runtime/", "pipeline/"))
    if ours and folder in ALLOWED and target != folder and target not in ALLOWED[folder]:
        yield f"{path}: {folder} must not include {name}"
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
