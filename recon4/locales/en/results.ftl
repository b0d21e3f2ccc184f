### What is wrong with maps, results and what commands are given: each text has a code, which is stable.

## Evaluation

ate-few = the truth covers { $covered } of { $count } estimated poses, at least 2 are needed: estimate { $estimate }, truth { $truth }
density-area = patch: expected sides that span an area, got { $area_m2 } m²
floor-none = none of { $count } multiframes is covered by estimate and truth
markers-skipped = { $file } { $skipped }
markers-row = { $where }: expected a name, a role control or check and finite numbers, got { QUOTED($row) }, { QUOTED($role) }, { $place }
markers-twice = { $file } line { $line }: marker { QUOTED($row) } is in line { $lines } already: remove one of them, or rename it
relations-none = { $file }: no relation in this file
relations-cover = the trajectory ({ DECIMAL($low_s, digits: 3) } to { DECIMAL($high_s, digits: 3) } s) covers none of the { $count } relations ({ DECIMAL($begin_s, digits: 3) } to { DECIMAL($end_s, digits: 3) } s)
relations-numbers = { $file }: line { $number }: expected { $columns } finite numbers, got { QUOTED($line) }
relations-seconds = { $file }: line { $number }: expected seconds, got { QUOTED($line) }
relations-line = { $file }: line { $number }: { $why }
control-unreadable = georeference.json: control cannot be read: { $why }
trajectory-endings = { $file }: expected a trajectory as .tum, .txt or .npz
trajectory-none = { $file }: expected a trajectory file or a project with one

## Calibration

calibration-reference = calibration.reference: expected a LiDAR of the rig ({ $names }), got { QUOTED($reference) }
calibration-sensors = calibration.sensors: expected some of { $value }, got { QUOTED($unknown) }
gravity-pairs = expected a floor normal and a gravity for each of at least { $min_pairs } inclinations, got { $floors } and { $gravities }
directions-finite = expected directions of finite length, got NaN or zero
number-rows = { $file }: line { $number }: expected { $count } finite numbers ({ $columns }), got { QUOTED($line) }
pose-pairs-none = { $file }: expected a pair of poses a line, got none
pose-pairs-empty = expected at least one pair of poses, got none
pose-pairs-contradict = the pairs contradict each other: their rotations have no mean
pose-pairs-axes = hand-eye: expected motions that turn about two different axes, got fewer
pose-pairs-quaternion = { $file }: pair { $wrong }: expected a quaternion of length 1, got { DECIMAL($length, digits: 3) }
trajectories-differ = the trajectories do not show the same motion: { $used } of their motions differ by more than { DECIMAL($most_deg, digits: 0) }° or { SIGNIFICANT($most_m, digits: 6) } m
trajectory-short = { $name } trajectory: expected at least { SIGNIFICANT($shortest_s, digits: 6) } s, got { DECIMAL($seconds, digits: 1) }
trajectories-overlap = the trajectories have too little time in common
trajectory-one-axis = the walk turns about one axis only (about another by { DECIMAL($turned, digits: 2) }° in { SIGNIFICANT($motion_s, digits: 6) } s): the rotation of the mount is not observable
calibrate-method = no method named { QUOTED($method) }; there are: { $methods }
calibrate-beams = single beams: expected the method joint, got { QUOTED($method) }
calibrate-lidars = { $method }: expected a rig with LiDARs, got { QUOTED($rig) } with a profiler; use entropy or pairs
calibrate-entropy = entropy: expected two LiDARs and some seconds of walk
calibrate-gravity = gravity: expected the backpack at rest at two inclinations or more, got { $count }
calibrate-sensor = expected a sensor of the rig ({ $names }), got { QUOTED($name) }
calibrate-trajectories = expected the trajectories of two sensors (TUM), got { $count } files
calibrate-sensors = expected the two sensors of the trajectories, of { $rows } (command: --sensors A,B), got { QUOTED($sensors) }
calibrate-no-lidar = expected a rig with a LiDAR that is enabled, got none
calibrate-maps = the maps of { QUOTED($sensor) } and { QUOTED($other) } do not register: walk through a larger room
calibrate-windows = maps: expected several windows of the walk to agree on the mount of { QUOTED($sensors) }, got { $windows } that differ by { DECIMAL($scatter_deg, digits: 1) }° and { DECIMAL($scatter_cm, digits: 0) } cm
laser-unused = { $recordings } is a recording of a 2-D laser: it is processed without { $unused }

## Coordinates and control points

