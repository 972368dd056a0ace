# A Slurm cluster of two nodes on this machine, with all of its files in one directory. Sourced, not run, after setup.sh.
# shellcheck shell=bash
#
# SLURM_WORK is that directory. SLURM_CONF is exported, so that sbatch and the like find this cluster, and so that each
# process of it can be told by its environment: what is left at the end is stopped, and nothing else.

# free_port: a TCP port of 127.0.0.1 that nobody listens to.
free_port() {
    python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'
}

# write_slurm_conf CPUS MEBIBYTES: of each node.
write_slurm_conf() {
    local user
    user=$(id -un)
    cat >"$SLURM_CONF" <<TXT
ClusterName=etendue-test
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort=$(free_port)
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
# A job that is queued again waits for its credential to expire, otherwise two minutes.
AuthInfo=socket=$SLURM_WORK/munge/socket,cred_expire=5
StateSaveLocation=$SLURM_WORK/state
SlurmdSpoolDir=$SLURM_WORK/spool-%n
SlurmctldPidFile=$SLURM_WORK/slurmctld.pid
SlurmdPidFile=$SLURM_WORK/slurmd-%n.pid
SlurmctldLogFile=$SLURM_WORK/slurmctld.log
SlurmdLogFile=$SLURM_WORK/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
# A dead node is to be noticed soon.
SlurmdTimeout=10
MessageTimeout=5
KillWait=5
ReturnToService=1
SchedulerParameters=defer,sched_interval=2,bf_interval=2
SlurmdParameters=config_overrides
NodeName=n1 NodeHostname=localhost NodeAddr=127.0.0.1 Port=$(free_port) CPUs=$1 RealMemory=$2 State=UNKNOWN
NodeName=n2 NodeHostname=localhost NodeAddr=127.0.0.1 Port=$(free_port) CPUs=$1 RealMemory=$2 State=UNKNOWN
PartitionName=main Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
TXT
}

# start_munged: with a key and a socket of its own, as the package's user if there is one and we are root.
start_munged() {
    local as=()
    mkdir -m 0755 "$SLURM_WORK/munge"
    head -c 1024 /dev/urandom >"$SLURM_WORK/munge/key"
    chmod 0400 "$SLURM_WORK/munge/key"
    if [[ $EUID -eq 0 ]] && id munge >/dev/null 2>&1; then
        chown -R munge:munge "$SLURM_WORK/munge"
        as=(setpriv --reuid=munge --regid=munge --clear-groups)
    fi
    "${as[@]}" munged --foreground --key-file="$SLURM_WORK/munge/key" --socket="$SLURM_WORK/munge/socket" \
        --pid-file="$SLURM_WORK/munge/pid" --log-file="$SLURM_WORK/munge/log" --seed-file="$SLURM_WORK/munge/seed" \
        >"$SLURM_WORK/munge.out" 2>&1 &
    disown  # the shell need not tell how it ends
    wait_for 10 test -S "$SLURM_WORK/munge/socket" ||
        die "munged does not start" "$(tail -n 3 "$SLURM_WORK/munge.out" "$SLURM_WORK/munge/log" 2>/dev/null)"
}

# wait_for SECONDS COMMAND...: until it succeeds; fails if it does not in time.
wait_for() {
    local end=$((SECONDS + $1))
    shift
    until "$@"; do
        [[ $SECONDS -lt $end ]] || return 1
        sleep 0.5
    done
}

nodes_are_idle() { [[ $(sinfo --noheader --format=%T%n --Node 2>/dev/null | grep -c '^idle') -eq 2 ]]; }

# start_slurm CPUS MEBIBYTES
start_slurm() {
    SLURM_WORK=$(mktemp -d "${TMPDIR:-/tmp}/etendue-slurm.XXXXXX")
    chmod 0755 "$SLURM_WORK"
    export SLURM_CONF=$SLURM_WORK/slurm.conf
    mkdir "$SLURM_WORK/state" "$SLURM_WORK/spool-n1" "$SLURM_WORK/spool-n2"
    write_slurm_conf "$@"
    start_munged
    slurmctld -D >"$SLURM_WORK/slurmctld.out" 2>&1 &
    disown
    local node
    for node in n1 n2; do
        slurmd -D -N "$node" >"$SLURM_WORK/slurmd-$node.out" 2>&1 &
        disown
    done
    wait_for 60 nodes_are_idle || die "the nodes do not come up" "$(sinfo 2>&1)" "$(tail -n 5 "$SLURM_WORK"/*.out)"
}

# find_processes tasks|all [NODE]: the ids of the processes of this cluster, or of one node. The tasks come last:
# daemons that outlive them would tell how they ended.
find_processes() {
    python3 - "$SLURM_WORK" "$@" <<'PYTHON'
import os, sys

work, kind, node = sys.argv[1], sys.argv[2], sys.argv[3] if len(sys.argv) > 3 else None


def environment(pid):
    with open(f"/proc/{pid}/environ", "rb") as file:
        return set(file.read().split(b"\0"))


# slurmd, and slurmstepd, which starts tasks and whose environment names no node.
def writes_log_of_node(pid):
    return any(os.readlink(f"/proc/{pid}/fd/{fd}") == f"{work}/slurmd-{node}.log" for fd in os.listdir(f"/proc/{pid}/fd"))


daemons, tasks = [], []
for pid in filter(str.isdigit, os.listdir("/proc")):
    try:
        # The shell that exports SLURM_CONF was started without it; this program is no part of the cluster either.
        words = environment(pid)
        if f"SLURM_CONF={work}/slurm.conf".encode() not in words or int(pid) == os.getpid():
            continue
        if any(word.startswith(b"SLURMD_NODENAME=") for word in words):
            if node is None or f"SLURMD_NODENAME={node}".encode() in words:
                tasks.append(pid)
        elif node is None or writes_log_of_node(pid):
            daemons.append(pid)
    except OSError:
        continue  # it has ended, or is somebody else's
for pid in tasks if kind == "tasks" else daemons + tasks:
    print(pid)
PYTHON
}

cluster_processes() { find_processes all "$@"; }
cluster_tasks() { find_processes tasks "$@"; }

# kill_working_node NODE: as if its power was cut while a task runs on it; fails if none begins within five minutes.
# All of the node is stopped before the look whether a task is among it, so that none can end, and report it, in between.
kill_working_node() {
    local pids end=$((SECONDS + 300))
    while [[ $SECONDS -lt $end ]]; do
        mapfile -t pids < <(cluster_processes "$1")
        kill -STOP "${pids[@]}" 2>/dev/null || true
        if [[ -n $(cluster_tasks "$1") ]]; then
            # Tasks may start others between the look and the blow.
            while mapfile -t pids < <(cluster_processes "$1") && [[ ${#pids[@]} -gt 0 ]]; do
                kill -KILL "${pids[@]}" 2>/dev/null || true
            done
            printf '    node %s is dead\n' "$1"
            return 0
        fi
        kill -CONT "${pids[@]}" 2>/dev/null || true
        sleep 0.1
    done
    return 1
}

# stop_slurm: ends all that start_slurm has started.
stop_slurm() {
    local pids signal
    [[ -n ${SLURM_CONF:-} ]] || return 0
    for signal in TERM KILL; do
        mapfile -t pids < <(cluster_processes)
        [[ ${#pids[@]} -gt 0 ]] || break
        kill -"$signal" "${pids[@]}" 2>/dev/null || true
        wait_for 10 no_cluster_processes || true
    done
}

no_cluster_processes() { [[ -z $(cluster_processes) ]]; }
