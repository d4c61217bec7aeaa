#!/usr/bin/python3
"""Levels of detail beside those of gltfpack, OpenMesh, meshoptimizer and Blender, in one run.

avatar_levels.py --bin build/release/bin [--gltfpack DIR/node_modules/gltfpack/cli.js] AVATAR...

Every person is first made a plain glTF of 1.75 m by `flaneur avatar`; that file is what all programs
get, with all keys at 30 Hz. Errors are exact distances from points to triangles, in the bind pose and over 8 poses of the
walk. A program that leaves more than 2 % more triangles than asked is out of that cell (*).
"""
import argparse
import json
import pathlib
import resource
import struct
import subprocess
import sys
import tempfile
import time

TOOLS = ("flaneur", "gltfpack", "openmesh", "meshoptimizer", "blender")
HERE = pathlib.Path(__file__).resolve().parent
FIGURES = ("mean_mm", "greatest_mm", "posed_mean_mm", "posed_greatest_mm")


def split_glb(path):
    data = path.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20:20 + length]), data[20 + length:]


def write_glb(path, gltf, rest):
    text = json.dumps(gltf).encode()
    text += b" " * (-len(text) % 4)
    head = struct.pack("<4sII", b"glTF", 2, 20 + len(text) + len(rest))
    path.write_bytes(head + struct.pack("<I4s", len(text), b"JSON") + text + rest)