control-too-close = control points { $targets } lie above each other or too close together: they do not say where north is
control-unit = control points are up to { SIGNIFICANT($site_m, digits: 3) } apart in the survey and { SIGNIFICANT($map_m, digits: 3) } m in the map: expected meters, neither degrees nor another unit
control-one-line = control points { $targets } lie on one line: a map that is not leveled needs three that do not
control-names = no surveyed point was measured in the map: the survey has { $surveyed }, measured are { $measured }; expected the same names
control-same-place = { $name } and { $other } are in one place { $where }: expected points at least { SIGNIFICANT($apart_m, digits: 6) } cm apart
crs-coordinates = easting { DECIMAL($east_m, digits: 3) }, northing { DECIMAL($north_m, digits: 3) } is not in { $crs }: expected coordinates of that system
crs-no-projection = { $name } is not a map projection in meters: { $system }
crs-not-meters = { $name } is not in meters
crs-grid = { $name } needs the grid { $grids }; without it heights or positions would be wrong. Get it once from the internet: pyproj sync --system-directory --file { $file }
crs-no-operation = { $name }: PROJ knows no transformation for this place that gives right heights and positions
crs-place = { $crs } does not cover this place
crs-covers = { $crs } does not cover these coordinates
crs-rough = The map gets the coordinates of its control points in { $crs }; the grid { $grids }, which is not installed, is not needed for that. Only latitude and longitude on WGS 84 are then known to { DECIMAL($accuracy_m, digits: 0) } m, and no export in another system is possible.
crs-unknown = PROJ knows no coordinate reference system { QUOTED($name) }: expected a code as EPSG:25832, or one of place and one of heights as EPSG:25832+7837; the own grid of a site has none
crs-unreadable = { $file } cannot be read: { $why }
crs-map = the map cannot be put into { $crs }: { $why }
crs-site-grid = the map cannot be put into { $crs }: its control points are in a grid of the site; give them in that system
control-not-finite = a control point has a coordinate that is not a number
survey-reading = { $why }; { $reading } they are there: correct the survey or the system
either-or = { $one } or { $other }
reading-exchanged = with easting and northing exchanged
reading-feet = as feet
reading-feet-exchanged = as feet with easting and northing exchanged
reading-zone = with the number of the zone, { $zone }, before the easting
reading-no-zone = without the number of the zone before the easting
reading-crs = in { $crs }
crs-not-used = easting { DECIMAL($east_m, digits: 3) }, northing { DECIMAL($north_m, digits: 3) } in { $crs } are latitude { DECIMAL($lat_deg, digits: 2) }°, longitude { DECIMAL($lon_deg, digits: 2) }°, where this system is not used
crs-gnss-far = the coordinates in { $crs } are { DECIMAL($off_m, digits: 0) } km from where GNSS has the map
survey-deviations = expected standard deviations above 0, got { SIGNIFICANT($e, digits: 6) }, { SIGNIFICANT($n, digits: 6) }, { SIGNIFICANT($h, digits: 6) } m
survey-covariance-finite = expected a covariance of finite numbers
survey-covariance-definite = the covariance is not positive definite: a correlation is 1 or more, or its numbers are in another order
survey-deviation-range = the standard deviation { $axis } is { SIGNIFICANT($sd_m, digits: 6) } m: expected { SIGNIFICANT($least, digits: 6) } to { SIGNIFICANT($most, digits: 6) } m; check its unit
limits-numbers = limits: expected five numbers in cm or -, got { QUOTED($text) }
limits-range = { $name }: expected more than 0 and at most { SIGNIFICANT($most_m, digits: 6) } m
control-degrees = line { $line }: expected latitude and longitude in degrees, got { SIGNIFICANT($lat_deg, digits: 6) }, { SIGNIFICANT($lon_deg, digits: 6) }
control-not-surveyed = { $name }: not in the survey: { $unknown }
control-file-large = { $name }: expected at most { $limit } bytes, got { $got }
map-crs-unknown-place = the map cannot be put into { $crs }: its place is not known
map-local = the map is local: it is not georeferenced
map-crs-far = these coordinates are not in { $crs }: far from the map
measured-directions = a measured position: expected one to three directions, got none
site-not-put = the map is not put on these points: { $texts }
site-range = { $name }: expected more than 0 and at most 10 m

## References of slices

reference-mesh-shape = { $file }: expected vertices and triangles of three numbers each, got { $vertex_type } { $vertex_shape } and { $corner_type } { $corner_shape }
reference-mesh-corners = { $file }: triangles name corners that do not exist
reference-transform = { $name }/reference.json: expected T_map_reference as a 4x4 rigid motion, got { $value }
reference-no-triangles = the mesh has no triangles
reference-matrix = { $name }/reference.json: expected a 4x4 matrix: { $why }
reference-one-file = { $file }: expected one file, got a folder or nothing
reference-cubes = expected points in at most { $max_tiles } cubes of { SIGNIFICANT($tile_m, digits: 6) } m, got { $count } or more: are the coordinates in meters?
reference-local = the map is local: a reference in a CRS cannot be aligned with it
reference-no-projection = its coordinates are { $kind } ({ $stated }), and { $reason }: expected meters of a map projection; convert the file, or choose its own CRS
reference-earth-centered = it states earth-centered coordinates ({ $stated }), but they are { DECIMAL($distance, digits: 0) } km from the center of the Earth: choose the map's frame or the map's CRS
reference-no-operation = { $name } cannot be transformed to { $crs }: PROJ knows no operation for this place, or its grid is not installed
reference-units = read in meters it measures { $there } m, the map { $here } m. It states no unit: choose one, for example millimeters (command: --unit mm), or meters
reference-transform-failed = { $name } cannot be transformed to { $crs }: { $why }

## Slices

