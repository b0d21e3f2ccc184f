### What commands say at a terminal.

## Progress

stored-size = { SIZE($bytes) }
progress-step = { NAMED($step, of: "step") }
progress-unit = { NAMED($unit, of: "unit") }
seconds-left = { DECIMAL($seconds, digits: 0) } s left
warning = warning: { $text }
artifact-was-damaged = an artifact of the stage { NAMED($stage, of: "stage") } was damaged and is made again; the damaged one is { $moved_to }: { $files }
stage-was-reused = { NAMED($stage, of: "stage") }: already there
stage-was-done = { NAMED($stage, of: "stage") }: done in { $seconds } s

## A finished run

run-walk = { DECIMAL($duration_s, digits: 1) } s, { DECIMAL($length_m, digits: 1) } m, { $multiframes } multiframes ({ $lost } lost)
run-scans = { DECIMAL($duration_s, digits: 1) } s, { DECIMAL($length_m, digits: 1) } m, { $scans } scans ({ $lost } lost)
run-pairs = { $pairs } pairs tried: { $edges }
run-edges = { $count ->
    [one] { $count } edge
   *[other] { $count } edges
 }: { $edges }; { $loops ->
    [one] { $loops } loop closure
   *[other] { $loops } loop closures
 }
run-points = { $points } points in the map
run-grid = { DECIMAL($width_m, digits: 0) } x { DECIMAL($height_m, digits: 0) } m in cells of { DECIMAL($cell_m, digits: 2) } m, { DECIMAL($free_m2, digits: 0) } m² free
run-work = { DECIMAL($seconds, digits: 1) } s of work, { DECIMAL($memory_gb, digits: 2) } GB at most
run-verdict = verdict: { NAMED($usability, of: "usability") }
run-explain = recon4 explain CODE says more
pairs-accepted = { $count } accepted
pairs-rejected = { $count } rejected
pairs-unverified = { $count } unverified
label-map = map
label-nav2 = nav2
label-report = report

## recon4 verify

verify-unknown = not of recon4, left alone: artifacts/{ $name }
verify-note = note: { $what }
verify-damaged = damaged: { $what }
verify-untrusted = not trusted: { $what }
verify-counts = { $checked } checked, { $damaged } damaged{ $untrusted ->
    [0] {""}
   *[other] , { $untrusted } not trusted
 }
verify-intact = intact: { $name }
verify-altered = ALTERED: { $name }
verify-missing = MISSING: { $name }
verify-added = ADDED: { $name }
verify-signer = signed by { $signer }

## recon4 storage

storage-in-all = in all
storage-freeable = can be freed; processing the recording again makes it again
storage-freed = freed: { $size } in { $count ->
    [one] { $count } artifact
   *[other] { $count } artifacts
 }

## recon4 doctor

doctor-ok = ok
doctor-no = NO
doctor-check = { NAMED($check, of: "check") }
doctor-found = { NAMED($found, of: "found") }
check-cores = cores
check-memory = memory
check-disk-free = disk free
check-threads-of-blas = threads of BLAS
check-compiled-loops-kept = compiled loops kept
check-workers-of-jobs = workers of jobs
check-cluster = cluster
check-sandbox-privileges = sandbox: privileges
check-sandbox-network = sandbox: network
check-sandbox-capabilities = sandbox: capabilities
check-sandbox-limits = sandbox: limits
check-sandbox-files = sandbox: files
check-sandbox-calls = sandbox: calls
found-yes = yes
found-no = no
found-unsafe = unsafe
found-missing = missing
found-dropped = dropped
found-threads = threads
found-cannot-be-used = cannot be used
found-as-many-as-cores = as many as cores
found-memory-files-threads = memory, files, threads
found-network-namespace = network namespace

## Files that were written

written-report = { $file }, { $signed ->
    [yes] signed
   *[no] not signed
 }
written-delivery = { $count ->
    [one] { $count } file
   *[other] { $count } files
 }, { SIZE($bytes) } in { $folder }, { $signed ->
    [yes] signed
   *[no] not signed
 }
written = { $file }: { $what }
points-all = { $points ->
    [one] { $points } point
   *[other] { $points } points
 }
points-of = { $points } points of { $all }
points-with = { $points } points, with the { $left_out } that the map leaves out
points-without = { $points } points, without { $left_out } (noise, moving, carrier)
poses-all = { $poses ->
    [one] { $poses } pose
   *[other] { $poses } poses
 }
findings-all = { $findings ->
    [one] { $findings } finding
   *[other] { $findings } findings
 }
written-mandeye = { $points } points and { $samples } IMU samples in { $folder }
written-lost = lost: { $what }

## Backups

backup-left-out = left out, it changed meanwhile: { $name }
backup-damaged = damaged before it was copied: { $name }
backup-made = { $path }: { $files ->
    [one] { $files } file
   *[other] { $files } files
 }, { $bytes } bytes, { $new_bytes } of them new
backup-no-keys = keys and people are not in it (--with-keys)
restored-files = { $files } files in { $root }; recon4 verify { $root } compares them with their seals
restored-no-keys = keys are not in it: approvals count there once their keys are added (recon4 keys add)

