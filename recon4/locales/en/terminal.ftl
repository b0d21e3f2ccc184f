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

## recon4 plan, orthophoto, terrain, volume

plan-made = storey { $storey }: floor at { DECIMAL($floor_m, digits: 2) } m, { DECIMAL($area_m2, digits: 0) } m² seen; { DECIMAL($walls_m, digits: 1) } m of faces of walls (rms { DECIMAL($rms_mm, digits: 1) } mm), { $doors ->
    [one] { $doors } door
   *[other] { $doors } doors
 } and { $windows ->
    [one] { $windows } window
   *[other] { $windows } windows
 } in them, { $columns ->
    [one] { $columns } column
   *[other] { $columns } columns
 }
orthophoto-made = { $width } x { $height } pixels of { SIGNIFICANT($pixel_m, digits: 6) } m, { PERCENT($seen, digits: 0) } seen
contours-made = { $count ->
    [one] { $count } contour
   *[other] { $count } contours
 }, { SIGNIFICANT($apart_m, digits: 6) } m apart
terrain-made = { $width } x { $height } cells of { SIGNIFICANT($cell_m, digits: 6) } m, { DECIMAL($seen_m2, digits: 0) } m² seen
volume-made = { DECIMAL($above_m3, digits: 2) } m³ above and { DECIMAL($below_m3, digits: 2) } m³ below the plane (1 σ of the difference { DECIMAL($sd_m3, digits: 2) } m³); area { DECIMAL($area_m2, digits: 2) } m², of these { DECIMAL($unseen_m2, digits: 2) } m² not seen; base at { DECIMAL($base_m, digits: 3) } m, through { PERCENT($fitted, digits: 0) } of the border
layers-made = { COUNTED($layers, of: "gpkg") }
gpkg-trajectory = trajectory
gpkg-control-and-check-points = control and check points
gpkg-findings = findings
gpkg-stretches-of-findings = stretches of findings
gpkg-notes = notes
gpkg-double-walls = double walls

## recon4 classify

named-class = { NAMED($title, of: "class") }
corrections-none = no correction of classes
correction-not-in-map = not in the map yet
correction-still-in-map = { $correction }  is still in the map: it is withdrawn, or others come before it
correction-standing = { $correction }  { $points } points -> { $to }{ $restricted ->
    [0] {""}
   *[other] , only { $only }
 }  ({ $who })
correction-withdrawn = withdraw { $what }
correction-tried = { $where }: { $points } points, now: { COUNTED($now, of: "class") } -> { $to }
correction-alike = { $where }: { $count } of { $of } alike
alike-at = {"  "}{ $place }  { $points } points, { DECIMAL($difference, digits: 2) }

## recon4 targets

named-target = { NAMED($kind, of: "survey-target") }
survey-target-plate = plate
survey-target-board = board
survey-target-sphere = sphere
listed-targets-head = point      kind          x          y          z    σ mm  off mm  agreement
listed-targets-open = ambiguous
listed-targets-sigma = σ is that of the points of a target; errors of the trajectory come on top
listed-targets-no-three = no three surveyed points agree with targets of the map
listed-targets-named = { $count ->
    [one] { $count } point
   *[other] { $count } points
 } named, { DECIMAL($off_mm, digits: 1) } mm off after a rigid fit
listed-targets-missing = not found in the map: { $points }
listed-targets-ambiguous = ambiguous: { $points }; other names fit as well, as if they were exchanged

## recon4 calibrate

calibrated-page = page    { $page }
calibrated-by-maps = calibrated by maps
calibrated-by-entropy = calibrated by entropy
calibrated-by-gravity = calibrated by gravity
calibrated-by-pairs = mount of { QUOTED($sensor) } from { $count ->
    [one] { $count } pair
   *[other] { $count } pairs
 }
calibrated-by-trajectories = mount and clock of { QUOTED($second) } against { QUOTED($first) } from their trajectories
gravity-all-alike = the inclinations are all alike: the rotation about gravity is not observable
pairs-contradictory = the pairs of poses contradict each other
calibrated-windows = { $sensor }: { $windows ->
    [one] { $windows } window
   *[other] { $windows } windows
 }, scatter { DEGREES($scatter_rad, digits: 2) } { DECIMAL($scatter_mm, digits: 0) } mm
calibrated-profiler = { $evaluations } evaluations; { PERCENT($fewer, digits: 1) } fewer occupied cubes than in the step before; the height of the profiler is not observable on a level floor
calibrated-cost = cost { DECIMAL($first, digits: 4) } -> { DECIMAL($last, digits: 4) } in { $evaluations } evaluations
calibrated-inclination = inclination { $number }: residual { DEGREES($residual_rad, digits: 2) }
calibrated-pair = pair { $number }: residual { DEGREES($turn_rad, digits: 3) } { DECIMAL($shift_mm, digits: 1) } mm
mount-known = known to ± { DEGREES($sd_rad, digits: 3) } and ± { DECIMAL($x_mm, digits: 1) }, { DECIMAL($y_mm, digits: 1) }, { DECIMAL($z_mm, digits: 1) } mm (x, y, z)
mount-not-observable = not observable: the position along ({ $along }) stays as in the rig file
motions-agree = { PERCENT($share, digits: 0) } of { $motions } motions agree; half of them to { DEGREES($turn_rad, digits: 2) } and { DECIMAL($shift_mm, digits: 0) } mm
mount-of-trajectories = mount known to ± { DEGREES($sd_rad, digits: 2) } and ± { DECIMAL($x_mm, digits: 0) }, { DECIMAL($y_mm, digits: 0) }, { DECIMAL($z_mm, digits: 0) } mm (x, y, z of the first sensor)
clock-of-trajectories = clock: { DECIMAL($offset_ms, digits: 1, sign: 1) } ± { DECIMAL($sd_ms, digits: 1) } ms at the middle of the walk, drift { DECIMAL($rate_us, digits: 0, sign: 1) } ± { DECIMAL($sd_us, digits: 0) } µs a second

## recon4 evaluate --markers

named-role = { NAMED($role, of: "marker-role") }
marker-role-control = control
marker-role-check = check
residuals-marker = Marker
residuals-total = total cm
residuals-limit = Limit
residuals-points = points
residuals-limit-cm = limit cm
residuals-limits = limits: { $limits }