comparison-no-slice = comparison: expected one slice or more, got none
comparison-no-points = the map has no points
doubles-fields = double walls: the map lacks the fields { $missing }
dxf-many = DXF: expected at most { $max_dxf_points } points (one per cm² of each slice), got { $drawn }: export a smaller part or fewer slices, use a thinner slice, or export LAZ
slice-empty = the slice holds no points, there is nothing to export
geotiff-large = GeoTIFF: the image is too large, its corners would be off by { DECIMAL($worst, digits: 3) } m in { $crs }; export a smaller part
geotiff-epsg = a GeoTIFF needs an EPSG code, the map is in { $crs }
sheet-scale = scale: expected one of { $scales }, got { $scale }
sheet-window = a window { DECIMAL($width_m, digits: 0) } m wide does not fit on { $size } at 1 : 10 000
sheet-file = sheet: expected a .png, .svg or .pdf file, got { $file }
slice-color-distance = color distance: needs a reference; add one first
slice-no-intensity = this map has no { $color } intensities; it has { $fields }
slice-pixel = pixel size: expected a positive number, got { $pixel_m } m
slice-window = window: expected left < right and bottom < top, got { $corners }
slice-pixels = slice image: expected at most { $max_pixels } million pixels, got { $width } x { $height }; use larger pixels or a smaller window
slice-finite = a slice needs finite coordinates, got { $numbers }
slice-thickness = the thickness must be 0 to { DECIMAL($max_thickness_m, digits: 0) } m, got { $thickness_m }
slice-line-short = the two points of a vertical slice must be 1 mm apart or more
slice-normal = a plane needs a normal with a direction, got { $normal }
slice-count = 1 to { $max_slices } slices at a time, got { $count }
slice-spacing = slices need 1 mm to 1 km between them, got { $spacing_m } m

## Python

true-poses-project = the true poses need a project with its frames, got { $root }
unit-unknown = unit: expected one of { $units_m }, got { QUOTED($unit) }
map-2d-no-points = { $project } has no points: it is a 2-D map, see map.png and map.yaml
project-no-stage = { $folder } has no finished stage { $stages }
project-no-run = { $root } has no finished run: process its recording to the end first
slice-distances-image = distances to a reference are written as an image, got { $file }
slice-formats = a slice is written as png svg pdf tif dxf laz csv, got { $file }
slice-one-image = an image has one slice; use .dxf, .laz or .csv for several
slice-colors = colors are { $labels }; got { QUOTED($color) }

## Exports

reread-differs = { $name } reads back wrong: { $what }: expected { $expected }, got { $got }
reread-nodes = { $file } reads back wrong: { $nodes } points in nodes, { $listed } listed, { $point_count } in the header, expected { $expected }
reread-node = { $file } reads back wrong: the points of node { $key }
reread-points = { $file } reads back wrong: { $got } points, expected { $expected }
reread-crs = { $file } reads back wrong: CRS: expected { QUOTED($crs) }
reread-scans = { $file } reads back wrong: { $scan_count } scans, expected { $count }
e57-not-written = an E57 file cannot be written: { $reason }; is the disk full?
reread-scan-field = { $file } reads back wrong: { $name } of scan { $index }
findings-none = { $project } has no findings yet: run recon4 process, or recon4 audit
gpkg-features = { $file }: expected { $wanted } features, got { $count } back
file-not-written = { $file } cannot be written: { $why }
export-wide = the map is wider than { $wide_km } km or has coordinates without meaning
export-no-crs = not a CRS: { QUOTED($crs) }: { $why }
export-no-points = there are no points to write
reread-why = { $name } reads back wrong: { $why }
reread-longer = { $name } reads back wrong: more than { $at } bytes
reread-from = { $name } reads back wrong: points from number { $first } on
reread-bytes = { $name } reads back wrong: { $count } bytes from byte { $first } on
reread-count = { $file } reads back wrong: expected { $count } points
export-no-trajectory = { $project } has no finished trajectory yet: run recon4 process
export-formats = a map is written as { $cloud_formats }, .e57, .ptx, got { $file }
export-copc-name = { $file }: a map is written as { $copc }, this is a plain LAZ file
export-name = a { $ending } file must be named { $suffix }, got { $file }
export-kind = { $file }: { $kind } is not supported; use { $plain }
export-kind-classes = { $kind } has no classes, so it cannot hold what the map leaves out
export-classes-both = choose some classes, or all points: not both
export-classes = classes: expected some of { $names }, got { QUOTED($word) }
export-map-empty = the map has no points, there is nothing to export
export-nothing-chosen = no point of the map is in the chosen classes, boxes and storey: there is nothing to export; the map has { $tiles }
reread-more-scans = { $file } reads back wrong: more than { $count } scans
reread-scan-head = { $file } reads back wrong: head of scan { $index }
reread-scan-points = { $file } reads back wrong: points of scan { $index }
file-bytes = { $name }: expected { $expected } bytes, got { $found }
reread-columns = { $file } reads back wrong: expected 5 numbers a line, got { $shape }
box-numbers = box: expected six finite numbers, got { $box_m }
box-order = box: expected the smallest x, y, z and then the largest, got { $box_m }
clip-most = clip: expected at most { $most } boxes, got { $count }
clip-numbers = clip: expected the middle x, y, z, edges above 0 and a turn in degrees, got { $box }
classes-unknown = classes: expected some of { $every_class }, got { $unknown }
thinning-range = thinning: expected 0 to 100 m, got { $thin_m }
thinning-least = thinning: expected at least 0.0001 m, got { $thin_m }

