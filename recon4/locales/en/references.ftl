### What is said of a reference: whether it fits, how it is aligned, how it was read.

## Whether it fits the map

reference-far = ✕ The reference does not fit: { PERCENT($near, digits: 1) } of the map is within { $limit_cm } cm of it
reference-unjudged = – Not judged whether the reference fits: hardly any flat surface in both
reference-fits = ✓ The reference fits: where both are, { AGREEING($walls, $level) } lie within { $limit_cm } cm of a surface of the same orientation
reference-misfit = ✕ The reference does not fit: where both are, { AGREEING($walls, $level) } lie within { $limit_cm } cm of a surface of the same orientation
word-agreeing-walls = { PERCENT($walls, digits: 0) } of the walls
word-agreeing-level = { PERCENT($level, digits: 0) } of the floors and ceilings
word-agreeing-both = { PERCENT($walls, digits: 0) } of the walls and { PERCENT($level, digits: 0) } of the floors and ceilings

## How it is aligned

alignment-none = none
alignment-by-hand = moved by hand
alignment-icp = ICP, point to plane: { PERCENT($near, digits: 0) } of the map near it, of these { PERCENT($on, digits: 0) } on it, { LENGTH($mean_m) } from it on average
alignment-pairs = { $pairs } pairs, largest residual { LENGTH($largest_m) } (each [cm]: { NUMBERS($each_cm) })
alignment-not-refined = not refined
align-pairs-few = alignment: expected three pairs of points or more, got { $pairs }
align-pairs-line = alignment: the points lie on a line, so the rotation about it is undetermined
align-pairs-place = alignment: the points lie at one place, so the rotation is undetermined
align-apart = ICP: the map and the reference do not overlap: { PERCENT($near, digits: 1) } of the map is within { $limit_cm } cm of it; use Align by pairs
align-off = ICP did not align the reference with the map: { PERCENT($on, digits: 0) } of the map near it is within { $limit_cm } cm of its surface; use Align by pairs
align-endless = ICP did not align the reference with the map: no convergence after { $rounds } iterations; use Align by pairs
align-far = ICP: { reference-far }; use Align by pairs
align-misfit = ICP: { reference-misfit }; use Align by pairs
align-nothing-to-undo = this reference was not aligned yet: there is nothing to undo

## How it was read

note-crs-problem = It states { $problem }: not used.
note-unit-chosen = Read in { NAMED($unit, of: "word-unit") }, as chosen.
note-unit-converted = Coordinates in { NAMED($unit, of: "word-unit") }, converted to meters.
note-height-unit-unknown = The unit of its heights is not stated: taken as { NAMED($unit, of: "word-unit") }.
note-height-unit-converted = Heights in { NAMED($unit, of: "word-unit") }, converted to meters.
note-no-crs = No CRS is known of it: its coordinates are taken as those of { $own }.
note-local = It is in { $crs }; the map is local, so that its coordinates are used unchanged.
note-frame-chosen = It is in { $crs }; the map's frame was chosen, so that its coordinates are used unchanged.
note-same-crs = In { $crs }, the CRS of the map.
note-transformed = Transformed from { $crs } to { $own }.
note-accuracy = The transformation is accurate to { SIGNIFICANT($accuracy_m, digits: 3) } m ({ $operation }).
note-height-datum-unknown = It states no datum of its heights: taken as those of the map ({ NAMED($of_map, of: "word-datum") }).
note-height-datums = Its heights are { NAMED($of_file, of: "word-datum") }, those of the map { NAMED($of_map, of: "word-datum") }: not converted, they may differ by tens of meters.
note-beside = It lies { DECIMAL($away_m, digits: 0) } m beside the map: align it, or choose another frame.
note-far-away = It lies { DECIMAL($away_km, digits: 0) } km beside the map: align it, or choose another frame.
word-unit-meters = meters
word-unit-decimeters = decimeters
word-unit-centimeters = centimeters
word-unit-millimeters = millimeters
word-unit-kilometers = kilometers
word-unit-international-feet = international feet
word-unit-us-survey-feet = US survey feet
word-unit-inches = inches
word-datum-above-the-ellipsoid = above the ellipsoid