## Captures

replay-sent = { $count ->
    [one] { $count } datagram
   *[other] { $count } datagrams
 } sent
capture-begins = recording to { $capture } (Ctrl-C stops)
capture-ended-early = recording ended by itself: { $why }
capture-next = next: { $command }
capture-counts = { $recorded } datagrams recorded, { $lost } lost; { $mapped }
capture-multiframes = { $count ->
    [one] { $count } multiframe is
   *[other] { $count } multiframes are
 } ready
capture-scans = { $count ->
    [one] { $count } scan is
   *[other] { $count } scans are
 } ready
capture-described = { $name } is described by { $file } beside the rig file

## recon4 control

control-not-measured = not measured in the map: { $names }
control-left-out = { $file } { $row }: left out
control-into = { $file }: latitude and longitude, put into { $crs }

## recon4 compare

differences-head = { $second } against { $first }: { $relation }
compare-georeferenced = both are georeferenced in { $crs }
compare-same-recording = both were made of the same recording
compare-aligned = aligned by { $how }
differences-none = no core point has a distance
differences-usual = { $names }: states no uncertainties; that of a usual good map was used
differences-core-points = { $count } core points
differences-count = { $count }  { DECIMAL($percent, digits: 1) } %  { NAMED($what, of: "differences-of") }
differences-of-significant = differ significantly (95 %)
differences-of-below = below the level of detection
differences-of-alone = without a partner in the other map
differences-of-no-normal = without a normal
differences-of-sparse = with too few points of their own
differences-signed = signed mean { DECIMAL($mean_mm, digits: 1) } mm, standard deviation { DECIMAL($sd_mm, digits: 1) } mm
differences-absolute = absolute: median { DECIMAL($median_mm, digits: 1) } mm, 95 % below { DECIMAL($high_mm, digits: 1) } mm, largest { DECIMAL($largest_mm, digits: 1) } mm
differences-lod = level of detection: median { DECIMAL($median_mm, digits: 1) } mm

## recon4 batch

batch-left-out = no walks, left out: { $names }
batch-ended = { NAMED($result, of: "usability") }
usability-failed = failed
usability-unfinished = unfinished
usability-no-verdict = no verdict
batch-walk = walk
batch-result = result
batch-duration = duration
batch-path = path
batch-took = took
batch-why = why

## recon4 evaluate

evaluated-head = { $estimate } against { $truth }: { $poses } poses ({ $covered } covered by ground truth), { DECIMAL($duration_s, digits: 1) } s, { DECIMAL($length_m, digits: 1) } m
evaluated-warning = Warning: { $hint }
evaluated-density = Density: median { $median } points/cm² (10 % of places below { $low }, 10 % above { $high }; radius { SIGNIFICANT($radius_m, digits: 6) } m)
evaluated-sharpness = Sharpness: mean map entropy { $entropy } nats, plane thickness { $thickness_cm } cm (radius { SIGNIFICANT($radius_m, digits: 6) } m, voxel { SIGNIFICANT($voxel_m, digits: 6) } m, { $places } places)
evaluated-translation = translation [cm]
evaluated-rotation = rotation [°]
evaluated-relations = { $count } relations compared, { $outside } outside of the trajectory
evaluated-relative-error = Relative error
evaluated-absolute-error = Absolute error
evaluated-rmse = RMSE
evaluated-mean = mean
evaluated-median = median
evaluated-deviation = deviation
evaluated-largest = largest
evaluated-least = min
evaluated-most = max
evaluated-svd = SVD-aligned
evaluated-first-pose = first pose
evaluated-unaligned = not aligned
evaluated-error-position = { $alignment }: position [cm]
evaluated-error-rotation = { $alignment }: rotation [deg]
evaluated-error-yaw = { $alignment }: yaw only [deg]
evaluated-undetermined = (the positions lie on a line or a point: the rotation of the SVD fit is undetermined)
evaluated-drift = Drift, { $metric }
evaluated-drift-short = Drift, { $metric }: the walk is too short
evaluated-pieces = pieces
evaluated-all = all
evaluated-relative = e_r (aligned: { $alignment })
evaluated-slices-mean = mean of slices
evaluated-points = points
evaluated-points-all = all points
evaluated-far = far
evaluated-mean-cm = mean cm
evaluated-map = Map
evaluated-fitted = on fitted surfaces
evaluated-measured = as measured
evaluated-estimated-poses = estimated poses
evaluated-true-poses = true poses
evaluated-same-points = Same points of { $frames } frames
evaluated-ratio = ratio { $ratio }
evaluated-patch = Patch: { $points } points on { $area_m2 } m², { $per_cm2 } points/cm²

## recon4 slice, recon4 doubles

slice-written = { $points } points in { $file }
slice-thinned = { $points } points in { $file }, one per square centimeter drawn
doubles-wall = { $place }  { DECIMAL($apart_cm, digits: 1) } cm apart (limit { DECIMAL($limit_cm, digits: 1) }), { $spans }
doubles-found = { $count ->
    [one] { $count } double wall
   *[other] { $count } double walls
 } in { $patches } patches seen twice