## Deliveries and reports

check-unknown = { $file }: expected a project, a delivery (.zip) or a report (.pdf) of recon4
check-no-manifest = { $file }: expected a { $manifest }: this is no delivery
export-no-map = { $project } has no map of points yet: process it first
control-changed = the control points were changed after this map was made: make it again
zip-comment = { $file }: expected no comment at its end
zip-end = { $file }: expected the end of its list of entries at its end
zip-beyond = { $file }: { QUOTED($filename) } begins beyond its end
zip-differs = { $file }: { QUOTED($filename) } differs from the list at its end
zip-unpack = { $where }: { $filename } cannot be unpacked: { $text }
zip-twice = { $file }: { QUOTED($filename) } is in it twice
zip-expected = { $file }: expected a whole ZIP file, but its end is missing or damaged ({ $why }): have it sent again
zip-many = { $file }: expected at most { $max_files } files, got { $count }
zip-refused = { $file }: { QUOTED($name) } is refused: { $wrong }
zip-list = { $file }: the list at its end { $wrong }
zip-entry = { $file }: { QUOTED($name) } { $wrong }
zip-name-invisible = its name is empty, too long or has invisible characters
zip-name-outside = its name leads outside
zip-name-reserved = its name has characters that stand for something else on other systems
zip-name-separator = its name holds a NUL or a separator of another system
zip-no-file = expected a file, got a folder, a link or a device
zip-encrypted = it is encrypted
zip-compression = its compression, number { $number }, is not stored or deflated
zip-expands = it expands from { $packed } to { $size } bytes
zip-overlap = overlaps with another entry
zip-gap = has bytes of no entry before it
zip-large = { $where }: { $filename }: expected at most { $most } bytes, got more
deliver-kind = expected a kind of file: { $kinds }; got { QUOTED($name) }
deliver-option = { $title } takes no { $option }: leave it out
manifest-format = { $manifest }: expected a { $kind } of format { $delivery }
manifest-files = { $manifest }: expected 1 to { $max_files } files, got { $count }
manifest-changed = { $manifest } was changed after it was signed
deliver-zip = a delivery must be named .zip, got { $out }
deliver-license = the license { $license } is no file
deliver-no-map = { $project } has no map yet: run recon4 process
deliver-map-changed = the map was made again while it was packed: deliver it once more
deliver-files = --files { QUOTED($word) }: expected some of { $known }
deliver-made-earlier = { $file } was made of an earlier map: export it again, then deliver it
deliver-made-state = { $file } says “{ $was }” of the approval, the map is “{ $now }”: export it again, then deliver it
deliver-made-gone = { $file } was removed since it was chosen: export it again, then deliver it
deliver-made-altered = { $file } is not the file that was exported: its SHA-256 is another; remove it and export it again
deliver-no-file = a delivery holds at least one file: choose one
check-not-signed = it is not signed
check-pdf-not-signed = it is not signed: a draft, or not of recon4
check-pdf-certificate = the signature is intact; it is by the certificate of { $name }, SHA-256 { $sha256 }: compare this with what the signer tells you
deliver-choice = { $file }: what is in it is given for a delivery, and only for one
deliver-failed = { $out } cannot be made: { $why }
pkcs12 = { $file } cannot be opened: expected PKCS#12 with this passphrase
pdf-unreadable = { $file } is not a PDF that can be read: { $text }
report-no-run = expected a project with a finished run, got { $root }
report-2d = { $root }: a report for the client is made of a finished 3-D map
pdf-layout = the report cannot be laid out: { $message }
pdf-packages = a PDF needs the extra packages typst and pyhanko: { $install } ({ $why })

## Drawings, terrain and volumes

contours-interval = contours: expected an interval above 0 m, got { $interval_m }
contours-many = contours: expected at most { $max_levels } heights, got { $high }: use a larger interval
drawing-formats = a drawing is written as { $drawings }, got { $file }
orthophoto-none = orthophoto: the map has no points in { $plane }
orthophoto-line-none = orthophoto: the map has no points along the line of { $plane }
storey-unknown = no storey named { $name }; there are: { $names }
storeys-none = the map has no storeys: no floor below a ceiling was walked on
terrain-none = the map has no points, there is no terrain
heap-nothing = volume: nothing was seen inside of the polygon
heap-corners = volume: expected three corners or more, got { $count }
heap-no-area = volume: the polygon encloses no area: { $shape }
heap-border = volume: expected { $border_cells } cells with ground along the border, got { $rows }; give the height of the base
heap-border-line = volume: the ground along the border lies on a line
product-endings = a { $kind } is written as { $endings }, got { $file }
plan-no-wall = plan: no wall that reaches a ceiling was found
contours-none = contours: the terrain crosses no multiple of { $interval_m } m: use a smaller interval
number-positive = { $name }: expected a number above 0, got { $value }

## Comparison of two maps

