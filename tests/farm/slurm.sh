#!/usr/bin/env bash
# docs/farm.md's recipe on a real Slurm: a controller, one node, two tasks at a time, all on this machine and in a folder of their own.
# usage: slurm.sh HALFLIT [FRAMES]. Every third task is killed while it draws, and queued again. Ends with 77 where Slurm is absent or not root's.
set -euo pipefail
halflit=$(readlink -f "$1")
frames=${2:-64}
for program in slurmctld slurmd sbatch squeue scontrol munged; do
    PATH=$PATH:/usr/sbin command -v "$program" >/dev/null || { echo "skipped: no $program"; exit 77; }
done
[ "$(id -u)" -eq 0 ] || { echo "skipped: slurmd needs root"; exit 77; }
PATH=$(dirname "$halflit"):$PATH:/usr/sbin

work=$(mktemp -d)
chmod 755 "$work"
pids=()
stop() {
    [ ${#pids[@]} -eq 0 ] || kill "${pids[@]}" 2>/dev/null || true
    wait 2>/dev/null || true
    rm -rf "$work"
}
trap stop EXIT

# ---- a cluster of one node ---------------------------------------------------------------------------------------------
mkdir "$work"/{state,spool,munge}
chmod 700 "$work/munge"
head -c 128 /dev/urandom >"$work/munge/key"
chmod 400 "$work/munge/key"
# munged wants every folder above its socket to be root's and not writable by others, which /tmp is.
munged --force --foreground --key-file="$work/munge/key" --socket="$work/munge/socket" --pid-file="$work/munge/pid" \
    --log-file="$work/munge/log" --seed-file="$work/munge/seed" &
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
slurmd -D -N "$node" --conf-server "" >"$work/slurmd.log" 2>&1 || slurmd -D -N "$node" >"$work/slurmd.log" 2>&1 &
pids+=($!)
for _ in $(seq 100); do
    sinfo -h -t idle 2>/dev/null | grep -q . && break
    sleep 0.2
done
sinfo -h -t idle | grep -q . || { cat "$work"/*.log; echo "the node did not come up"; exit 1; }

# ---- the recipe ---------------------------------------------------------------------------------------------------------
cd "$work"
film=(render sphere:20000 --turntable "$frames" --size 320x240)
halflit "${film[@]}" -o one/{:03}.png --report one.json
begin=$(date +%s.%N)
halflit plan --for slurm -- "${film[@]}" -o 'many/{:03}.png' --report many.json >job.sh
# The first run of every third task ends in the middle of drawing, as on a machine that is taken away, and is queued again.
sed -i '$d' job.sh
cat >>job.sh <<TEXT
if [ \$((SLURM_ARRAY_TASK_ID % 3)) -eq 0 ] && [ "\${SLURM_RESTART_COUNT:-0}" -eq 0 ]; then
    halflit ${film[*]} -o 'many/{:03}.png' --report many.json --shard auto/$frames &
    sleep 0.0\$((SLURM_ARRAY_TASK_ID % 7))
    kill -KILL \$!
    echo \$SLURM_ARRAY_TASK_ID >>killed
    scontrol requeue "\$SLURM_JOB_ID"
    sleep 60
fi
halflit ${film[*]} -o 'many/{:03}.png' --report many.json --shard auto/$frames
TEXT
job=$(sbatch --parsable -n 1 --output=out.%a job.sh)
for _ in $(seq 3000); do
    [ -n "$(squeue -h -j "$job" 2>/dev/null)" ] || break
    sleep 0.2
done
end=$(date +%s.%N)
halflit merge many.*-of-*.json -o many.apng
hashes() { sed 's/.*"frame":\([0-9]*\),.*"pixel_hash":"\([0-9a-f]*\)".*/\1 \2/' "$@" | sort -n; }
if ! diff <(hashes one.json) <(hashes many.*-of-*.json); then
    tail -n 5 out.* slurmctld.log slurmd.log
    exit 1
fi
echo "$frames tasks, $(wc -l <killed) killed once, $(awk "BEGIN { printf \"%.1f\", $end - $begin }") s: the hashes are those of one process"
