#!/usr/bin/env bash
# docs/farm.md's recipe on a real Slurm: a controller and one node, two tasks at a time, on this machine and in a folder of their own.
# usage: slurm.sh HALFLIT
source "$(dirname "$0")/recipe.sh"
need slurmctld slurmd sbatch sinfo scontrol munged
[ "$(id -u)" -eq 0 ] || { echo "skipped: slurmd needs root"; exit 77; }
REQUEUE='scontrol requeue "$SLURM_JOB_ID"; sleep 60' make_program

mkdir "$work"/{state,spool,munge}
head -c 128 /dev/urandom >"$work/munge/key"
chmod 400 "$work/munge/key"
# munged wants every folder above its socket to be root's and not writable by others, which /tmp is.
munged --force --foreground --key-file="$work/munge/key" --socket="$work/munge/socket" --pid-file="$work/munge/pid" \
    --log-file="$work/munge/log" --seed-file="$work/munge/seed" 2>"$work/munge/messages" &
pids+=($!)
node=$(hostname -s)
cat >"$work/slurm.conf" <<TEXT
ClusterName=test
SlurmctldHost=$node(127.0.0.1)
AuthInfo=socket=$work/munge/socket
SlurmUser=root
SlurmctldPort=16817
SlurmdPort=16818
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_interval=1,bf_interval=1,requeue_delay=0
MinJobAge=300
MpiDefault=none
RebootProgram=/bin/true
NodeName=$node NodeAddr=127.0.0.1 CPUs=2 Sockets=1 CoresPerSocket=2 ThreadsPerCore=1 State=UNKNOWN
PartitionName=all Nodes=$node Default=YES MaxTime=INFINITE State=UP
TEXT
export SLURM_CONF=$work/slurm.conf
slurmctld -D >"$work/slurmctld.log" 2>&1 &
pids+=($!)
slurmd -D -N "$node" -f "$SLURM_CONF" >"$work/slurmd.log" 2>&1 &
pids+=($!)
for _ in $(seq 100); do
    timeout 5 sinfo -h -t idle 2>/dev/null | grep -q . && break
    sleep 0.2
done
timeout 5 sinfo -h -t idle | grep -q . || { cat "$work"/*.log; echo "the node did not come up"; exit 1; }
run_recipe Slurm
