#!/bin/bash
# A job array for Slurm: each task makes one part of the grains.
#
#   sbatch --array=1-16 docs/grains-array.sh SOURCE... -o DIR [flags of mskit grains]
#   mskit grains --merge DIR -o DIR
#
# Flags of sbatch stand before the script and go before what is set here. The same tasks may be sent again at any time:
# they go on where they were. For some of them alone: PARTS=16 sbatch --array=3,7 ...
#SBATCH --job-name=grains
#SBATCH --cpus-per-task=2
#SBATCH --mem=4G
#SBATCH --time=4:00:00
#SBATCH --signal=B:USR1@120
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=grains-%A-%a.log
set -u
task=${SLURM_ARRAY_TASK_ID:?is not set: send this by sbatch --array=1-N}
parts=${PARTS:-$SLURM_ARRAY_TASK_COUNT}
if [ -z "${PARTS:-}" ] && { [ "$SLURM_ARRAY_TASK_MIN" != 1 ] || [ "$SLURM_ARRAY_TASK_MAX" != "$parts" ]; }; then
    echo "tasks are not 1 to N: say of how many parts they are, as PARTS=16 sbatch --array=3,7 ..." >&2
    exit 2
fi
again() {
    echo "$1: queued again" >&2
    scontrol requeue "${SLURM_ARRAY_JOB_ID}_$task"
    exit 1
}

# The time limit is near: what is done is on the disk.
trap 'again "time limit"' USR1

mskit grains "$@" --part "$task/$parts" --resume --threads "$SLURM_CPUS_PER_TASK" \
    ${SLURM_MEM_PER_NODE:+--max-memory $((SLURM_MEM_PER_NODE * 3 / 4))M} &
wait $!
code=$?

# Killed from outside, as for memory: three more attempts.
if [ "$code" -gt 128 ] && [ "${SLURM_RESTART_COUNT:-0}" -lt 3 ]; then
    again "killed by signal $((code - 128))"
fi
exit "$code"
