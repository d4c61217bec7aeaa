"""A Slurm cluster of one node in a folder of its own, for as long as a test takes."""
import os
import pathlib
import shutil
import socket
import subprocess
import time

CONFIGURATION = """
ClusterName=one
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={port}
SlurmdPort={node_port}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MpiDefault=none
ReturnToService=2
SchedulerParameters=batch_sched_delay=0,sched_interval=1
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} State=UNKNOWN
PartitionName=batch Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""
PROGRAMS = {"sbatch": "slurm-wlm", "slurmctld": "slurm-wlm", "slurmd": "slurm-wlm", "munged": "munge", "snakemake": "snakemake"}
PATH = "/usr/sbin:/usr/bin:" + os.environ["PATH"]


class CannotStart(Exception):
    """What is missing, or what a daemon said."""


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class Cluster:
    def __init__(self, folder, cpus):
        self.folder = pathlib.Path(folder)
        missing = sorted({package for program, package in PROGRAMS.items() if shutil.which(program, path=PATH) is None})
        if missing:
            raise CannotStart("not installed: " + ", ".join(missing))
        if os.geteuid() != 0:
            raise CannotStart("a cluster of one's own needs root")
        for name in ("state", "spool"):
            (self.folder / name).mkdir(parents=True)
        configuration = self.folder / "slurm.conf"
        configuration.write_text(CONFIGURATION.format(host=socket.gethostname().split(".")[0], folder=self.folder, cpus=cpus,
                                                      port=free_port(), node_port=free_port()))
        self.environment = dict(os.environ, SLURM_CONF=str(configuration), PATH=PATH, USER="root")
        try:
            self.start()
        except CannotStart:
            self.stop()
            raise

    def run(self, *command, **options):
        return subprocess.run(list(map(str, command)), env=self.environment, capture_output=True, text=True, check=False, timeout=60,
                              **options)

    def start(self):
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        self.folder.chmod(0o755)
        daemon = self.run("munged", "--force", "--key-file", key, "--socket", self.folder / "munge.socket", "--pid-file",
                          self.folder / "munged.pid", "--log-file", self.folder / "munged.log", "--seed-file", self.folder / "munged.seed")
        if daemon.returncode != 0:
            raise CannotStart("munged: " + daemon.stderr.strip())
        self.run("slurmctld")
        self.start_node()

    def start_node(self):
        self.run("slurmd")
        deadline = time.monotonic() + 30
        while self.run("srun", "-n1", "-t1", "true").returncode != 0:
            if time.monotonic() > deadline:
                raise CannotStart("no node answers: " + self.run("sinfo").stderr.strip())
            time.sleep(0.5)

    def end(self, name):
        """A daemon, by its process's number."""
        try:
            number = int((self.folder / f"{name}.pid").read_text())
            os.kill(number, 15)
        except (OSError, ValueError):
            return
        deadline = time.monotonic() + 10
        while pathlib.Path(f"/proc/{number}").exists() and time.monotonic() < deadline:
            time.sleep(0.1)

    def jobs(self):
        """Of those that run: their numbers."""
        return self.run("squeue", "-h", "-t", "R", "-o", "%i").stdout.split()

    def stop(self):
        if self.jobs_may_run():
            self.run("scancel", "--state=RUNNING", "--user=root")
        for name in ("slurmd", "slurmctld", "munged"):
            self.end(name)

    def jobs_may_run(self):
        return (self.folder / "slurmctld.pid").exists()
