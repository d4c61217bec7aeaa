"""The documentation names what is there: paths, functions and types; the picture of the rooms is that of the includes.

    python3 tests/docs_test.py .             # what is wrong, one a line
    python3 tests/docs_test.py . --write     # draws the rooms in docs/architecture.md anew
"""
import pathlib
import re
import subprocess
import sys

import layering_test

DRAWING = "docs/architecture.md"
LIMITS = "docs/limits.md"
BEGIN, END = "<!-- rooms: begin -->", "<!-- rooms: end -->"
# A path from the root, wherever it stands in the text; capitals and * stand for any name.
FOLDERS = r"runtime|pipeline|tests|docs|assets_src|blender_scripts|scripts|packaging|include|library|samples|\.ci"
PATH = re.compile(rf"(?<![\w./-])(?:\./)?((?:{FOLDERS})/[\w./*-]*)")
LINK = re.compile(r"\]\((?!https?:|#)([^)#]+)")
CODE_WORD = re.compile(r"`([A-Za-z_:]+)(?:\(\))?`")
CAMEL = re.compile(r"(?:k[A-Z]|[A-Z][a-z0-9]+[A-Z])\w*")


def documents(root):
    return sorted([*root.glob("docs/*.md"), *root.glob("*.md"), *root.glob("assets_src/reference/*.toml")])


def tracked(root):
    """Files of the project, whether added to git yet or not."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard"]
    listed = subprocess.run(command, cwd=root, capture_output=True, text=True, check=False)
    if listed.returncode == 0:
        return [root / name for name in listed.stdout.splitlines()]
    return [p for p in root.rglob("*") if p.is_file()]


def exists(root, name):
    name = re.sub(r"(?<![A-Za-z])[A-Z]{2,}(?![a-z])", "*", name.rstrip(".,:"))
    return any(True for _ in root.glob(name.rstrip("/"))) if "*" in name else (root / name).exists()


def missing_paths(root):
    for document in documents(root):
        for number, line in enumerate(document.read_text(encoding="utf-8").splitlines(), 1):
            named = [match.group(1) for match in PATH.finditer(line)]
            linked = [str((document.parent / name).resolve().relative_to(root)) for name in LINK.findall(line)]
            for name in [*named, *linked]:
                if not exists(root, name):
                    yield f"{document.relative_to(root)}:{number}: there is no {name}"


def missing_words(root):
    """Names of functions, types and constants that the documentation for developers puts in backticks."""
    sources = "\n".join(path.read_text(encoding="utf-8", errors="replace") for path in tracked(root)
                        if path.suffix in {".h", ".cpp", ".c", ".py", ".txt", ".cmake", ".glsl"} and path.exists())
    known = set(re.findall(r"\w+", sources))
    for name in ("architecture", "extending", "glossary", "decisions"):
        document = root / f"docs/{name}.md"
        for number, line in enumerate(document.read_text(encoding="utf-8").splitlines(), 1):
            for word in CODE_WORD.findall(line):
                for part in word.split("::"):
                    if CAMEL.fullmatch(part) and part not in known:
                        yield f"{document.relative_to(root)}:{number}: nothing is called {part}"


def rooms(root):
    """{room: those it includes files of}, as the sources are."""
    arrows = {}
    for path in sorted([*root.glob("runtime/*/*"), *root.glob("pipeline/*/*")]):
        if path.suffix not in {".h", ".cpp", ".c"}:
            continue
        room = "/".join(path.relative_to(root).parts[:2])
        names = layering_test.INCLUDE.findall(path.read_text(encoding="utf-8"))
        used = {"/".join(name.split("/")[:2]) for name in names if name.startswith(("runtime/", "pipeline/"))}
        arrows.setdefault(room, set()).update(used - {room})
    return arrows


def reach(arrows, room):
    """All that a room includes files of, and they, and so on."""
    below, ahead = set(), list(arrows.get(room, ()))
    while ahead:
        other = ahead.pop()
        if other not in below:
            below.add(other)
            ahead += arrows.get(other, ())
    return below


def drawing(root):
    """Mermaid; an arrow that others imply is left out."""
    arrows = rooms(root)

    def node(room):
        return room.replace("/", "_")

    lines = ["```mermaid", "flowchart TD"]
    for half in ("pipeline", "runtime"):
        names = [room for room in arrows if room.startswith(half + "/")]
        lines += [f"  subgraph {half}", *(f"    {node(room)}[{room.split('/')[1]}]" for room in names), "  end"]
    for room, below in arrows.items():
        implied = set().union(*(reach(arrows, other) for other in below)) if below else set()
        lines += [f"  {node(room)} --> {node(other)}" for other in sorted(below - implied)]
    return "\n".join([*lines, "```"])


def split_drawing(text):
    before, _, rest = text.partition(BEGIN)
    drawn, _, after = rest.partition(END)
    return before, drawn.strip(), after


def outdated_drawing(root):
    drawn = split_drawing((root / DRAWING).read_text(encoding="utf-8"))[1]
    if drawn != drawing(root):
        yield f"{DRAWING}: the rooms are not as drawn; python3 tests/docs_test.py . --write draws them anew"


def limits(root):
    """{name: number} of runtime/base/limits.h."""
    text = re.sub(r"//.*", "", (root / "runtime/base/limits.h").read_text(encoding="utf-8"))
    found = {}
    for line in re.findall(r"inline constexpr \w+ ([^;]*);", text):
        for name, number in re.findall(r"(\w+) = ([^,]+)", line):
            found[name] = float(number)
    return found


def limits_told_otherwise(root):
    told = {}
    for line in (root / LIMITS).read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) == 3 and cells[2].startswith("`k"):
            told[cells[2].strip("`")] = float(cells[1])
    true = limits(root)
    for name in sorted({*true, *told}):
        if true.get(name) != told.get(name):
            yield f"{LIMITS}: {name} is {true.get(name)}, and told as {told.get(name)}"


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    if "--write" in sys.argv:
        before, _, after = split_drawing((root / DRAWING).read_text(encoding="utf-8"))
        (root / DRAWING).write_text(f"{before}{BEGIN}\n{drawing(root)}\n{END}{after}", encoding="utf-8")
    found = [*missing_paths(root), *missing_words(root), *outdated_drawing(root), *limits_told_otherwise(root)]
    print("\n".join(found) or "the documentation names what is there")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
