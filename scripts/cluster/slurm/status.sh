#!/bin/sh
# What Snakemake asks of a job: success, failed or running.
told=$(scontrol --oneliner show job "$1" 2>&1)
case $told in
  *JobState=COMPLETED*) echo success ;;
  *JobState=PENDING* | *JobState=CONFIGURING* | *JobState=RUNNING* | *JobState=COMPLETING* | *JobState=SUSPENDED* | *JobState=REQUEUED*) echo running ;;
  *JobState=* | *"Invalid job id"*) echo failed ;;
  *) echo running ;; # the controller does not answer now
esac
