### Reasons why jobs ended: each has a code, which is stored, and values.

job-stopped = stopped on request; what was finished is kept
job-stopped-early = stopped on request
job-out-of-memory = out of memory: the job reached the server's memory limit; close other programs, or process fewer points (a larger map.voxel_m, a shorter recording), then resume
job-taken-over = a file took over the process that read it, which was ended: do not use this recording
job-program-error = { $error } in the program; the log has the traceback
job-row-damaged = this row of jobs.sqlite is damaged: { $detail }
job-disk-full = no space left on the disk while writing { $file }; make room and start again: nothing that was finished is lost
worker-continues = the worker { EXIT($how, $number) }, { PLACE($stage, $what) }; it continues after the last finished stage
worker-died = the worker died { $attempts } times: last it { EXIT($how, $number) }, { PLACE($stage, $what) }; perhaps the recording is damaged or too large for this computer: see the log, then resume
map-worker-continues = the worker { EXIT($how, $number) }, { PLACE($stage, $what) }; it begins again
map-worker-died = the worker died { $attempts } times: last it { EXIT($how, $number) }, { PLACE($stage, $what) }; perhaps the map is damaged or too large for this computer: verify the project, then start again

## Exports and comparisons

export-no-order = this job orders no file
export-disk-full = no space: an export leaves { SIZE($reserve_bytes) } free, there are { SIZE($free_bytes) }
export-out-of-memory = out of memory: choose fewer points: some classes, a box, a storey, or thin them out
targets-no-order = this job names no search for survey targets
comparison-no-order = this job names no map to compare with
comparison-map-unknown = no map { QUOTED($map) }

## How a worker ended

word-exit-unseen = died while no server watched
word-exit-code = ended without a result (exit code { $number })
word-exit-signal = was ended by signal { $number }
word-exit-other = was ended [{ $how }]
word-exit-silent = made no progress for { $number } s and was killed
word-exit-SIGKILL = was killed from outside; often the memory of the computer was not enough [SIGKILL]
word-exit-SIGSEGV = crashed in native code (segmentation fault) [SIGSEGV]
word-exit-SIGABRT = was given up by native code (abort) [SIGABRT]
word-exit-SIGBUS = crashed reading a file that got shorter (bus error) [SIGBUS]
word-exit-SIGFPE = crashed in native code (arithmetic) [SIGFPE]
word-exit-SIGILL = needs a processor with more instructions (illegal instruction) [SIGILL]
word-exit-SIGTERM = was ended from outside [SIGTERM]
word-place-none = before it began
word-place-stage = in stage { $stage } ({ $what })
word-place-work = in { $what }
