#!/bin/sh
# properties = {properties}
# One step, without a second Snakemake on the node (which would be {{exec_job}}): starting that takes longer than many steps.
exec python3 -IS -c '
import json, subprocess, sys
prefix = "# properties = "
line = next(line for line in open(sys.argv[1], encoding="utf-8") if line.startswith(prefix))
sys.exit(subprocess.run(["sh", "-c", json.loads(line[len(prefix):])["params"]["command"]], check=False).returncode)
' "$0"
