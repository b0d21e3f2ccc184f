### The list of projects and the page of a project.

## List of projects

projects-title = Projects · recon4
new-project = New project
to-phone = Phone
find-project = Find a project
order = Order
show = Show
no-project-yet = No project yet. Start one from a recording.
no-project-like-that = No project is like that
recently-deleted = Recently deleted
order-newest = Newest first
order-name = Name
order-verdict = Worst verdict first
order-length = Longest path first
order-size = Largest first
damaged = Damaged: { $problem }
archived = Archived
same-recording = Same recording as { $others }
organize = Organize
organize-of = Organize { $name }
no-map-yet = No map yet
show-more = Show more: { $count } are left
show-all = All ({ $count })
show-twins = Same recording twice ({ $count })
show-archived = Archived ({ $count })
trash-recording = Recording { $project }
trash-goes = is deleted permanently on { $when }
restore-of = Restore { $project }
delete-now-of = Delete { $project } permanently

## Organize a project

free-earlier = Results of earlier runs
free-frames = Points as recorded: no new decisions until it was processed again
free-map = Tiles of the map: no viewer, slices and exports until it was processed again
space = { $size }, { $free } can be freed
tags = Tags, with commas between
archive-it = Archived: not in the list at first; nothing is moved or deleted
free-space = Free space; processing the recording again makes it again

## Jobs

progress-whole = Progress of the whole run
job-waits = It begins once the jobs before it have ended
resume-job = Resume
other-settings = Other settings…

## Steps of a run

step-hash = hash { $file }
step-save = save
step-frames = frames
step-refine = refine
step-double-walls = double walls
step-level = level
step-octree = octree
step-scans = scans
step-compile = the kernels are compiled, once after an installation: some minutes
step-calibration = calibration
step-view-volumes = view volumes
step-pairs = pairs
step-points = points
step-pair-lines = pair lines
step-refine-lines = refine lines
step-unwind = unwind
step-reading = Reading
step-odometry = odometry
step-odometry-without-gnss = odometry without GNSS
step-2-d-odometry = 2-D odometry
step-grid = Grid
step-loop-closures = Loop closures
step-classify-points = classify points
step-compare = compare
step-export = export
step-find-the-carrier = find the carrier
step-learn-intensities = learn intensities
step-map = map
step-place-points = place points
step-results = results
step-kernels = kernels
step-verification = verification
step-copy = copy
step-pack = pack
step-report = report
step-approvals = approvals
step-artifacts = artifacts
step-back-up = back up
step-boards = boards
step-plates = plates
step-replay = replay
step-restore = restore
step-simulate = simulate
step-spheres = spheres
step-targets = targets

## Stages

stage-frames = frames
stage-odometry = odometry
stage-calibration = calibration
stage-graph = graph
stage-scans-2d = scans_2d
stage-odometry-2d = odometry_2d
stage-graph-2d = graph_2d
stage-verification = verification
stage-map-2d = map_2d
stage-review = review
stage-refine = refine
stage-level = level
stage-intensity = intensity
stage-classes = classes
stage-map = map
stage-audit = audit
stage-pages = kept for the pages

## Page of a project

project-title = Project · recon4
nothing-was-made = Nothing to show: the job ended before it had a trajectory.
nothing-to-show = Nothing to show yet. The first trajectory appears here while the job runs.
before-use = Before you use this map
figures = Figures
results = Results
export = Export
stages = Stages
stage = Stage
state = State
time = Time
memory = Memory
stage-is-done = Done
stage-is-reused = Reused
open-map = Open the map
share = Share…
fact-preset = preset { $preset }
fact-rig = rig { $rig }
report-pdf = Report for the client, PDF
report-page = Report for the client, page
findings-as = Findings, { $format }
map-in-3d = Map in 3-D
result-quality-report = Quality report
result-map-laz-1-4 = Map, LAZ 1.4
result-2-d-map-image = 2-D map, image
result-2-d-map-description-for-nav2 = 2-D map, description for nav2
result-2-d-map-image-as-the-pages-show-it = 2-D map, image as the pages show it
result-trajectory-tum = Trajectory, TUM
result-odometry-trajectory-tum = Odometry trajectory, TUM
result-poses-of-the-multiframes-with-covariances-csv = Poses of the multiframes with covariances, CSV
result-edges-with-verdicts = Edges with verdicts
result-pose-graph-g2o = Pose graph, g2o
result-figures-settings-and-hashes = Figures, settings and hashes

## Storage of a project

