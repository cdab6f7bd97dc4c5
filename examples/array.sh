#!/bin/sh
#SBATCH --array=0-1
#SBATCH --cpus-per-task=1
primordia experiment jobs.toml --job "$SLURM_ARRAY_TASK_ID" --quiet