def run(*command):
    """The output, and the CPU seconds taken."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    start = time.monotonic()
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"avatar_levels: status {done.returncode}: {' '.join(map(str, command))}\n"
                 f"{done.stdout[-800:]}{done.stderr[-800:]}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return done.stdout, cpu, time.monotonic() - start


class Bench:
    def __init__(self, args, folder):
        self.args, self.folder = args, folder
        self.bin = pathlib.Path(args.bin)

    def path(self, *words):
        return self.folder / ("_".join(str(w) for w in words) + ".glb")

    def flaneur(self, source, output, *options):
        hide = ["--hide", self.args.hide] if self.args.hide else []
        return run(self.bin / "flaneur", "avatar", source, "-o", output, "--height", "1.75", *hide, *options)

    def plain(self, source):
        output = self.path(source.stem, "plain")
        self.flaneur(source, output, "--no-draco", "--ratios", "1")
        return output

    def ours(self, source, compressed):
        """One file a level: each level in the scene of its own copy."""
        chain = self.path(source.stem, "chain")
        ratios = ",".join(["1"] + [str(r) for r in self.args.ratios])
        plain = [] if compressed else ["--no-draco"]
        self.flaneur(source, chain, "--ratios", ratios, "--min-triangles", "1", *plain)
        gltf, rest = split_glb(chain)
        levels = [i for i, node in enumerate(gltf["nodes"]) if node.get("name", "").startswith("level")]
        skeleton = [n for n in gltf["scenes"][0]["nodes"] if n not in levels]
        if len(levels) != len(self.args.ratios) + 1:
            sys.exit(f"avatar_levels: {source}: {len(levels) - 1} levels instead of {len(self.args.ratios)}")
        outputs = []
        for level, ratio in zip(levels[1:], self.args.ratios):
            gltf["scenes"][0]["nodes"] = skeleton + [level]
            outputs.append(self.path(source.stem, "flaneur", ratio))
            write_glb(outputs[-1], gltf, rest)
        return outputs

    def gltfpack(self, plain):
        outputs = [self.path(plain.stem, "gltfpack", r) for r in self.args.ratios]
        for ratio, output in zip(self.args.ratios, outputs):
            run("node", self.args.gltfpack, "-i", plain, "-o", output, "-si", ratio, "-noq", "-kn")
        return outputs

    def library(self, tool, plain):
        outputs = [self.path(plain.stem, tool, r) for r in self.args.ratios]
        for ratio, output in zip(self.args.ratios, outputs):
            run(self.bin / "avatar_bench", "decimate", tool, plain, ratio, output)
        return outputs

    def blender(self, plain):
        outputs = [self.path(plain.stem, "blender", r) for r in self.args.ratios]
        settings = self.folder / "blender.json"
        settings.write_text(json.dumps({"input": str(plain), "weld_m": 1e-5,
                                        "outputs": [[r, str(o)] for r, o in zip(self.args.ratios, outputs)]}))
        run("blender", "--background", "--factory-startup", "--python-exit-code", 1,
            "--python", HERE / "decimate_in_blender.py", "--", settings)
        return outputs

    def levels(self, source):
        """By tool a list of figures, one a ratio."""
        plain = self.plain(source)
        files = {"flaneur": self.ours(source, self.args.compressed)}
        if self.args.gltfpack:
            files["gltfpack"] = self.gltfpack(plain)
        for tool in ("openmesh", "meshoptimizer"):
            files[tool] = self.library(tool, plain)
        if not self.args.no_blender:
            files["blender"] = self.blender(plain)
        files = {tool: paths for tool, paths in files.items() if tool in self.args.tools}
        flat = [path for paths in files.values() for path in paths]
        text, _, _ = run(self.bin / "avatar_bench", "measure", plain, self.args.samples, plain, *flat)
        original, *found = json.loads(text)
        wanted = [max(1, round(r * original["triangles"])) for r in self.args.ratios]
        figures, rest = {}, iter(found)
        for tool in files:
            figures[tool] = [dict(next(rest), wanted=w) for w in wanted]
        return original["triangles"], figures

    def sizes(self, source):
        plain = self.plain(source)
        ours, theirs = self.path(source.stem, "draco"), self.path(source.stem, "cc")
        self.flaneur(source, ours, "--ratios", "1")
        run("node", self.args.gltfpack, "-i", plain, "-o", theirs, "-cc", "-kn")
        parts = [file_parts(ours), file_parts(theirs)]
        for path, part in zip((ours, theirs), parts):
            part.update(json.loads(run(self.bin / "avatar_bench", "clips", plain, path)[0]))
        return parts


def view_bytes(gltf, views):
    total = 0
    for view in views:
        item = gltf["bufferViews"][view]
        total += item.get("extensions", {}).get("EXT_meshopt_compression", item)["byteLength"]
    return total


def file_parts(path):
    """Bytes of geometry, of animation and of the JSON."""
    gltf, _ = split_glb(path)
    geometry, animation = set(), set()
    for mesh in gltf["meshes"]:
        for primitive in mesh["primitives"]:
            draco = primitive.get("extensions", {}).get("KHR_draco_mesh_compression")
            if draco:
                geometry.add(draco["bufferView"])
                continue
            used = list(primitive["attributes"].values()) + [primitive["indices"]]
            geometry.update(gltf["accessors"][a]["bufferView"] for a in used)
    for item in gltf.get("animations", []):
        for sampler in item["samplers"]:
            animation.update(gltf["accessors"][sampler[k]]["bufferView"] for k in ("input", "output"))
    return {"geometry": view_bytes(gltf, geometry), "animation": view_bytes(gltf, animation),
            "animation_json": len(json.dumps(gltf.get("animations", []), separators=(",", ":"))),
            "file": path.stat().st_size}


def missed(cell):
    return abs(cell["triangles"] - cell["wanted"]) > 0.02 * cell["wanted"]


def print_levels(name, triangles, figures, ratios):
    print(f"\n{name}: {triangles} triangles, 1.75 m; millimetres: mean, Hausdorff | walking: mean, Hausdorff")
    for tool, cells in figures.items():
        for ratio, cell in zip(ratios, cells):
            numbers = "  ".join(f"{cell[f]:8.3f}" for f in FIGURES)
            print(f"  {tool:14} {100 * ratio:3.0f} %  {cell['triangles']:6}{'*' if missed(cell) else ' '} {numbers}")
    sys.stdout.flush()


def best_cells(all_figures, ratios):
    """Cells where ours has the lowest posed mean error, and how many there are."""
    won = total = 0
    for name, figures in all_figures.items():
        for i, ratio in enumerate(ratios):
            ours = figures["flaneur"][i]
            others = {t: c[i]["posed_mean_mm"] for t, c in figures.items()
                      if t != "flaneur" and c[i]["triangles"] <= 1.02 * c[i]["wanted"]}
            total += 1
            if not others or ours["posed_mean_mm"] <= min(others.values()) + 1e-4:
                won += 1
            else:
                tool = min(others, key=others.get)
                print(f"lost: {name} {ratio}: {ours['posed_mean_mm']:.4f}, {tool} {others[tool]:.4f}")
    return won, total


def print_sizes(bench, avatars):
    print("\nOurs / gltfpack -cc: bytes of geometry, of animation (times and values), of the channels' JSON; how far clips move vertices\n"
          "from where they should be, over all clips at 60 Hz: mean, greatest mm")
    for avatar in avatars:
        ours, theirs = bench.sizes(avatar)
        shares = {k: ours[k] / max(theirs[k], 1) for k in ("geometry", "animation")}
        print(f"  {avatar.stem:24} {ours['geometry']:7} / {theirs['geometry']:7} = {shares['geometry']:.2f}   "
              f"{ours['animation']:7} / {theirs['animation']:7} = {shares['animation']:.2f}   "
              f"{ours['animation_json']} / {theirs['animation_json']}   "
              f"{ours['mean_mm']:.2f} {ours['greatest_mm']:.2f} / {theirs['mean_mm']:.2f} {theirs['greatest_mm']:.2f}")
        sys.stdout.flush()


def print_time(bench, source):
    output = bench.path("time")
    seconds = [bench.flaneur(source, output)[1:] for _ in range(3)]
    print(f"\n{source.name}, whole chain: {min(s[1] for s in seconds):.2f} s, "
          f"{min(s[0] for s in seconds):.2f} CPU s (least of 3)")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("avatars", nargs="+", type=pathlib.Path, metavar="AVATAR")
    parser.add_argument("--bin", default="build/release/bin", help="folder of flaneur and avatar_bench")
    parser.add_argument("--gltfpack", help="npm gltfpack's cli.js; without it gltfpack is left out")
    parser.add_argument("--no-blender", action="store_true")
    parser.add_argument("--tools", type=lambda t: t.split(","), default=TOOLS, help="only these")
    parser.add_argument("--compressed", action="store_true", help="measure what is left after Draco's rounding")
    parser.add_argument("--samples", type=int, default=100000, help="points a surface")
    parser.add_argument("--ratios", type=lambda t: [float(r) for r in t.split(",")], default=[0.5, 0.25, 0.1])
    parser.add_argument("--hide", help="nodes to leave out, as for flaneur avatar")
    parser.add_argument("--sizes", action="store_true", help="compare bytes on disk instead")
    parser.add_argument("--time", action="store_true", help="time the whole chain instead")
    parser.add_argument("--json", type=pathlib.Path, help="also write the levels' figures here")
    return parser.parse_args()


def main():
    args = arguments()
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(args, pathlib.Path(folder))
        if args.time:
            for avatar in args.avatars:
                print_time(bench, avatar)
            return
        if args.sizes:
            print_sizes(bench, args.avatars)
            return
        all_figures = {}
        for avatar in args.avatars:
            triangles, figures = bench.levels(avatar)
            print_levels(avatar.stem, triangles, figures, args.ratios)
            all_figures[avatar.stem] = figures
        if "flaneur" in args.tools:
            won, total = best_cells(all_figures, args.ratios)
            misses = sum(missed(c) for f in all_figures.values() for c in f["flaneur"])
            print(f"\nlowest posed mean error: {won} of {total} cells; targets missed by more than 2 %: {misses}")
        if args.json:
            args.json.write_text(json.dumps(all_figures, indent=1) + "\n")


if __name__ == "__main__":
    main()