compare-no-map = { $root } has no map of points: process it first
compare-no-points = the map of { $second } has no points
compare-not-rigid = { $first } and { $second } do not differ by a rigid motion: their corners are { DECIMAL($off_m, digits: 2) } m off
compare-crs = { $first } is in { $first_crs }, { $second } in { $second_crs }: process one of them with the CRS of the other
compare-spacing = distance of core points: expected { $least } to { DECIMAL($most, digits: 0) } m, got { $core_spacing_m }
compare-length = { $field }: expected more than 0 and at most { DECIMAL($longest_m, digits: 0) } m, got { $value }
compare-no-frame = { $first } and { $second } have no common frame: they are of different recordings, and not both are georeferenced; align them first
write-endings = expected a file { $endings }, got { QUOTED($file) }

## Review and approval

certificate-unreadable = the certificate cannot be read: { $why }
corrections-need = classes of points need the results of { $missing }, which this project lacks: process its recording to the end first
summary-corrections-unreadable = summary.json: its corrections cannot be read: { $why }
corrections-count = { $file }: expected 1 to { $most } corrections, got { $count }
corrections-list = { $name }: expected a list of corrections
corrections-columns = { $name }: expected the columns shape and to, and of { $columns }, got { $names }
corrections-alike = alike: expected 0 to { SIGNIFICANT($most_different, digits: 6) }, got { SIGNIFICANT($value, digits: 6) }
corrections-places = { $name }: expected places as '{ $form }, { $form }', got { QUOTED($text) }
corrections-json = { $name } is no JSON: { $why }
corrections-cells = { $where }: more cells than the header names
corrections-shape = shape: expected box, sphere, prism, brush or like, got { QUOTED($other) }
corrections-number = { $name }: expected a number, got { QUOTED($text) }
decision-user = a decision needs the name of a user, got { QUOTED($who) }
decision-pair = a pair is two multiframes, the earlier first, got { $pair }
decision-pose = a pose is x y z and a quaternion x y z w, all finite
decision-measurement = a decision to { $kind } with or without a measurement
decision-acknowledgment = an acknowledgment needs a finding and a note, no other decision one
decision-control = a decision to { $kind } with or without control points
decision-correction = a decision to { $kind } with or without a correction of classes
decision-withdrawn = a decision to { $kind } with or without what is withdrawn
decision-assigns = a decision to { $kind } assigns nothing
decision-comment = a comment has a text
journal-no-decision = the journal has a row that is no decision: { $why }
journal-nothing-to = the journal is damaged: a row has nothing to { $kind }
pair-reach = reach must be 0 to { $max_reach } multiframes, got { $reach }
pair-three = three pairs of points are needed, got { $count }
pair-predicted = predicted pose: expected x y z and a quaternion x y z w, all finite, got { $predicted }
pair-line = the points in the { $name } place lie on a line; pick another one
pair-no-node = multiframe { $frame } is no node of the pose graph
signing-key-kind = signing key { $file }: expected { $algorithm }, got { $kind }
signing-key-unreadable = signing key { $file } cannot be read: { $why }
review-no-graph = { $root } has no verified graph yet: there is nothing to review
stage-missing = expected an artifact of the stage { $stage }, the project has none
stamp-target = { $target } cannot carry an approval
stamp-laz = a LAZ file of version 1.4 was expected
stamp-png = a PNG file was expected
stamp-json = a JSON object was expected
summary-stages-unreadable = summary.json: its list of stages cannot be read: { $why }
keys-public = expected a public key of 64 hexadecimal digits, as recon4 keys list shows it on the signer's computer, got { QUOTED($public_key) }
keys-name = expected a name of 1 to { $max_name_characters } visible characters
keys-several = { $found } named { QUOTED($wanted) }: give the fingerprint
keys-own = this server signs with the key { $fingerprint }: make another first (recon4 keys renew), then remove this one
keys-format = expected format { $trusted_key }
keys-other-name = it is not the key that it is named after

## Classes of points

classes-rows = { $file }: expected { $expected } multiframes, got { $got }
classes-missing = the points of this map have no classes: an earlier version of recon4 made it; process its recording again
class-unknown = unknown class { QUOTED($name) }; known: { $known }
class-expected = expected classes of points, got { $to } and { $only }
class-none-changed = a correction of classes changes at least one point
volume-finite = { $name }: expected finite coordinates, got { $every }
volume-axes = { $name }: expected u and v of length 1 at a right angle, got { $axes }
volume-size = { $name }: expected a volume that is not empty, up to { DECIMAL($longest_m, digits: 0) } m long, got { $lengths_m }
prism-corners = prism: expected 3 to { $most_corners } corners, got { $count }
prism-crosses = prism: expected a polygon whose edges do not cross: { $polygon }
brush-places = brush: expected 1 to { $most_places } places, got { $count }
brush-thickness = brush: only a stroke on a slice has a thickness
brush-normal = brush: expected a normal of length 1, got { $across }
clusters-edge = clusters: expected cubes of { SIGNIFICANT($least_m, digits: 6) } to { SIGNIFICANT($most_m, digits: 6) } m, got { SIGNIFICANT($got_m, digits: 6) } m
clusters-finite = clusters: expected finite coordinates, got { $got }
clusters-axes = clusters: expected u and v of length 1 at a right angle, got { $u }, { $v }
clusters-columns = clusters: expected columns i, j, first and last, near the origin
clusters-many = clusters: expected 1 to { $most } clusters of { $most_columns } columns at most, got { $got } of { $columns }
clusters-empty = clusters: expected a cube in each cluster

