"""What a bake of the demo tour takes, in processor seconds: nothing changed, a caption, one avatar; cold with --cold.

    python3 tests/bench/bake_bench.py OUTPUT [--cold] [--bin FOLDER]

OUTPUT holds an earlier bake of the demo (build_assets/wolfenbuettel), which is copied. The work of child processes counts.
"""
import argparse
import os
import pathlib
import re
import resource
import shutil
import subprocess
import tempfile
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]


def bake(program, tour, output):
    """Processor seconds and seconds of the clock."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    subprocess.run([program, "bake", tour, "-o", output, "--allow-outside", "--allow-scripts"], check=True, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, time.monotonic() - start


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--cold", action="store_true", help="also without a cache, which takes minutes")
    parser.add_argument("--draft", action="store_true", help="also a draft without a cache")
    parser.add_argument("--bin", type=pathlib.Path, default=SOURCE / "build/release/bin")
    arguments = parser.parse_args()
    program = arguments.bin / "flaneur"
    with tempfile.TemporaryDirectory() as folder:
        tour = pathlib.Path(folder) / "assets_src/wolfenbuettel/tour.toml"
        shutil.copytree(SOURCE / "assets_src/wolfenbuettel", tour.parent)
        os.symlink(SOURCE / "blender_scripts", pathlib.Path(folder) / "blender_scripts")
        output = pathlib.Path(folder) / "out"
        shutil.copytree(arguments.output, output, symlinks=True)
        text = tour.read_text()

        def show(what):
            print("%-28s %8.2f s of work, %8.2f s of the clock" % (what, *bake(program, tour, output)), flush=True)
        bake(program, tour, output)
        show("nothing changed")
        tour.write_text(re.sub(r'(?m)^(caption\s*=.*?en\s*=\s*")', r"\1Now ", text, count=1) if "caption" in text else text)
        show("a caption changed")
        tour.write_text(text.replace('name = "monk"', 'name = "monk"\nheight_m = 1.71', 1))
        show("one avatar changed")
        tour.write_text(text)
        if arguments.draft:
            shutil.rmtree(output)
            command = [program, "bake", tour, "-o", output, "--draft", "--allow-outside", "--allow-scripts"]
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            print("%-28s %8.2f s of work" % ("draft, cold", after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime), flush=True)
        if arguments.cold:
            shutil.rmtree(output)
            cores = os.cpu_count()
            work, clock = bake(program, tour, output)
            print("%-28s %8.2f s of work, %8.2f s of the clock, %d cores busy %.0f %%" % ("cold", work, clock, cores, 100 * work / clock / cores))


if __name__ == "__main__":
    main()
