"""A Slurm of its own on this machine: one node, this user, the loopback alone; all it writes is in one folder."""
import os
import shutil
import signal
import socket
import subprocess
import time

PATIENCE = 1800  # seconds; against hangs

# What holds for any such node. cred_expire is also how long a requeued task waits.
CONF = """
ClusterName=mskit
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
SlurmUser={user}
SlurmdUser={user}
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType={proctrack}
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
MpiDefault=none
MailProg=/bin/true
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
SchedulerParameters=sched_interval=1,batch_sched_delay=1
ReturnToService=2
JobRequeue=1
KillWait=5
NodeName={host} NodeAddr=127.0.0.1 CPUs=8 RealMemory=64000 State=UNKNOWN
PartitionName=main Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def what_is_missing():
    """Why there can be no such node here; empty if there can."""
    for program in ("munged", "slurmctld", "slurmd", "sbatch", "scontrol", "squeue"):
        if not shutil.which(program, path=path()):
            return f"{program} is not installed (packages slurm-wlm and munge)"
    host = socket.gethostname().split(".")[0]
    try:
        address = socket.gethostbyname(host)
    except OSError:
        address = "nothing"
    return "" if address.startswith("127.") else f"{host} is {address} and not 127.0.0.1: name it in /etc/hosts"


def path():
    return os.environ.get("PATH", "") + ":/usr/sbin:/sbin"


def until(what, holds):
    end = time.monotonic() + PATIENCE
    while not holds():
        if time.monotonic() > end:
            raise TimeoutError(what)
        time.sleep(0.02)


def is_running(pid):
    """Neither gone nor a zombie, which nobody may reap in a container."""
    try:
        with open(f"/proc/{pid}/stat", encoding="utf-8") as f:
            return f.read().rsplit(")", 1)[1].split()[0] not in "ZX"
    except OSError:
        return False


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    try:
        for s in sockets:
            s.bind(("127.0.0.1", 0))
        return [s.getsockname()[1] for s in sockets]
    finally:
        for s in sockets:
            s.close()


class Node:
    def __init__(self, folder, proctrack):
        self.folder = folder
        self.env = {key: value for key, value in os.environ.items()
                    if key.split("_")[0] not in ("SLURM", "SBATCH", "SQUEUE", "SCANCEL")}
        self.env.update(PATH=path(), SLURM_CONF=self.path("slurm.conf"))
        for name in ("state", "spool"):
            os.mkdir(self.path(name))
        self.write("munge.key", os.urandom(128))
        os.chmod(self.path("munge.key"), 0o600)
        self.write("slurm.conf", CONF.format(
            host=socket.gethostname().split(".")[0], folder=folder, proctrack=proctrack, ports=free_ports(2),
            user=self.call("id", "-un").strip()).encode())

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, data):
        with open(self.path(name), "wb") as f:
            f.write(data)

    def call(self, *args, check=True, **more):
        result = subprocess.run(args, env=self.env, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                stdin=subprocess.DEVNULL, timeout=PATIENCE, check=False, **more)
        if check and result.returncode != 0:
            raise RuntimeError(f"{' '.join(args)}: exit code {result.returncode}\n{result.stdout}{result.stderr}")
        return result.stdout

    def start(self):
        self.call("munged", "--key-file=" + self.path("munge.key"), "--socket=" + self.path("munge.socket"),
                  "--pid-file=" + self.path("munged.pid"), "--log-file=" + self.path("munged.log"),
                  "--seed-file=" + self.path("munged.seed"), "--origin=127.0.0.1")
        self.call("slurmctld")
        until("slurmctld does not answer", lambda: "UP" in self.call("scontrol", "ping", check=False))
        self.call("slurmd")
        until("the node is not idle", lambda: self.call("sinfo", "-h", "-o", "%T", check=False).strip() == "idle")

    def stop(self):
        """No job and no program of it is left. slurmd tells slurmctld, and both need munged to stop."""
        if self.pid("slurmctld"):
            until("jobs do not end", self.cancel_jobs)
        for program in ("slurmd", "slurmctld", "munged"):
            pid = self.pid(program)
            if pid:
                os.kill(pid, signal.SIGTERM)
                until(f"{program} does not end", lambda: not is_running(pid))

    def cancel_jobs(self):
        """Again and again: a task may be on its way back into the queue. @return whether none is left"""
        jobs = set(self.call("squeue", "-h", "-t", "PD,R,CG,S", "-o", "%A", check=False).split())
        for job in jobs:
            self.call("scancel", job, check=False)
        return not jobs

    def pid(self, program):
        """Of a program that runs still, else 0."""
        try:
            with open(self.path(program + ".pid"), encoding="utf-8") as f:
                pid = int(f.read())
        except (OSError, ValueError):
            return 0
        return pid if is_running(pid) else 0

    def state(self, job, task):
        """Of a task, as RUNNING; ended ones are listed for five minutes."""
        states = dict(line.split(":") for line in
                      self.call("squeue", "-h", "-r", "-t", "all", "-j", job, "-o", "%K:%T").split())
        return states.get(str(task), "")

    def await_state(self, job, task, state):
        until(f"task {task} is not {state}", lambda: self.state(job, task) == state)