## Maps and trajectories

map-missing = the project has no map yet
map-not-yet = { $out } has no map yet: process its recording to the end first
explain-code = expected the code of a finding, got { QUOTED($code) }{ $hint }
georeference-unreadable = georeference.json cannot be read: { $why }
summary-findings-unreadable = summary.json: its findings cannot be read: { $why }
intensity-none = intensity cannot be normalized: there are no points to learn from
map-no-tile = no tile { $tile }
map-no-field = the map has no field { $unknown }; it has { $fields }
map-tile-changed = tile { $ijk } of the map was changed: { $why }
map-list = { $file } is not the list of a map's tiles: { $why }
place-expected = expected a place in the map, got { $place_m }
trajectory-empty = the trajectory is empty
trajectory-outside = time { DECIMAL($from_s, digits: 3) } … { DECIMAL($to_s, digits: 3) } s is outside the trajectory, which covers { DECIMAL($begin_s, digits: 3) } … { DECIMAL($end_s, digits: 3) } s
multiframe-sensor = multiframe { $frame } has points of sensor { $sensor }, but rig { QUOTED($rig) } has { $sensors } sensors, numbered from 0
map-2d-unreadable = { $folder }: the 2-D map cannot be read: { $why }
grid-large = the occupancy grid would be { DECIMAL($width_m, digits: 0) } x { DECIMAL($height_m, digits: 0) } m in cells of { SIGNIFICANT($cell_m, digits: 6) } m: expected at most { $max_cells } cells. Is a position wrong? Larger cells need less
laser-no-scans = { $folder } has no scans of a 2-D laser
laser-few-returns = none of the { $count } scans has enough returns between { SIGNIFICANT($min_range_m, digits: 6) } and { SIGNIFICANT($max_range_m, digits: 6) } m

## Pose graph

graph-no-node = the graph has no node
graph-pose = pose of node { $node } is not a finite rigid motion
graph-edge-nodes = edge { $row } joins nodes { $i } and { $j }; there are nodes 0 to { $nodes }
graph-edge = edge { $row } (nodes { $i } and { $j }): { $what }
graph-not-connected = the graph is not connected: { $count } of { $nodes } nodes cannot be reached from node 0, the first is node { $cut_off }
graph-prior-node = a prior names a node outside 0 to { $nodes }
graph-prior-finite = a prior is not finite
graph-gauge = the gauge is free: expected a fixed node or a prior, got none
graph-not-finite = the optimizer met a number that is not finite
graph-prior-deviation = a prior has a standard deviation that is not positive
imu-chain = the chain of { $states } states cannot be solved: { $why }

## Simulation

simulate-seed = the seed must not be negative, got { $seed }
simulate-seconds = a walk takes 5 s to 1e6 s, got { $seconds }
simulate-rig = { $rig }: expected a profiler, a 2-D laser and no other LiDAR
simulate-not-profiler = { $wrong }: not possible on a rig with a profiler
simulate-exists = { $out } exists already; give a new folder
simulate-people = 0 to { SIGNIFICANT($most_people, digits: 6) } people can walk along, got { $people }
simulate-vehicles = 0 to { SIGNIFICANT($most_vehicles, digits: 6) } vehicles can move, got { $vehicles }
simulate-degradation = no degradation named { QUOTED($name) }; there are: { $kinds }
simulate-degradation-range = { $name }: expected more than 0 and at most { $largest }, got { $value }
simulate-dead-beams = dead-beams: at most { $lasers } of a LiDAR here, got { $count }
simulate-degradation-number = { $name }: expected a number, got { QUOTED($text) }
simulate-model = a LiDAR { QUOTED($model) } is not simulated; simulated: { $value }
simulate-no-figure = no figure named { QUOTED($name) }; there are: { $figures }
simulate-figure-floor = { $world } has no free floor for a figure; the hall has one
simulate-lidars = expected one or two LiDARs, got { $count }
simulate-imu = the IMU of a { $model } is not simulated ({ $sensor })
simulate-only-profiler = { $wrong }: only possible on a rig with a profiler
simulate-velodyne = { $wrong_model }: only possible if the last LiDAR is a Velodyne, got { $last }
simulate-targets-count = targets: expected 0 or more, got { $count }
simulate-targets-room = targets: there is room for { $k } of { $count } along this walk
simulate-world = no world named { QUOTED($base) }; there are: { $worlds }
simulate-variant = a variant is a number of 0 to { $max_variant }, got { QUOTED($name) }
simulate-no-variants = { $base } has no variants, got { QUOTED($name) }

## Backups

