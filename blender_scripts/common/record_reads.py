"""Writes down which files a script opens, one path a line, into the file that FLANEUR_READS names.

Run twice around the script, in the same Blender: before it, to be told of every file that Python opens; after it, to
ask Blender which files it has loaded itself. What the system and Blender bring is left out.
"""

import os
import sys
import tempfile

import bpy

KINDS = ("images", "libraries", "sounds", "fonts", "movieclips", "volumes", "cache_files")
SYSTEM = ("/usr/", "/lib", "/etc/", "/proc/", "/sys/", "/dev/", "/bin/", "/sbin/")


def own_folders():
    own = [bpy.utils.resource_path(kind) for kind in ("LOCAL", "SYSTEM", "USER")]
    own += [sys.prefix, sys.base_prefix, os.path.dirname(bpy.app.binary_path), tempfile.gettempdir(), sys.pycache_prefix]
    return tuple(os.path.join(os.path.realpath(folder), "") for folder in own if folder) + SYSTEM


class Record:
    def __init__(self, path):
        self.file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
        self.own = own_folders()
        self.known = set()

    def add(self, path):
        if isinstance(path, bytes):
            path = os.fsdecode(path)
        if not isinstance(path, str):
            return
        real = os.path.realpath(path)
        if real in self.known or real.startswith(self.own) or "\n" in real or not os.path.isfile(real):
            return
        self.known.add(real)
        os.write(self.file, os.fsencode(real) + b"\n")

    def hear(self, event, arguments):
        """sys.addaudithook calls this for all that Python does; it must not raise."""
        try:
            if event == "open" and not (isinstance(arguments[1], str) and set(arguments[1]) & set("wax+")):
                self.add(arguments[0])
        except Exception:  # pylint: disable=broad-except
            pass


def main():
    known = sys.modules.get("flaneur_record_reads")
    if known is None:
        record = Record(os.environ["FLANEUR_READS"])
        sys.modules["flaneur_record_reads"] = record
        sys.addaudithook(record.hear)
        return
    for kind in KINDS:
        for each in getattr(bpy.data, kind, ()):
            if each.filepath and getattr(each, "packed_file", None) is None:
                known.add(bpy.path.abspath(each.filepath))


main()