stored-earlier = Of earlier runs
stored-earlier-without = Going back to their settings or decisions computes them again. The map without decisions is among them: the next small decision takes as long as a whole map, once.
stored-frames = Points as recorded
stored-frames-without = New decisions, and the views of pairs and multiframes, need them.
stored-map = Tiles of the map
stored-map-without = The map, slices and exports need them. The LAZ stays.
stored-what = What
stored-free = Can be freed
stored-days = What only earlier runs needed is freed { $days } days after the last run.
stored-stays = Nothing is freed by itself: see recon4 serve --keep-earlier.
stored-approved = What an approval needs stays.
stored-nothing = Nothing can be freed.
free-it = Free space…
free-choose = Choose what is freed.
free-ask = Free { $size }?
free-again = Running the project again makes it again. That needs the recording.
keep = Keep
free = Free
freed = Freed: { $size }.
storing-approved = approved, version { $version }
storing-being-written = a run writes it
storing-unknown = no stage accounts for it

## Tools of a project

run-again = Run again, with other settings
rename-or-delete = Rename or delete
rename = Rename
delete-restorable = It can be restored from the list of projects for a week. The recording is not deleted.
log = Log
log-download = Download the log

## Exports

export-looking = Looking at the map…
export-list = What was exported
file = File
thin-out = Thin out: one point each … mm
thin-all = all points
pixel-mm = Pixel, mm
cell-m = Cell, m
make-file = Make file
points = Points
points-map = those of the map
points-all = all: also noise, the carrier, what moves
points-some = some classes…
classes = Classes
storeys-all = all
storey = Storey
storey-at = { $name }: floor at { DECIMAL($m, digits: 2) } m
export-more = Coordinates, box and more
crs = CRS
crs-of-map = { $crs }, that of the map
crs-local = local frame of the map
box-only = Only a box, in the coordinates of the file, m
box-from-x = from x
box-to-x = to x
box-from = Box from { $axis }
box-to = Box to { $axis }
export-raw = Points as measured, not on fitted surfaces
export-draft = As a draft, without the approval
estimate-points = about { COUNT($points) } points
estimate-most = at most { $size }
estimate-size = about { $size }
estimate-none = no point of the map is chosen
export-nothing = Nothing was exported yet.
delivery-made-now = Made now, of the whole map
delivery-made-before = Exported before
delivery-license = License of the data
delivery-no-license = none is given
delivery-language = Language of report and README
delivery-choose = Choose at least one file for the delivery.
delivery-with-license = with a license
delivery-without-license = without a license
delivery-verify = Verify
delivery-verifying = Every file is read…
verify-intact = { $count ->
    [one] { COUNT($count) } file is intact
   *[other] { COUNT($count) } files are intact
    }
verify-altered = Altered:
verify-missing = Missing:
verify-added = Not in the list:
verify-signed = Signed by { $signer }
verify-signer = { $name }, key { $key }
signer-this-server = this server
remove-file = Remove file
progress-file = Progress of this file
export-waits = Waits for other exports
export-earlier = of an earlier map
export-removed = the file was removed: order it again
made-of = Content
made-points = { COUNT($points) } points
hash-and-version = Hash and version
thin-out-brief = Thin out
pixel = Pixel
cell = Cell
box = Box
classes-choose = Choose at least one class.
not-a-number = { $field }: expected a number, got “{ $text }”.
class-number = class { $code }
option-storey = storey { $storey }
option-box = box { $corners }
option-clip = inside of a box { $size } m, middle { $middle }, turned by { $deg }°
clip-part = Part shown on the page Map
clip-not-taken = This file is made of the whole map: it takes no part.
clip-back = Back to the map
clip-forget = All of the map
clip-wrong = Part of the map: expected seven numbers, got “{ $text }”.
list-gap = ,{" "}
option-all = all points
option-thin = one point each { $mm } mm
option-raw = as measured
option-draft = draft

## Kinds of files

export-delivery = Delivery
export-delivery-zip = Delivery, ZIP
program-the-client = for the client
export-point-cloud = Point cloud
export-drawings-and-images = Drawings and images
export-tables-and-lines = Tables and lines
export-e57-scans-with-poses = E57, scans with poses
export-ply-all-fields-and-normals = PLY, all fields and normals
export-xyz-lines-of-text = XYZ, lines of text
export-ptx-scans-with-poses-as-text = PTX, scans with poses as text
export-floor-plans-dxf = Floor plans, DXF
export-floor-plans-geojson = Floor plans, GeoJSON
export-orthophoto-of-a-storey-geotiff = Orthophoto of a storey, GeoTIFF
export-terrain-the-ground-geotiff = Terrain, the ground, GeoTIFF
export-terrain-what-is-highest-geotiff = Terrain, what is highest, GeoTIFF
export-contours-dxf = Contours, DXF
export-poses-kitti = Poses, KITTI
export-findings-csv = Findings, CSV
export-findings-geojson = Findings, GeoJSON
export-trajectory-points-findings-notes-double-walls-geopackage = Trajectory, points, findings, notes, double walls, GeoPackage
program-qgis-web-viewers = QGIS, web viewers
program-any-program = any program
program-slam-tools = SLAM tools
program-spreadsheets = spreadsheets

