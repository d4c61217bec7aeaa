"""Manual pages (help2man) and completion in bash of the programs, made from what their --help says.

python3 describe_programs.py BIN_FOLDER VERSION RELEASE_DATE OUTPUT_FOLDER: writes man/PROGRAM/*.1.gz and completion/PROGRAM.
RELEASE_DATE as in Debian's changelogs, so that the same sources give the same pages.
"""
import email.utils
import gzip
import os
import pathlib
import re
import subprocess
import sys


def output(*command, **environment):
    return subprocess.run(list(map(str, command)), check=True, capture_output=True, text=True, env={**os.environ, **environment}).stdout


def verbs(program):
    """Of `flaneur`; the player has none."""
    return re.findall(rf"^  {program.name} (\w+)", output(program, "--help"), re.MULTILINE)


def purpose(program, help_text):
    """The first sentence of the help, as the page's name line has it."""
    sentence = re.split(r"[.:]?\n|\. ", help_text.strip())[0].removeprefix(program.name + " ").rstrip(".")
    return sentence[0].lower() + sentence[1:]


def manual_page(program, verb, version, date):
    command = " ".join(filter(None, [str(program), verb]))
    name = "-".join(filter(None, [program.name, verb]))
    seconds = int(email.utils.parsedate_to_datetime(date).timestamp())
    page = output("help2man", "--no-info", f"--version-string={version}", f"--name={purpose(program, output(*command.split(), '--help'))}",
                  command, SOURCE_DATE_EPOCH=str(seconds), LC_ALL="C.UTF-8")
    # A page has no blank in its name.
    page = re.sub(r"^(\.TH) \S+ ", rf"\1 {name.upper()} ", page, count=1, flags=re.MULTILINE)
    page = re.sub(r"^(\.SH NAME)\n.*? \\- ", lambda m: f"{m[1]}\n{name} \\- ", page, count=1, flags=re.MULTILINE)
    return page.replace(str(program), program.name)


def options(help_text):
    """Each option as ({its names}, [the values that it takes, where they are few])."""
    for line in help_text.splitlines():
        found = re.match(r"  ((?:-\w,)?--?[\w-]+)(.*)", line)
        if not found:
            continue
        choice = re.search(r":(?:value in )?\{([^}]*)\}", found[2].split("  ")[0])
        yield found[1].split(","), [value.split("->")[0] for value in choice[1].split(",")] if choice else []


def cases(help_text):
    """Lines of bash that set `values` after an option with few values, and `options`."""
    all_options = list(options(help_text))
    lines = [f"  {'|'.join(names)}) values='{' '.join(values)}' ;;" for names, values in all_options if values]
    if lines:
        lines = ["case $before in", *lines, "esac"]
    lines += [f"options='{' '.join(name for names, _ in all_options for name in names if name.startswith('--'))}'"]
    return lines


def completion(program):
    function = "_" + program.name.replace("-", "_")
    lines = [f"# Completion in bash for {program.name}, made from its --help.", f"{function}() {{",
             "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} options= values="]
    names = verbs(program)
    if names:
        lines += ["  if [ \"$COMP_CWORD\" -eq 1 ]; then", f"    values='{' '.join(names)} --help --version'", "  fi",
                  "  case ${COMP_WORDS[1]} in"]
        for verb in names:
            lines += [f"    {verb})", *("      " + line for line in cases(output(program, verb, "--help"))), "      ;;"]
        lines += ["  esac"]
    else:
        lines += ["  " + line for line in cases(output(program, "--help"))]
    lines += ["  COMPREPLY=()",
              "  if [ -n \"$values\" ]; then",
              "    mapfile -t COMPREPLY < <(compgen -W \"$values\" -- \"$word\")",
              "  elif [[ $word == -* ]]; then",
              "    mapfile -t COMPREPLY < <(compgen -W \"$options\" -- \"$word\")",
              "  fi", "}", f"complete -o default -F {function} {program.name}  # by default files", ""]
    return "\n".join(lines)


def main():
    bin_folder, version, date, folder = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3], pathlib.Path(sys.argv[4])
    (folder / "completion").mkdir(parents=True, exist_ok=True)
    for program in (bin_folder / "flaneur-player", bin_folder / "flaneur"):
        (folder / "man" / program.name).mkdir(parents=True, exist_ok=True)
        (folder / "completion" / program.name).write_text(completion(program))
        for verb in ["", *verbs(program)]:
            path = folder / "man" / program.name / ("-".join(filter(None, [program.name, verb])) + ".1.gz")
            path.write_bytes(gzip.compress(manual_page(program, verb, version, date).encode(), mtime=0))


if __name__ == "__main__":
    main()
