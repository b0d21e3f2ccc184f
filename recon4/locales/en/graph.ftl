### The viewer Graph: its controls, its legend, and what is picked.


## Page

opening-map = Opening the map…
opening-since = Opening the map… { $seconds } s
trying-again = { $problem }. Trying again…
server-silent = the server does not answer
caption = { $frame } · z up · meters · { $approval }
frame-map = map frame
frame-crs = local map frame of { $crs }
list-of-keys = Keys
hotkey-normalized = Raw or normalized intensity
hotkey-surface = Points on fitted surfaces, as measured, or those left out
hotkey-fit = Fit the map into the view
hotkey-above = View from above
hotkey-south = View from the south
hotkey-east = View from the east
hotkey-narrow = Narrow field of view, nearly orthographic
hotkey-measure = Measure a distance between two points
hotkey-stop = Stop measuring, clear the mark
hotkey-stretch = Go to the marked stretch of the walk
hotkey-play = Play or stop
hotkey-list = This list
cap-escape = Escape

## Notices of viser, as it writes them

viser-connecting = Connecting...
viser-connected = Connected
viser-inactive = Inactive
viser-rejected = Connection rejected
viser-software = Software WebGL rendering detected
viser-software-why = WebGL is running in software mode, not on your GPU. Performance may be degraded. If this is unexpected, check that hardware acceleration is enabled in your browser settings.
viser-no-webgl = WebGL unavailable
viser-no-webgl-why = WebGL is unavailable. This may be caused by hardware acceleration being disabled — check your browser settings.
viser-old-browser = Unsupported browser
viser-old-browser-why = Your browser ({ $browser }) is outdated, which may cause problems. Consider updating.
viser-unknown-browser = Could not detect browser version
viser-unknown-browser-why = Your browser version could not be detected. It may not be supported.
viser-expand = Expand panel
viser-collapse = Collapse column
viser-collapse-area = Collapse panel area
viser-settings = Configuration & diagnostics
viser-share = Share
viser-share-not = Share (needs connection)
viser-return = Return to GUI

## Controls

controls = Controls
folder-points = Points
folder-multiframes = Multiframes
folder-layers = Layers
folder-measure = Measure
paint-by = Color by
paint-normalized-intensity = normalized intensity
paint-raw-intensity = raw intensity
paint-height = height
paint-time = time
paint-sensor = sensor
paint-ring = ring
paint-multiframe = multiframe
paint-distance = distance
paint-uncertainty = uncertainty
raw-or-normalized = Raw or normalized (N)
points-lie = Points lie (R)
lie-fitted = on fitted surfaces
lie-raw = as measured
lie-strays = left out of the map
palette = Palette
palette-gray = gray
range-from = Range from
range-to = Range to
range-of-map = Range of the map
point-size-m = Point size, m
most-points = Most points, thousand
fewer-if-slow = Fewer when this browser is slow
show-points = Show
points-map = map
points-map-and-multiframe = map and multiframe
points-multiframe = multiframe
one-multiframe = Multiframe
window-s = Window, s
play-or-stop = Play or stop (P)
edges-by = Edges by
edges-verdict = verdict
edges-error-limit = error / limit
edges-chi = chi²
measure-distance = Measure a distance (M)
stop-measuring = Stop measuring (M)
keep-picked = Keep the picked point
graph-csv = Download CSV
undo-last = Undo the last

## Layers

layer-plan = 2-D map
layer-trajectory = Trajectory
layer-odometry = Odometry trajectory
layer-frames = Multiframes: body frames
layer-lidars = LiDAR frames at the multiframe
layer-gnss-used = GNSS, used
layer-gnss-rejected = GNSS, rejected
layer-gravity = Gravity (down) and axes of the map
layer-north = North
layer-grid = Grid
layer-decided-accepted = Operator's decisions, accepted
layer-decided-rejected = Operator's decisions, rejected
layer-rejected = Rejected, { $reason }
layer-unverified = Unverified, { $kind }
layer-accepted = Accepted, { $kind }
layer-counted = { $layer } ({ COUNT($count) })
no-reason = no reason given
joint-odometry = odometry
joint-neighbor = neighbor
joint-loop = loop
joint-manual = made by an operator
label-start = start
label-end = end
label-start-and-end = start and end
label-down = down
label-north = N

## Legend