restore-not-empty = { $root } is not empty: a backup is restored into an empty folder
restore-no-keys = { $file } was made without keys: leave out --with-keys
restore-no-room = { $root }: the backup has { DECIMAL($needed, digits: 1) } GB, the disk has { DECIMAL($free, digits: 1) } GB free
backup-no-server = { $root } is neither a project nor a folder that a server ran on
backup-inside = { $out } lies in { $root }: a backup belongs elsewhere, best on another disk
backup-no-hash = not a SHA-256: { QUOTED($sha256) }
restore-same-name = { QUOTED($name) } is there already: the disk takes two names as equal
backup-size = { $place }: expected { $sizes } bytes, got { $found }
backup-hash = { $place }: expected SHA-256 { $sha256 }, got { $got }
backup-copy = { $source } cannot be copied: { $why }
backup-none = { $backup } holds no backup: expected files named by time, .json
backup-changed = { $file } is not the listing of a backup, or was changed
backup-outside = { $file }: the name { QUOTED($name) } leads outside the backup
backup-no-name = { $file }: { QUOTED($name) } is no name of a file
backup-folders = { $file }: { QUOTED($name) }: expected at most { $folders } folders, got { $count }
backup-bytes = { $file }: { $name } has { $bytes } bytes
backup-no-listing = { $file } is not the listing of a backup: { $why }
free-failed = cannot free { $part }: { $why }
free-unknown = { $where } cannot be read, so what it needs is not known
not-a-project = { $file } is not a recon4 project

## Many walks

batch-summary = { $summary } of { $task }: { $why }
batch-no-folder = no folder { $folder }: give the one that holds the recordings
batch-one = { $folder } is one recording: command: recon4 process { $folder }
batch-none = { $folder }: expected recordings in it, found none
batch-same-name = { $both }: both would become the project { $name }: rename one

## Live capture

project-exists-already = project { $project } exists already; choose another name
serial-gone = the device is gone
serial-baud = { $baud } baud: { $why }
replay-none = { $recording }: no UDP datagram found
replay-send = cannot send to { $target }: { $what }
session-numbers = { $file }: expected speed > 0 and least_free_bytes >= 0, got { $speed } and { $least_free_bytes }

## Commands

doctor-no-folder = no folder { $folder }: give the one that holds the projects
out-toml = --out: expected a file that ends with .toml, got { QUOTED($out) }
out-not-written = { $out } was not written: { $outcome }
classify-both = expected CORRECTIONS or --undo, got both
classify-apply = --apply: expected CORRECTIONS or --undo
classify-unknown = no correction { $unknown }; there are: { $there }
classify-refused = { $where }: { $text }; nothing was changed
compare-no-earlier = { $project } has no earlier map any more: name another project
control-survey-files = SURVEY: expected the survey and at most one file of covariances
control-no-picks = no point was picked in this map on the page Slices: give --picks
control-no-survey = SURVEY: expected a file with surveyed points
control-pick = { $picks }: { $marker }: expected x, y and z of the place in the map
report-name = name the file to write: --client FILE or --html FILE
accept-projects = --accept is for projects: what was received is only compared
passphrase-missing = the passphrase of { $certificate } is missing: put it into the environment, { $passphrase }, or into a file named by { $passphrase_file }
evaluate-needs = expected --truth, --markers or --patch
evaluate-report = --report needs --truth
evaluate-patch-project = --patch: expected a project with a map, got { $project }
evaluate-patch-numbers = --patch: expected nine numbers with commas, got { QUOTED($text) }
export-as-is = { $ending } is written as it is: only --draft can be given
export-gpkg = .gpkg takes only --crs and --draft
kernel-cache-others = compiled kernels are code, and others may have put some there: { $why }; remove the folder, or name another one (NUMBA_CACHE_DIR)
terrain-surface = a surface is dtm or dsm, got { QUOTED($name) }
reference-frame = --frame: expected auto, map or crs, got { QUOTED($asked) }
simulate-rig-lidar = give --rig or --lidar, not both
simulate-figure = --figure is for rigs with a profiler, as --rig wuerzburg
simulate-targets = --targets is for rigs without a profiler
slice-where = say where to cut: one of --z, --line, --plane
numbers-commas = expected { $count } numbers with commas, got { QUOTED($text) }
storage-free = command: --free { QUOTED($word) }: expected one of { $known }
option-unit = --unit: expected one of { $units_m }, got { QUOTED($unit) }
scheduler-tls = command: --scheduler needs --tls FOLDER with its certificates
stage-killed = ended by { $code }: too little memory? The same command goes on after its last finished stage

## Server and its commands

