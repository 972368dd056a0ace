#!/bin/bash
# Tasks of 'etendue submit' as a job array of Slurm: task i runs line i + 1 of a file of command lines.
#SBATCH --job-name=@NAME@
#SBATCH --array=@ARRAY@
#SBATCH --nodes=1
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=@THREADS@
#SBATCH --mem=@MEMORY@
#SBATCH --time=@MINUTES@
#SBATCH --output=@LOG@
#SBATCH --open-mode=append
#SBATCH --requeue
#SBATCH --signal=B:USR2@@WARNING@
@OPTIONS@
set -u
# Parts and checkpoints belong to the instruction set that began them: all nodes use that of the machine that submitted.
export ETENDUE_ISA=@ISA@
most_restarts=@RESTARTS@
tasks=@TASKS@

fail() {
    printf 'error: %s\n' "$1"
    exit 1
}

printf '==> %s on %s, task %s_%s, start %d\n' "$(date '+%F %T')" "$(hostname)" "$SLURM_ARRAY_JOB_ID" \
    "$SLURM_ARRAY_TASK_ID" $((${SLURM_RESTART_COUNT:-0} + 1))
[[ -r $tasks ]] || fail "$PWD/$tasks is not there: are the images on a file system that this node sees too?"
# Bytes, whatever language the node speaks.
line=$(LC_ALL=C sed -n "$((SLURM_ARRAY_TASK_ID + 1)){p;q}" "$tasks")
[[ -n $line ]] || fail "$tasks has no line for this task"

# Slurm tells this shell alone some time before the time is up; etendue then writes its checkpoint.
out_of_time=no child=
trap 'out_of_time=yes; kill -TERM "$child" 2>/dev/null' USR2
# Whoever cancels or preempts the task tells all of its processes. A second one would end etendue without a checkpoint.
trap : TERM
eval "$line" &
child=$!
wait "$child"
status=$?
# A signal ends only the waiting.
while kill -0 "$child" 2>/dev/null; do
    wait "$child"
    status=$?
done
[[ $out_of_time == yes && $status -eq 143 ]] || exit "$status"

# A task that was cancelled is not running any more, and stays cancelled.
task=${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID
[[ $(squeue --noheader --format=%T --jobs="$task") == RUNNING ]] || exit "$status"
# A byte for each time. SLURM_RESTART_COUNT also grows with what is preempted and with nodes that fail.
requeues=logs/${tasks%.tasks}.$SLURM_ARRAY_TASK_ID.requeues
printf . >>"$requeues" || fail "$PWD/$requeues cannot be written"
[[ $(wc -c <"$requeues") -le $most_restarts ]] ||
    fail "the time was up $((most_restarts + 1)) times; submit with a larger --task-minutes"
printf 'the time is up: this goes on from its checkpoint\n'
scontrol requeue "$task"
