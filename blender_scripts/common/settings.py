"""The one JSON file that every Blender script is started with.

A script is run as

    blender --background --factory-startup --python-exit-code 1 --python SCRIPT.py -- SETTINGS.json

and starts with

    settings = load_settings(required=("output", "seed"), options={"houses": 72})

which returns a dictionary that holds exactly the known keys; settings["options"] holds every option, with the
default where the file names none. Bad input ends the process with one line on stderr and exit code 1.
"""

import difflib
import json
import os
import sys
import tempfile


def fail(message):
    """Ends the process: one line on stderr, exit code 1."""
    sys.stdout.flush()
    print("flaneur: error: " + " ".join(str(message).split()), file=sys.stderr, flush=True)
    os._exit(1)  # Blender would swallow SystemExit in some versions, and may crash while it tidies up.


def settings_path():
    """The argument after `--` on the command line."""
    arguments = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    if len(arguments) != 1:
        fail("expected one argument after '--': the settings file (JSON)")
    return arguments[0]


def unknown_key(key, known):
    """The sentence about a key that nobody knows, with the nearest known one."""
    near = difflib.get_close_matches(key, known, n=1, cutoff=0.5)
    if near:
        return "unknown key '%s', did you mean '%s'?" % (key, near[0])
    return "unknown key '%s', known are: %s" % (key, ", ".join(sorted(known)))


def _same_type(value, default):
    if default is None:
        return True
    if isinstance(default, bool) or isinstance(value, bool):
        return isinstance(default, bool) and isinstance(value, bool)
    if isinstance(default, float):
        return isinstance(value, (int, float))
    return isinstance(value, type(default))


def _type_name(default):
    names = {bool: "true or false", int: "a whole number", float: "a number", str: "a string",
             list: "a list", dict: "an object"}
    return names.get(type(default), type(default).__name__)


def merge_options(given, defaults, where):
    """`defaults` overlaid with `given`; fails on unknown keys and on values of another type.

    A default of None accepts any value.
    """
    if not isinstance(given, dict):
        fail("%s: must be an object" % where)
    merged = dict(defaults)
    for key, value in given.items():
        if key not in defaults:
            fail("%s: %s" % (where, unknown_key(key, list(defaults))))
        if not _same_type(value, defaults[key]):
            fail("%s: '%s' must be %s" % (where, key, _type_name(defaults[key])))
        merged[key] = value
    return merged


def load_settings(required=("output",), optional=None, options=None):
    """Reads the settings file named on the command line.

    required: keys that must be there. optional: dictionary of further keys with their defaults.
    options: dictionary of the script's own options with their defaults.
    """
    path = settings_path()
    optional = optional or {}
    try:
        with open(path, encoding="utf-8") as file:
            given = json.load(file)
    except OSError as error:
        fail("%s: %s" % (path, error.strerror or error))
    except ValueError as error:
        fail("%s: not valid JSON: %s" % (path, error))
    if not isinstance(given, dict):
        fail("%s: must hold one object" % path)
    known = list(required) + list(optional) + ["options"]
    for key in given:
        if key not in known:
            fail("%s: %s" % (path, unknown_key(key, known)))
    for key in required:
        if key not in given:
            fail("%s: '%s' is missing" % (path, key))
    if "seed" in given and (isinstance(given["seed"], bool) or not isinstance(given["seed"], int)):
        fail("%s: 'seed' must be a whole number" % path)
    settings = {key: given[key] for key in required}
    for key, default in optional.items():
        settings[key] = given.get(key, default)
    settings["options"] = merge_options(given.get("options", {}), options or {}, path + ": options")
    return settings


def write_atomically(path, write):
    """Calls `write(temporary_path)` in the target's folder, then renames; nothing half-written stays.

    The temporary name keeps the target's extension. Fails with the target's name where that is impossible.
    """
    folder = os.path.dirname(os.path.abspath(path))
    stem, extension = os.path.splitext(os.path.basename(path))
    try:
        handle, temporary = tempfile.mkstemp(prefix="." + stem + "-", suffix=extension, dir=folder)
        os.close(handle)
    except OSError as error:
        fail("%s: cannot write: %s" % (path, error.strerror or error))
    try:
        write(temporary)
        if os.path.getsize(temporary) == 0:
            raise RuntimeError("nothing was written")
        os.chmod(temporary, 0o644)
        os.replace(temporary, path)
    except Exception as error:  # Blender raises RuntimeError, files OSError: the user sees one line.
        if os.path.exists(temporary):
            os.remove(temporary)
        fail("%s: cannot write: %s" % (path, error))