access-unusable = { $file } cannot be used: { $why }
access-lost = { $file } is damaged ({ $damage }) and there is no intact copy of it, so it is not known who may sign in: the server does not start. Put the file back from a backup that was made with --with-keys; or, to begin without people, move it and backups/{ $stem }-*.sqlite away: the next start shows the link for a first admin
access-damaged = { $file } is damaged ({ $damage }): start the server, which puts back its newest copy
notes-format = { $name }: expected format { $format }, got { $found }
file-unreadable = { $name } cannot be read: { $why }
assistant-address = expected the address of a server, as http://127.0.0.1:8000/, got { QUOTED($url) }
assistant-password = a password does not belong into an address, which others can see
assistant-tls = { $url } has no TLS: the password would cross the network readably
assistant-certificate = { $certificate } is no certificate in PEM: { $why }
keys-no-server = no server ran on { $root }: it has no folder { $state }
cannot-write = cannot write { $name }: { $why }
mcp-password = the password of the account is expected in { $password }
mcp-downloads = no folder { $downloads } for downloads
mcp-package = recon4 mcp needs the package { $why }: pip install 'recon4[mcp]'
users-no-log = { $root } has no audit log: no server ran there
users-role = no role { QUOTED($text) }; one of { $roles }
users-passwords = the two passwords differ
behind-address = --behind must be the address that browsers use, as https://maps.example.org/ or https://example.org/recon4/, got { QUOTED($url) }
behind-path = --behind: the path may have letters A-Z, digits, '.', '_' and '-' between single slashes, as https://{ $hostname }/recon4/, got { QUOTED($url) }
behind-invalid = --behind: { QUOTED($url) } is no address: { $why }
tls-no-file = no file { $file }: give --tls-cert and --tls-key as PEM files
tls-no-pair = { $chain } and { $key } are not a certificate and its key (PEM, without password): { $why }
server-other = another server runs on { $root }; use that one
server-state = { $state } cannot be used: { $why }; it is for the user who runs the server
server-read-only = { $root } cannot be written, so nobody can sign in and nothing can be logged: serve a copy of it, or serve it without --lan and --behind
server-port = port { $port } is in use ({ $why }); choose another with --port
calibration-unreadable = { $file } of this project makes no sense: { $place }: { $first }
server-host = will not listen on { QUOTED($host) }: without TLS and login only loopback (127.0.0.1) is allowed; use --lan for both, or from another computer: ssh -L 8000:127.0.0.1:8000 THIS-HOST
server-behind-lan = --behind and --lan exclude each other: the proxy does TLS
server-tls-both = give --tls-cert and --tls-key together, or neither
server-root-utf8 = the path { $root } is no UTF-8 text, so no request can name it: rename the folder
projects-no-folder = no folder { $root }: give the folder that holds the projects
projects-is-project = { $root } is a project itself: give the folder that holds it, { $parent }
server-port-range = port must be 0 to 65535, got { $port }
server-certificate-lan = a certificate goes with --lan, which also turns on the login

## Workers

command-workers = command: --workers: expected 1 to { $most_workers }, got { $count }
command-scheduler = command: --scheduler: expected tls://HOST:PORT, got { QUOTED($scheduler) }: anyone who reaches a scheduler without certificates can run programs on its workers
scheduler-no-workers = the scheduler has no workers: start some
scheduler-certificate = no such certificate or key: { $file }
scheduler-version = { $address }: expected recon4 { $expected } as here, got { $got }
scheduler-folder = { $address } does not see { $shared }: all workers need this folder, under the same name
scheduler-silent = no scheduler answers at { $scheduler }: { $why }

## Stored files

arrays-missing = { $file }: expected arrays { $names }, got none of { $missing }
array-rows = { $file }: { $name }: expected rows of { $expected }, got { $got }
file-ends-early = { $file } ends early
file-sample-large = { $file } has a sample of { $count } points
name-no-utf8 = { $wrong }: the name is no UTF-8 text: rename it
cannot-read = cannot read { $file }: { $why }
json-not-object = { $what } cannot be read: expected an object, got { $kind }
stage-none-before = { $root } has no finished stage { $stage } to go on from: process its recording again
stage-figures-lack = { $file } cannot be read: it lacks { $why }
stage-figures = { $folder }: its figures make no sense: { $why }
file-damaged = { $file } is damaged: { $why }
sockets-no-place = no place for sockets: { $problems }
sockets-folder = { $file }: expected a folder of user { $user } with mode 0700, got { $mode } of user { $owner }: remove it

## What is quoted, and further problems

findings-endings = findings are written as .csv or .geojson, got { $got }
no-ending = no ending
control-few = expected at least { $least } control points that are found in the map, got { $got }{ $names }
serial-no-line = gnss: serial: { $path } is no serial line but { $kind }: it is not opened
serial-other-device = another device
decision-names-pair = a decision to { $kind } names a pair
decision-names-no-pair = a decision to { $kind } names no pair
control-no-line = { $name }: no line of ID,X,Y,Z found; { $first }
control-absent = not in the map: { $names }; no scan has points within 25 cm of where { $count ->
    [one] it was
   *[other] they were
 } picked
delivery-wrong = the delivery reads back wrong: { $files }
delivery-files-missing = files missing

## Read again: what differs from its hash, seal or signature

damage-manifest = manifest.json: its list of files makes no sense: { $why }
damage-missing = { $name } is missing
damage-unexpected = { $name } does not belong here
damage-size = { $name } has another size
damage-bytes = { $name } has other bytes
damage-folder = is missing
damage-records = { $ledger } and manifest.json have different records of it
damage-version = version { $version }: { $what }
seal-none = { $name } has no seal (an earlier recon4 wrote it): only its content was checked
seal-open = { $name } is open (in use, or a process was killed): only its content was checked
journal-row-missing = row { $row } is missing
journal-row-follows = row { $row } does not follow the row before it
journal-row-changed = row { $row } ({ $kind } by { $who }) was changed
approval-untrusted = version { $version } by { $who }: { $why }
approval-no-row = versions/{ $name } is in no row of the journal: the row was removed, the journal is an older one, or the approval was interrupted
approval-valid = version { $version }, approved by { $who }, { $time }, key { $fingerprint } ({ $name }){ $verdict ->
    [none] {""}
   *[other] , verdict "{ $verdict }"
 }{ $why ->
    [none] {""}
   *[other] , reason "{ $why }"
 }