legend-points = Points by { $value }
legend-preview = Preview by height
legend-lines = Lines
legend-edges = Edges by { $value }, gray = not known
above-backpack = m above the backpack
one-per-second = One multiframe per second, until there is a map
points-of-map = { COUNT($shown) } of { COUNT($count) } points
only-left-out = Only the { COUNT($count) } points left out
raw-left-out = As measured, { COUNT($count) } points left out
fitted-left-out = On fitted surfaces, { COUNT($count) } points left out
multiframes-of = { $last ->
    [-1] Multiframe { $first } of { $count }, at { DECIMAL($at, digits: 1) } s
   *[other] Multiframes { $first } to { $last } of { $count }, at { DECIMAL($at, digits: 1) } s
}
grid-cell = Grid cell { SIGNIFICANT($cell, digits: 6) } m, map frame, z up
figure = { SIGNIFICANT($value, digits: 4) }
scale-raw-intensity = as the sensor gave it
scale-height = m above the origin
scale-time = s since the start
scale-ring = 0 = lowest beam
scale-multiframe = neighbors differ
scale-distance = m from the sensor
scale-uncertainty = m, 1 σ of the position by the pose

## What is picked

title-edge = Edge { $i }–{ $j }
title-point = Point
title-place = Place
title-fix = GNSS fix
title-measured-point = { $number }. Point
title-measured-distance = { $number }. Distance
row-nodes = Nodes
nodes-at = { $i } at { DECIMAL($at-i, digits: 1) } s, { $j } at { DECIMAL($at-j, digits: 1) } s
row-kind = Kind
row-verdict = Verdict
row-reason = Reason
row-overlap = Overlap
row-error = Error
error-of = { SIGNIFICANT($error, digits: 3) } m of { SIGNIFICANT($limit, digits: 3) } m
error-alone = { SIGNIFICANT($error, digits: 3) } m
row-paths = Alternative paths
paths-median = { $count }, median { SIGNIFICANT($median, digits: 3) } m
short-figure = { SIGNIFICANT($value, digits: 3) }
figure-of = { $figure } of { SIGNIFICANT($limit, digits: 3) }
by-number = { $number }. { $judge }
open-in-review = Open in review
judged-overlap = overlap { SIGNIFICANT($value, digits: 3) }
judged-error = error { SIGNIFICANT($value, digits: 3) } m
judged-matches = matches { SIGNIFICANT($value, digits: 3) }
judged-degeneracy = degeneracy { SIGNIFICANT($value, digits: 3) }
judged-seen-through = seen through { SIGNIFICANT($value, digits: 3) }
judged-confirmed = { SIGNIFICANT($value, digits: 3) } nodes confirm it
judged-contradicted = { SIGNIFICANT($value, digits: 3) } nodes contradict it
judged-paths = path discrepancy { SIGNIFICANT($value, digits: 3) } m
judged-chi2 = chi² { SIGNIFICANT($value, digits: 3) }
row-time = Time
time-s = { DECIMAL($s, digits: 1) } s
time-ms = { DECIMAL($s, digits: 3) } s
fix-used = used
fix-rejected = rejected as an outlier
row-residual = Residual, east north up
residual-enu = { DECIMAL($east, digits: 3, sign: 1) } { DECIMAL($north, digits: 3, sign: 1) } { DECIMAL($up, digits: 3, sign: 1) } m
row-residual-horizontal = Horizontal residual
row-sensor = Sensor, ring
row-raw-intensity = Raw intensity
row-normalized = Normalized
row-range = Distance from the sensor
row-what = What
row-cell = Cell
cell-surface = surface
cell-free = free
cell-not-seen = not seen
cell-cm = { SIGNIFICANT($cm, digits: 6) } cm
row-distance = Distance
row-horizontal = Horizontal
row-vertical = Vertical
meters-3 = { DECIMAL($m, digits: 3) } m
meters-4 = { DECIMAL($m, digits: 4) } m
meters-signed = { DECIMAL($m, digits: 4, sign: 1) } m
measured-length = { $number }: { DECIMAL($m, digits: 3) } m
stretch-here = here
stretch-moment = { DECIMAL($from, digits: 1) } s
stretch-span = { DECIMAL($from, digits: 1) } s to { DECIMAL($to, digits: 1) } s
not-in-this-map = Not in this map
no-position = The walk has no position: { $stretch }.