## New job

folders = Folders of this server
folders-all = All folders
folder-use = Use this folder
folder-up = Up
job-repeats = The same name runs again in this project, another name makes a new one. Finished stages with unchanged inputs are reused.
rig-version = { $id }, version { $version }
job-recording = Recording
job-or-recording = Or a recording on the server
job-recording-hint = File or folder: pcap, bag, mcap, frames
browse = Browse…
job-name = Project name
job-preset = Preset
rig-detect = Detect from the recording
job-samples = IMU and GNSS files
job-imu = IMU, CSV
job-gnss = GNSS: CSV, .pos, UBX …
job-from-recording = Empty: from the recording
job-settings = All settings
job-start = Start
job-checking = Checking the recording…
job-unreadable = This recording cannot be read, see above: nothing was started
job-starting = Starting…
job-invalid = Some settings are invalid, see above

## Recordings

recording-reading = Reading the recording…
recording-make-rig = Make a rig of these sensors
recording-rig-made = is made:
recording-mounts = fill in the mounts
recording-choose = on its page, then choose it below.
recording-use = Use { $path }
recording-about = about{" "}
recording-warnings = Warnings
recording-beside = { $file }, next to it
recording-samples = Samples
recording-derived = Derived
recording-missing = Missing

## Uploads

upload = Upload
upload-waiting = Begins
upload-sending = Sending
upload-trying = Interrupted
upload-paused = Paused
upload-failed = Stopped
upload-done = On the server
upload-drop = Drop a file or folder here
upload-file = File…
upload-folder = Folder…
uploads-unfinished = Unfinished uploads
upload-files = { $name }, { COUNT($count) } files
upload-pause = Pause
upload-continue = Continue
upload-hidden = { $count } hidden files are skipped
upload-empty = It contains no file
upload-same-file = { $received } of { $total } received. Select the same file again to continue, until { $until }
upload-same-folder = { $received } of { $total } received. Select the same folder again to continue, until { $until }
upload-remove-of = Remove the upload of { $name }
upload-sent = { $sent } of { $total }

## Rig of a recording

and = {" "}and{" "}
rig-file = Rig file
rig-calibrated = Calibrated
rig-slice = Slice { $cm } cm thick, { $which }, { $lidars }
rig-slice-size = a slice { $cm } cm thick, { $m } m wide
rig-agrees = agrees
rig-differs = differs
rig-not-observable = not observable
rig-imu = IMU
rig-gnss = GNSS antenna
rig-used = Calibrated rig used for this map
rig-not-compared = Not compared
rig-file-differs = The rig file differs from the recording
rig-file-agrees = The rig file agrees with the recording
rig-beam = LiDAR and ring
rig-range = Range
rig-elevation = Elevation
rig-azimuth = Azimuth
rig-sensor = Sensor
rig-quantity = Quantity
rig-change = Change ± σ
rig-result = Result
rig-calibrate = Calibrate and map again
rig-save-open = Save as a new rig version…
rig-no-job = This server made no map of this project: use “Run again, with other settings” below, with calibration.mode=auto
rig-save-title = Save the calibrated rig
rig-save-as = Save as
rig-new-version = A new version of { $id }
rig-new = A new rig
rig-new-name = Name of the new rig
rig-note = Note
rig-note-hint = The changes and their standard deviations are stored with it.
rig-of-recording = Rig of the recording:
rig-saved-as = The calibrated rig is saved as
rig-compared = { $count } parameters compared
rig-audit = Audit
rig-corrections = Corrections of { $count ->
    [one] { $count } single beam
   *[other] { $count } single beams
 }
rig-beams = Beams
rig-distance = Distance of points from common planes
rig-surface = One surface seen by two LiDARs
rig-before = Before
rig-after = After
rig-windows = Windows of the walk that were not used
quantity-rotation = rotation
quantity-position = position
quantity-clock = clock

## Settings

setting-example = voxel, odometry, GNSS…
setting-int = whole number
setting-float = number
setting-text = text
setting-find = Find a setting
setting-only-changed = Only changed ones
setting-changed = { $count } changed
setting-unchanged = None changed
setting-default = default { $value }
setting-empty = empty

## Workers of a job

workers = Workers
workers-unused = This computer makes all parts: { $problem }
dashboard-of-scheduler = Dashboard of the scheduler
worker = Worker
worker-now = Makes
worker-idle = nothing now
worker-made = Parts made
worker-failed = { $count } failed
