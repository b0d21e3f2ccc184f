### What witnesses find, and the words of verdicts.
### docs/how-to/languages.md says how texts are written and translated.

## Verdicts

headline-good = No problem found in this map
headline-check = Check this map
headline-do-not-use = Do not use this map

## Headings of recon4 explain

explain-detected = Detected:
explain-remedy = What to do:

## Words that findings quote

word-gps-utc = GPS time against UTC
word-tai-utc = TAI against UTC
word-tai-gps = TAI against GPS time
word-time-zone = whole hours, as in a time zone
word-power-on = a clock that counts from power-on
word-absent = it has no values, or is declared as not measured
word-zero = all its values are 0
word-constant = it does not measure
word-imu = IMU
word-gnss = GNSS antenna
word-x = x
word-y = y
word-z = z
word-rig-switched-off = the comparison is switched off
word-rig-no-lidar = no LiDAR is enabled
word-rig-nothing-to-compare = there is nothing to compare: neither a second LiDAR nor a usable IMU
word-rig-no-planes = no window of the walk has planes to compare
word-rig-unobserved = the walk shows nothing of it
word-rig-agrees = the file agrees with the recording
word-rig-contradicts = the file contradicts the recording
word-rig-calibrated = calibrated; windows that were not used confirm it
word-rig-too-short = the walk is too short to check the calibrated rig on another part of it
word-rig-beams-agree = nothing is corrected: mounts, clocks and beams agree with the file
word-rig-not-confirmed = inconclusive: longer windows do not confirm what the audit found
word-rig-other-values = inconclusive: another part of the walk gives other values
word-rig-explained-worse = inconclusive: another part of the walk is explained worse
word-rig-no-better = inconclusive: another part of the walk is explained no better
word-gnss-agrees = the fixes agree with the file
word-gnss-contradicts = the fixes contradict the file
word-gnss-only-aided = without the fixes the walk shows no error of theirs
word-gnss-too-short = inconclusive: the walk is too short to check the receiver on another part of it
word-gnss-other-values = inconclusive: another part of the walk gives other values
word-gnss-no-better = inconclusive: the fixes of another part of the walk are explained no better
word-gnss-confirmed = calibrated; fixes that were not used confirm it

## Nothing was checked

NOTHING-CHECKED = Nothing was checked
    .text1 = Nothing of this map could be checked.
    .meaning = No check had the data that it needs. The map may be right, but nothing supports it.
    .detection = There is no other finding.

## The recording

IMPORT-INCOMPLETE = Recording incomplete
    .text1 = The recording was read as: { $outcome }.
    .meaning = A file is cut off or damaged, and what could be read of it was read.
    .detection = The reader of the recording reports that it salvaged data.

IMPORT-REMARK = Warning of the import
    .text1 = { $text }
    .meaning = A reader repaired something, left something out or doubts something. The recording was read by an earlier version, which wrote sentences.
    .detection = Process the recording again for a finding with a code of its own.

IMPORT-UNUSED = Data not used
    .text1 = { $text }
    .text2 = { $number } of { $total } { NOUN($data) } are not used ({ PERCENT($ratio, digits: 0) }): { FATES($reasons) }.
    .meaning = A part of what was recorded is not in the map.
    .detection = All reasons together leave out at least 1 % of the data of one kind. From one half on the map must not be used.

EARLIER-REMARK = Remark of an earlier version
    .text1 = { $text }
    .meaning = The stage was made by an earlier version, which wrote sentences.
    .detection = Process the recording again for the findings of this version.

HEIGHTS-ORTHOMETRIC = Heights above sea level
    .text1 = The heights of { $fixes } fixes are above sea level (orthometric), and nothing says how high the geoid is there: heights of the map are wrong by that, tens of meters.
    .remedy = Give it by the settings gnss.heights and gnss.geoid_separation_m, or record it.
    .meaning = The map is georeferenced with heights of another kind than it states.
    .detection = The receiver states heights above sea level without a geoid separation.

HEIGHTS-UNSTATED = Kind of heights not stated
    .text1 = Nothing says whether the heights of { $fixes } fixes are above the ellipsoid or above sea level (orthometric): they are taken as ellipsoidal. If they are above sea level, all heights of the map are wrong by the geoid separation, tens of meters.
    .remedy = Say it by the setting gnss.heights, or in the recording by the names of the columns.
    .meaning = All heights of the map may be shifted by tens of meters; its shape is not affected.
    .detection = The recording has fixes whose format does not define the kind of their heights.

## Tracking

TRACKING-KEPT = Tracking never lost
    .text1 = Tracking was not lost in any of { $multiframes } multiframes.
    .meaning = Each multiframe was registered to the map of those before it.
    .detection = No multiframe is marked as lost by the odometry.

TRACKING-LOST = Tracking lost
    .text1-if-so_far = Tracking was lost in { $lost } of { $multiframes } multiframes ({ PERCENT($ratio, digits: 1) }).
    .text2 = Tracking was lost in { $lost } of { $multiframes } multiframes ({ PERCENT($ratio, digits: 1) }), first { DECIMAL($first_s, digits: 1) } s after the start.
    .text3-if-held = What was registered around them holds the map.
    .meaning = For some time no multiframe could be registered. What follows is joined by the IMU or by loop closures only.
    .detection = The odometry rejects the registration of a multiframe. It is *check* if at most 10 % are lost, never for more than 2 s, and all positions are known well nevertheless; else *do not use*.

LASER-POSES-MISSING = No poses by the 2-D laser
    .text1 = The 2-D laser gives no pose in { $lost } of { $multiframes } multiframes ({ PERCENT($ratio, digits: 1) }), first { DECIMAL($first_s, digits: 1) } s after the start.
    .text2-if-held = There the IMU and what the profiler saw again at other times hold the map.
    .text3-if-not_held = In { $not_held } of them the profiler saw too little again to hold the map.
    .meaning = The first trajectory is bridged by the IMU there.
    .detection = No scan of the 2-D laser was tracked near the multiframe. *Do not use* if the refinement does not observe it either.

NOT-CONVERGED = Registration did not converge
    .text1 = The registration converged in only { $converged } of { $multiframes } multiframes ({ PERCENT($ratio, digits: 1) }).
    .text2 = { $far ->
        [one] { $far } multiframe did not converge and lies { LENGTH($far_m) } from where it was expected
       *[other] { $far } multiframes did not converge and lie up to { LENGTH($far_m) } from where they were expected
     }, first { DECIMAL($far_s, digits: 1) } s after the start: they may be as wrong.
    .meaning = Poses come from iterations that were stopped: their accuracy is not known.
    .detection = Less than 90 % of the multiframes converged (*do not use* below 50 %), or one that did not is more than 10 cm from its prediction.

SEPARATE-PIECE = Separate piece
    .text1 = From { DECIMAL($start_s, digits: 0) } s to { DECIMAL($end_s, digits: 0) } s after the start the walk is a separate piece of { $multiframes ->
        [one] { $multiframes } multiframe
       *[other] { $multiframes } multiframes
     }: how the body got there was not recorded, and no place of it was recognized. Its position in the map is not known.
    .remedy = A loop closure by hand joins it.
    .meaning = The relative pose of two parts of the walk is not known.
    .detection = Tracking was lost or the recording has a gap, and no edge of the graph joins both sides.

GAP-BRIDGED = Gap bridged by one registration
    .text1-if-several = The scans before and after a gap or a lost scan were joined by one registration { $count } times (first { DECIMAL($first_s, digits: 0) } s after the start, the longest of { DECIMAL($longest_m, digits: 1) } m at { DECIMAL($longest_s, digits: 0) } s).
    .text2-if-single = The scans before and after a gap or a lost scan were joined by one registration once ({ DECIMAL($first_s, digits: 0) } s after the start, { DECIMAL($longest_m, digits: 1) } m long).
    .text3 = Where two places look alike such a joint can be wrong.
    .remedy = Check the map there.
    .meaning = One registration without a prediction decides how two parts of the walk lie to each other.
    .detection = A scan that the odometry could not track was laid onto the last ones from many initial poses, and only one fits.

TOO-FAST = Faster than a person
    .text1 = The trajectory moves at { DECIMAL($fastest_m_s, digits: 1) } m/s, { DECIMAL($at_s, digits: 0) } s after the start; { $seconds } s of it are faster than a person walks ({ DECIMAL($limit_m_s, digits: 0) } m/s).
    .meaning = The trajectory jumped: a registration was wrong.
    .detection = Positions one second apart are farther from each other than 4 m.

MOVING-OBJECTS = Moving objects
    .text1 = Between { DECIMAL($start_s, digits: 0) } s and { DECIMAL($end_s, digits: 0) } s moving objects (people, vehicles) fill up to { PERCENT($most, digits: 0) } of the view, most at { DECIMAL($most_s, digits: 0) } s.
    .text2 = { WORD($outcome, of: "MOVING-OBJECTS") }
    .text3-if-points_left_out = { COUNT($points_left_out) } points are left out of the map.
    .word-kept = Their points are in the map, and may have pulled the trajectory along.
    .word-left-out = Most of their points are left out: the rest holds the trajectory.
    .word-not-settled = Without their points the trajectory still changes with every pass of the odometry.
    .word-contradicted = The trajectory without their points contradicts the positions of the GNSS/INS: these are wrong, or what is left of the view does not hold it.
    .word-not-held = The rest does not hold the trajectory, so they stay in and pull it along. Record again without people around the carrier.
    .meaning = Who walks along seems to stand in the body, and pulls the trajectory along.
    .detection = Scans some seconds before or after see through at least 10 % of the points of a scan. *Do not use* if what is left does not hold the trajectory.

## What the sensors do not observe

WEAK-DIRECTION = Direction hardly observed
    .text1-if-so_far = One direction was hardly observed for { DECIMAL($seconds, digits: 0) } s in all.
    .text2-if-known = Between { DECIMAL($start_s, digits: 0) } s and { DECIMAL($end_s, digits: 0) } s the LiDAR hardly observes { WORD($direction, of: "WEAK-DIRECTION") } direction (standard deviation of one multiframe { LENGTH($sd_m) }).
    .text3-if-unlimited = Between { DECIMAL($start_s, digits: 0) } s and { DECIMAL($end_s, digits: 0) } s the LiDAR hardly observes { WORD($direction, of: "WEAK-DIRECTION") } direction (standard deviation of one multiframe above 10 m).
    .text4-if-unstated = Between { DECIMAL($start_s, digits: 0) } s and { DECIMAL($end_s, digits: 0) } s the LiDAR hardly observes { WORD($direction, of: "WEAK-DIRECTION") } direction (degeneracy { DECIMAL($degeneracy, digits: 4) }, 0 = unobservable).
    .text5-if-open = The position along it may be wrong by meters, and no other figure shows it.
    .text6 = With what else holds it the shape of the map is known to ± { LENGTH($shape_m) } (2σ).
    .word-horizontal = a horizontal
    .word-vertical = the vertical
    .word-unknown = one
    .remedy = A control point, a loop or GNSS there would help.
    .meaning = In a corridor without doors, a tunnel or an open field the registration converges wherever along that direction the pose lies.
    .detection = The standard deviation of one multiframe is above 5 cm along a direction for at least 2 s. *Do not use* from 10 s in all on, if the map is not georeferenced. A note if the stated uncertainty of the positions is small all the same: an accelerometer carries the motion between frames that observe it, loops or fixes hold it.

WEAK-LASER = 2-D laser hardly observes a direction
    .text1 = For { DECIMAL($seconds, digits: 0) } s, first from { DECIMAL($start_s, digits: 0) } to { DECIMAL($end_s, digits: 0) } s, the 2-D laser hardly observes one direction; the profiler does.
    .meaning = The refinement with the profiler holds what the first trajectory does not.
    .detection = As WEAK-DIRECTION, with the 2-D laser alone and with the profiler.

WEAK-TURN = Turn hardly observed
    .text1 = Between { DECIMAL($start_s, digits: 0) } s and { DECIMAL($end_s, digits: 0) } s the surroundings look the same after a turn about the { $direction } axis at x { DECIMAL($x_m, digits: 1) } m, y { DECIMAL($y_m, digits: 1) } m, z { DECIMAL($z_m, digits: 1) } m from the start. It is so in a round hall or on bare ground: the LiDARs hardly observe it.
    .text2 = At the end the map may be turned by ± { DEGREES($turn_rad, digits: 1) } (2σ).
    .remedy = Put things there that stand out, or use GNSS.
    .meaning = In a round hall, a silo or a round stairwell only the gyroscope holds the heading, and no residual shows its error.
    .detection = The weakest motion of a multiframe is a turn with a deviation above 2 cm at the typical distance of its points. Its information per weight of the points is as curved walls feign it (below 0.009). Both last for at least 2 s, without fixes. A note if the stated uncertainty of the positions is small all the same.

UNCERTAINTY = Uncertainty of the positions
    .text1 = The shape of the map is known to ± { LENGTH($shape_m) } (2σ, after the best alignment of the whole walk; limit { LENGTH($limit_m) }).
    .text2 = A single position of it is known to ± { LENGTH($shape_worst_m) }.
    .text3-if-limited = The positions are known to ± { LENGTH($known_m) } (2σ) { WORD($frame, of: "UNCERTAINTY") } at worst, { DECIMAL($at_s, digits: 0) } s after the start.
    .text4-if-unlimited = The positions are known to ± more than 100 m (2σ) { WORD($frame, of: "UNCERTAINTY") } at worst, { DECIMAL($at_s, digits: 0) } s after the start.
    .text5 = A control point between { DECIMAL($point_from_s, digits: 0) } s and { DECIMAL($point_to_s, digits: 0) } s would reduce this to ± { LENGTH($point_m) }.
    .word-earth = on the earth
    .word-site = in the grid of the site
    .word-start = relative to the start
    .meaning = Stated from the covariances of the final graph; what is known to be wrong (rig, rides, turns) is added. A local map is aligned before it is used, so its shape counts: all positions after the best rigid alignment with the truth. A georeferenced map is used as it is, so its place on the earth counts, too.
    .detection = *Check* if twice the expected RMS of the shape exceeds 5 cm + 0.1 % of the path length. The same if the 2σ of a single position exceeds three times that, or twice the expected RMS on the earth 10 cm. *Do not use* from ten times of that on.

## IMU

IMU-MISSING = No IMU
    .text1 = There is no IMU: motion within a multiframe is estimated from the points alone.
    .text2 = The shape of the map is known to ± { LENGTH($shape_m) } (2σ).
    .remedy = Record one: turns and fast steps are known better with it.
    .meaning = What a missing IMU costs stands in the uncertainty of the positions; alone it is no fault of the map.
    .detection = The recording has no usable samples of a gyroscope.

IMU-NOT-USED = IMU not used
    .text1 = the IMU contradicts the LiDARs and is not used for the motion: the mean residual of the segments is { LENGTH($with_m) } with it, { LENGTH($without_m) } without it; check its axes, units and clock
    .meaning = The motion between two scans comes from the LiDARs alone.
    .detection = The first multiframes and those of the fastest turn fit clearly better (by a quarter and 2 mm) without the IMU, and its gyroscope does not explain their turns.

IMU-ACCELEROMETER-NOT-USED = Accelerometer not used
    .text1 = the accelerometer contradicts the LiDARs and is not used for the motion: the mean residual of the segments is { LENGTH($with_m) } with it, { LENGTH($without_m) } without it; check its axes, units and clock
    .meaning = The gyroscope is used, the accelerometer is not.
    .detection = As IMU-NOT-USED, but the gyroscope explains the turns that the LiDARs see.

IMU-BIAS-REMOVED = Gyroscope bias removed
    .text1 = gyroscope bias at the start ({ DEGREES($x_rad_s, digits: 1) }/s, { DEGREES($y_rad_s, digits: 1) }/s, { DEGREES($z_rad_s, digits: 1) }/s) was subtracted
    .meaning = The gyroscope does not read zero at rest; it is corrected.
    .detection = Its mean over the first half second is above 3.4 °/s, and multiframes fit clearly better without it.

IMU-SATURATED = IMU saturated
    .text1 = The { $sensor } is saturated, first { DECIMAL($first_s, digits: 1) } s after its start: it repeats its largest value, { $largest }{ WORD($unit, of: "IMU-SATURATED") } { $direction }, { $times ->
        [one] once
       *[other] { $times } times
     }. Faster motions are missing: there only the LiDARs observe them.
    .word-deg_s = °/s about
    .word-m_s2 = { " " }m/s² along
    .remedy = Record with a larger range.
    .meaning = The body turned or was pushed faster than the unit measures.
    .detection = At least five samples, three in a row, repeat the largest value of an axis above 1.5 rad/s or 14 m/s².

IMU-GRAVITY = Wrong gravity
    .text1 = The IMU measures { DECIMAL($found_m_s2, digits: 2) } m/s² over the walk where gravity is { DECIMAL($gravity_m_s2, digits: 2) } m/s²: its scale is { DECIMAL($percent, digits: 1, sign: 1) } % off, or its accelerometer has such a bias.
    .meaning = Accelerations, and often the turn rates of the same unit, have a wrong scale.
    .detection = The mean specific force over at least 10 s differs from gravity by more than 0.2 m/s². Up to 0.4 m/s² it may be the bias of a unit in order: a note.

IMU-UPSIDE-DOWN = Body upside down
    .text1 = By the accelerometer the body stands on its head: its z axis points { DEGREES($angle_rad, digits: 0) } away from up.
    .remedy = If it did not: an accelerometer at rest must measure +9.8 m/s² along the axis that points up. Reverse the sign of all accelerations and give them with --imu, or give the mount of the IMU in [imu] rpy_deg of the rig file.
    .meaning = With the sign of the accelerations reversed, or a wrong mount of the IMU, the motion is predicted the wrong way and tracking is lost when the body moves. A LiDAR that hangs upside down is no fault. A reversed sign is repaired where the motion shows it: IMU-FORCES-REVERSED.
    .detection = The mean acceleration of the walk is more than 115° away from the z axis of the body. A note; *check* if tracking was lost.

IMU-TURNED = IMU mounted otherwise
    .text1 = The IMU is mounted otherwise than the rig says, rotated by { DEGREES($angle_rad, digits: 0) }: by the rig its gyroscope measures { PERCENT($explained, digits: 1) } of the turns of the LiDARs, and rotated { PERCENT($explained_turned, digits: 1) }. Its samples were rotated.
    .remedy = Give its mount in [imu] of the rig file: rpy_deg = [{ $rpy_deg }].
    .meaning = The axes of the IMU are exchanged: it hangs upside down, its x axis points to the left, or the driver states another frame. The motion would be predicted about wrong axes.
    .detection = Where the IMU turns most about two axes the LiDARs track 40 multiframes alone. A rotation of more than 3° that is known to 3° makes the gyroscope measure over 90 % of their turns, and more than by the rig by at least four standard deviations.

IMU-AXES = Axes of the IMU exchanged
    .text1 = The driver of the IMU exchanges axes or signs. Of the axes that were recorded, its turn rates are ({ $gyro }) and its accelerations ({ $accel }), as the motion of the LiDARs shows. Its samples were repaired.
    .remedy = Let the driver publish turn rates ({ $gyro }) and accelerations ({ $accel }): no mount in a rig file says this. Or give repaired samples with --imu.
    .meaning = The axes of the IMU are left-handed, or its gyroscope or its accelerometer states a sign of its own. The motion would be predicted the wrong way.
    .detection = Where the IMU turns most about two axes the LiDARs track 40 multiframes alone. A reflection makes the gyroscope measure over 90 % of their turns, or other axes make forces change the speed as the LiDARs do; each fits better than any other by at least four standard deviations.

IMU-FORCES-REVERSED = Accelerations reversed
    .text1 = The accelerations of the IMU have the wrong sign: as recorded, they run against the motion that the LiDARs measure (correlation { DECIMAL($correlation, digits: 2) }). The sign of all { COUNT($samples) } samples was turned.
    .remedy = Nothing needs to be done. Other programs need the same: at rest, an accelerometer must measure +9.8 m/s² along the axis that points up.
    .meaning = The driver publishes gravity where the specific force is expected. The motion would be predicted the wrong way, and the map would stand on its head.
    .detection = By the accelerometer the body stands on its head, and in the stretches with the most motion the changes of speed by the LiDARs alone have the opposite sign: a correlation below -0.4.

IMU-GYRO-SCALE = Scale of the gyroscope
    .text1 = The gyroscope measures turns about { $direction } { PERCENT($size, digits: 1) } ± { PERCENT($sd, digits: 1) } too { WORD($way, of: "IMU-GYRO-SCALE") }: check its scale. The odometry corrected it.
    .word-large = large
    .word-small = small
    .meaning = The unit is not calibrated; the trajectory is corrected for it.
    .detection = The filter estimates an error of the scale above 1.5 % and five standard deviations.

IMU-GYRO-ROTATION = Rotation of the gyroscope
    .text1 = The gyroscope is rotated by { DEGREES($angle_rad, digits: 1) } ± { DEGREES($sd_rad, digits: 1) } against the rig file, as turns of the LiDARs show: check the mount of the IMU. The odometry corrected it.
    .meaning = The rotation of the IMU in the rig file is wrong; the trajectory is corrected for it.
    .detection = The filter estimates an angle above 0.7° and five standard deviations.

IMU-CLOCK = Clock of the IMU
    .text1 = The clock of the IMU is { DECIMAL($size_ms, digits: 1) } ms ± { DECIMAL($sd_ms, digits: 1) } ms { WORD($way, of: "IMU-CLOCK") } that of the LiDARs. The odometry corrected it.
    .text2-if-derived = The times of the points follow from the stamps of the clouds, and those may be late or meant for another moment of the cloud.
    .word-ahead = ahead of
    .word-behind = behind
    .remedy = Check the time offset of the rig file.
    .meaning = Samples of the IMU have times that do not fit those of the points; the trajectory is corrected for it.
    .detection = The filter estimates an offset above 4 ms and five standard deviations. A note if the times of the points are derived, as those of stamps that scatter are.

IMU-LEFT-HANDED = Axes of the IMU left-handed
    .text1 = The IMU contradicts the recording. The turn rates of the IMU fit the LiDARs only with left-handed axes: an axis has the wrong sign.
    .meaning = No calibration corrects a driver that inverts one axis.
    .detection = The turn rates explain the turns of the LiDARs with a reflection, not with a rotation.

IMU-FOREIGN = IMU of another recording
    .text1 = The IMU contradicts the recording. The IMU explains only { PERCENT($explained, digits: 0) } of the turning that the LiDARs see: it is another recording, another clock, or not fixed to them.
    .meaning = The samples do not belong to this walk.
    .detection = Less than 90 % of the turning of the LiDARs is explained by any rotation of the IMU.

IMU-UNIT = Unit of the IMU
    .text1 = { WORD($fault, of: "IMU-UNIT") }
    .word-accelerometer_g = The IMU contradicts the recording. The accelerometer measures about 1 at rest: its unit seems to be g, expected m/s².
    .word-gyroscope_deg = The IMU contradicts the recording. The gyroscope measures 57 times too much: its unit seems to be °/s, not rad/s.
    .word-gyroscope_small = The IMU contradicts the recording. The gyroscope measures 57 times too little: its unit is not rad/s.
    .word-gyroscope_assumed = The angular rates of the IMU are large and taken as rad/s; its accelerations do not say whether they are. If they are in °/s, give the setting ingest.imu_gyro_unit=deg_s.
    .meaning = A driver writes other units than it should, or nothing in its samples says which.
    .detection = The ratio between measured and expected values is that of a usual mistake, within 10 %. Large rates that may be in rad/s or °/s are *check* unless LiDARs see the same turns; then they are a note.

IMU-SCALE = Scale of the IMU
    .text1-if-accelerometer = The IMU contradicts the recording. The accelerometer measures { DECIMAL($found_m_s2, digits: 2) } m/s² on average, expected { DECIMAL($gravity_m_s2, digits: 2) } m/s²: its scale is { DECIMAL($percent, digits: 1, sign: 1) } % off.
    .text2-if-gyroscope = The IMU contradicts the recording. The scale of the gyroscope is { DECIMAL($percent, digits: 1, sign: 1) } % off.
    .meaning = The unit is not calibrated.
    .detection = Over the walk the scale is off by more than 4 % (accelerometer) or 2 % (gyroscope).

IMU-LEVER-ARM = Lever arm of the IMU
    .text1 = By its forces the IMU lies { LENGTH($length_m) } ± { LENGTH($sd_m) } from where the rig file has it, mostly along { $axis } of the body.
    .text2-if-least = It may be more: the trajectory follows these forces.
    .remedy = Measure where the IMU is, and give it in the rig file (xyz_m).
    .meaning = In turns the forces are moved to a wrong place; the accelerometer contradicts the LiDARs, or bends the trajectory.
    .detection = Differences of shifts from multiframe to multiframe fit the forces only with another lever arm, by more than 10 cm and five standard deviations.

TURN-SCALE = Odometry against registered pairs
    .text1 = The odometry turns { PERCENT($size, digits: 1) } ± { PERCENT($sd, digits: 1) } { WORD($way, of: "TURN-SCALE") } than registered pairs of places do: the scale of the gyroscope or the clock of the IMU contradicts the LiDARs.
    .word-farther = farther
    .word-less = less far
    .meaning = Turns of the trajectory follow a wrong gyroscope.
    .detection = At least eight pairs some seconds apart turn otherwise by more than 0.4 % and 3.5 standard deviations.

UNSEEN-RIDE = Ride that no LiDAR sees
    .text1-if-whole = From { DECIMAL($start_s, digits: 0) } s to { DECIMAL($end_s, digits: 0) } s the IMU measures a ride of about { DECIMAL($rise_m, digits: 1) } m { $way } that no LiDAR sees: a floor that moves with the body, as in an elevator. The map puts one storey onto the other.
    .text2-if-half = At { DECIMAL($start_s, digits: 0) } s the IMU measures a change of the vertical speed by { DECIMAL($speed_m_s, digits: 1, sign: 1) } m/s that no LiDAR sees: a floor that moves with the body, as in an elevator. Heights before and after it do not belong together.
    .remedy = Map the storeys separately, or walk the stairs.
    .meaning = In the car of an elevator everything that a LiDAR sees stands still.
    .detection = The accelerometer measures a push up and a later one down, or the reverse, that the heights of the trajectory do not have. *Do not use* from 1 m on.

HEIGHT-CONTRADICTED = Heights contradicted
    .text1-if-stated = From { DECIMAL($start_s, digits: 0) } s to { DECIMAL($end_s, digits: 0) } s the accelerometer contradicts the heights of the trajectory by up to { DECIMAL($largest_m_s2, digits: 2) } m/s² (usual: { DECIMAL($usual_m_s2, digits: 2) }), { DECIMAL($rise_m, digits: 1) } m in all: the floor moved with the body, as in an elevator, or the trajectory is wrong there.
    .text2-if-unstated = From { DECIMAL($start_s, digits: 0) } s to { DECIMAL($end_s, digits: 0) } s the accelerometer contradicts the heights of the trajectory by { DECIMAL($rise_m, digits: 1) } m: the floor moved with the body, as in an elevator, or the trajectory is wrong there.
    .meaning = The trajectory is wrong, or a floor moves with the body.
    .detection = The difference of vertical accelerations stays above 0.1 m/s² for 2 s without the pattern of a ride, or exceeds 0.2 m/s² and five times the usual one once. *Do not use* from 1 m on.

## Rig

RIG-AGREES = Rig file agrees
    .text1 = { $earlier }.
    .text2 = Rig: { WORD($rig) }.
    .text3-if-names = It is about: { $names }.
    .text4-if-unknown = { $unknown } of { $parameters } parameters are not observable.
    .text5-if-gnss = GNSS: { WORD($gnss) }.
    .text6-if-gnss_names = It is about: { $gnss_names }.
    .meaning = Windows of the walk were compared with the rig file.
    .detection = At least one parameter is observable, and none is off.

RIG-NOT-COMPARED = Rig file not compared
    .text1 = { $earlier }.
    .text2 = Rig: { WORD($rig) }.
    .text3-if-names = It is about: { $names }.
    .text4-if-unknown = { $unknown } of { $parameters } parameters are not observable.
    .text5-if-gnss = GNSS: { WORD($gnss) }.
    .text6-if-gnss_names = It is about: { $gnss_names }.
    .meaning = The recording shows nothing of the rig, or was not compared with it.
    .detection = No parameter of the rig is observable in this walk.

RIG-OLD = Calibration is old
    .text1 = The rig was calibrated on { $date }, { $age_days } days before the walk; after { $max_age_days } days (rig.max_age_days) it should be done again.
    .remedy = Calibrate the rig (recon4 calibrate).
    .meaning = Mounts move with time.
    .detection = The date in the rig file is older than rig.max_age_days.

RIG-CONTRADICTED = Rig file contradicted
    .text1 = The rig file contradicts the recording: the { WORD($what) } differs from it.
    .text2 = Its rotation differs by { DEGREES($rotation_rad, digits: 2) } ± { DEGREES($rotation_sd_rad, digits: 2) }, mostly about { $rotation_axis }.
    .text3 = Its position differs by { DECIMAL($position_cm, digits: 2) } cm ± { DECIMAL($position_sd_cm, digits: 2) } cm, mostly along { $position_axis }.
    .text4 = Its clock differs by { DECIMAL($clock_ms, digits: 1) } ms ± { DECIMAL($clock_sd_ms, digits: 1) } ms.
    .text5 = The range of { $range_beams } beams differs by up to { DECIMAL($range_mm, digits: 1) } mm.
    .text6 = The elevation of { $elevation_beams } beams differs by up to { DEGREES($elevation_rad, digits: 3) }.
    .text7 = The azimuth of { $azimuth_beams } beams differs by up to { DEGREES($azimuth_rad, digits: 3) }.
    .text8-if-applied = The calibrated rig is used for this map.
    .text9-if-not_applied = Calibrate the rig (recon4 calibrate).
    .meaning = A sensor is not where, or when, the rig file says: walls are double, or the motion is wrong.
    .detection = The joint estimate of all windows differs by more than its noise and 0.1°, 1 cm, 1 ms. *Do not use* from 0.5°, 3 cm, 10 ms on. A note if the calibrated rig is used, for axes (below 0.7°) and clock (below 4 ms) of an IMU, which the odometry corrects, and for clocks if the times of the points are derived.

RIG-CHANGES = Rig changes during the walk
    .text1 = The rig does not stay the same during the walk. Parts of the walk disagree by { DECIMAL($factor, digits: 0) } times what noise explains, most in the { $quantity } { $axis } of the { WORD($what) } against the other sensors (they scatter by { $scatter }). A mount has slipped, or a clock has jumped: walls are doubled, and no calibration corrects that.
    .remedy = Fix it and record again.
    .meaning = A mount is loose, or a clock jumps.
    .detection = The windows of the walk contradict each other beyond their noise.

RIG-EXCHANGED = Mounts exchanged
    .text1 = The mounts of { $first } and { $second } seem to be exchanged in the rig file.
    .remedy = Exchange them in the rig file.
    .meaning = Two LiDARs have each other's pose.
    .detection = The estimated mount of one is that of the other within 0.1 rad and 10 cm.

ANTENNA-VAGUE = Lever arm roughly known
    .text1 = The walk shows the lever arm of the GNSS antenna only roughly along { $axes }: measure it there, or bend forward and to the sides while you walk.
    .meaning = The calibrated lever arm has an uncertainty that the map inherits.
    .detection = Its standard deviation along an axis is above 1 cm.

ANTENNA-OFFSET = Lever arm contradicted
    .text1 = The rig file contradicts the GNSS fixes: the antenna differs from it by x { DECIMAL($x_cm, digits: 0, sign: 1) } cm ± { DECIMAL($x_sd_cm, digits: 0) } cm, y { DECIMAL($y_cm, digits: 0, sign: 1) } cm ± { DECIMAL($y_sd_cm, digits: 0) } cm, z { DECIMAL($z_cm, digits: 0, sign: 1) } cm ± { DECIMAL($z_sd_cm, digits: 0) } cm in axes of the body.
    .remedy = Measure the lever arm, or calibrate the rig (recon4 calibrate).
    .meaning = The map is shifted and bent by the error of the lever arm.
    .detection = Residuals of the fixes follow the attitude of the body, with five standard deviations.

ANTENNA-UNCHECKED = Lever arm not checked
    .text1 = The lever arm of the GNSS antenna could not be checked (± { DECIMAL($sd_cm, digits: 0) } cm): the walk has too few turns. An error of the rig file moves the map by as much.
    .meaning = A wrong lever arm would not show in this walk.
    .detection = The horizontal standard deviation of the estimated lever arm is large.

## Loops and the pose graph

LOOPS-ACCEPTED = Loop closures accepted
    .text1 = { $accepted } loop closures accepted.
    .meaning = They correct the drift of the odometry.
    .detection = Edges between visits of one place that verification accepted.

LOOPS-NONE = No loop closure
    .text1 = No loop closure was accepted: the drift of the odometry is not corrected.
    .text2 = The shape of the map is known to ± { LENGTH($shape_m) } (2σ).
    .remedy = Walk through places twice, and end where the walk began.
    .meaning = Nothing but the odometry holds the map. What that costs stands in the uncertainty of the positions.
    .detection = No edge between two visits of one place was accepted. A note if the uncertainty of the positions is stated, else *check*. Not of a profiler without a 2-D laser that stands by its IMU.

LOOPS-UNVERIFIED = Loop closures unverified
    .text1 = { $unverified } loop closures are unverified: they have no alternative path; { $accepted } are accepted.
    .remedy = Decide them in the review.
    .meaning = They are not in the map. Decided in the review they may hold it better.
    .detection = More loop closures are unverified than accepted. A note if the shape of the map is known well without them.

LOOP-RESIDUAL = Residual of loop closures
    .text1 = 5 % of the accepted loop closures have a residual to the map above { LENGTH($residual_m) }.
    .remedy = Look at them in the review: one of them may be wrong.
    .meaning = The map does not satisfy its own measurements.
    .detection = The 95th percentile of the residuals of accepted loop closures is above 10 cm.

LOOPS-AGAINST-GNSS = Loop closures against GNSS
    .text1 = { $count ->
        [one] Rejected automatically: a verified loop closure contradicts the GNSS priors.
       *[other] Rejected automatically: { $count } verified loop closures contradict the GNSS priors.
    }
    .meaning = Places look alike, or GNSS is wrong there.
    .detection = The robust solve with GNSS priors rejects them.

PLACE-AMBIGUOUS = Place looks like another
    .text1 = What was seen from { DECIMAL($start_s, digits: 0) } s to { DECIMAL($end_s, digits: 0) } s looks like the place at { DECIMAL($like_s, digits: 0) } s, but the trajectory puts it elsewhere or another place looks the same: { $pairs } loop closures are ambiguous and wait in the review.
    .remedy = Decide them in the review.
    .meaning = Either a loop is missing, or two rooms look the same.
    .detection = Pairs fit at a pose that drift alone does not explain, or at two poses.

CHAIN-BROKEN = Odometry edges rejected
    .text1 = { $edges ->
        [one] One odometry edge was rejected: the trajectory may be discontinuous there.
       *[other] { $edges } odometry edges were rejected: the trajectory may be discontinuous there.
    }
    .meaning = The chain of multiframes contradicts the rest of the graph.
    .detection = Edges between successive nodes are not in the solved graph.

CORRECTION = Correction by the graph
    .text1 = The pose graph moved the last pose by { LENGTH($end_m) } and no pose by more than { LENGTH($largest_m) }.
    .meaning = As much as loop closures and GNSS correct the drift of the odometry.
    .detection = Odometry and final trajectory, aligned at the first pose.

REVIEW-CONFLICT = Decision conflicts with the graph
    .text1 = { $count ->
        [one] An accepted loop closure does not fit the graph
       *[other] { $count } accepted loop closures do not fit the graph
    }: { $pairs }.
    .remedy = Look at them again in the review.
    .meaning = A person accepted what the other edges contradict.
    .detection = Their residual after the solve is beyond the limit of verification.

REVIEW-WITHOUT-EFFECT = Decision without effect
    .text1 = { $count ->
        [one] A decision is about a pair that is no longer in the graph
       *[other] { $count } decisions are about pairs that are no longer in the graph
    }: { $pairs }.
    .meaning = The map was made again, and these pairs were not registered.
    .detection = The pair of a decision is not among the edges.

REVIEW-OUTDATED = Decision about an earlier measurement
    .text1 = { $count ->
        [one] A decision is about a pair whose measurement has changed
       *[other] { $count } decisions are about pairs whose measurement has changed
    }: { $pairs }.
    .remedy = Look at them again in the review.
    .meaning = The reviewer saw another registration of this pair.
    .detection = The pose of the edge differs from the one in the decision.

REVIEW-HELD = Decisions do not move the map
    .text1 = With the decisions about loop closures the map would move by { LENGTH($moved_m) } at most; it stays where it was.
    .meaning = A move of at most 4 mm and 0.4 mrad is less than the refinement follows. The verdicts of the graph are the decided ones.
    .detection = The poses of the map without decisions, compared with those of the map with them.

## Leveling and GNSS

NOT-LEVELED = Not leveled
    .text1 = The map is not leveled: its heights and slopes are relative to the first sensor pose.
    .meaning = Up is not known.
    .detection = Neither INS, accelerometer nor a floor shows the vertical. A note if the recording has no IMU.

GNSS-CLOCK = Clock of the GNSS receiver
    .text1-if-small = The rig file contradicts the GNSS fixes: their clock differs by { DECIMAL($clock_ms, digits: 0) } ms ± { DECIMAL($clock_sd_ms, digits: 0) } ms.
    .text2-if-large = The rig file contradicts the GNSS fixes: their clock differs by { DECIMAL($clock_s, digits: 2) } s ± { DECIMAL($clock_sd_s, digits: 2) } s.
    .text3 = GPS time is { $leap_s } s ahead of UTC.
    .remedy = Check the time offset of the receiver, or calibrate the rig (recon4 calibrate).
    .meaning = Fixes belong to other times than the points: the map is shifted along the walk.
    .detection = Residuals of the fixes follow the velocity, with five standard deviations.

GNSS-NOT-USED = GNSS not used
    .text1 = The positions were not used, the map is local: { WORD($reason, of: "GNSS-NOT-USED") }.
    .text2 = Of { $fixes } fixes { $fixes_usable } are usable.
    .text3 = { $fixes_agreeing } of them agree, over { DECIMAL($extent_m, digits: 1) } m.
    .text4 = Fixes lie up to { DECIMAL($beside_m, digits: 1) } m beside the trajectory: either the trajectory or GNSS is wrong.
    .word-no-gnss = there is no GNSS in the recording
    .word-switched-off = GNSS is switched off (gnss.enabled)
    .word-few-fixes = too few fixes are usable
    .word-no-agreement = too few fixes agree with the trajectory
    .meaning = The map has no place on earth.
    .detection = Too few fixes agree with the trajectory.

GNSS-REJECTED = GNSS fixes rejected
    .text1 = From { DECIMAL($start_s, digits: 0) } s to { DECIMAL($end_s, digits: 0) } s after the first fix { $fixes } GNSS fixes agree with each other and lie up to { DECIMAL($horizontal_m, digits: 2) } m horizontally and { DECIMAL($height_m, digits: 2) } m in height from the trajectory. They were rejected: either the trajectory or GNSS is wrong there.
    .remedy = A control point would tell which.
    .meaning = Two sensors contradict each other.
    .detection = At least ten successive fixes over 1 s were rejected with nearly the same residual.

## The map

MIRROR = Mirror
    .text1 = A mirror or a glass wall of about { DECIMAL($area_m2, digits: 1) } m² at x { DECIMAL($x_m, digits: 1) } m, y { DECIMAL($y_m, digits: 1) } m doubles the room. What seems to lie behind it ({ PERCENT($behind, digits: 0) } of all points) is the room before it, reflected. These points have the class reflection, and deliverables leave them out.
    .remedy = If there is a room behind it, give its points another class.
    .meaning = Part of what was measured is a room that does not exist; the map leaves it out.
    .detection = Beams through a part of a wall meet, reflected in it, surfaces of the room before it. If it is smaller than 2.5 m²: they also seem to cross what stands.

CLASSES-MOVED = Correction of classes moved
    .text1 = The map has moved by { LENGTH($moved_m) } where { $who } made points { $to }, near x { DECIMAL($x_m, digits: 1) } m, y { DECIMAL($y_m, digits: 1) } m, z { DECIMAL($z_m, digits: 1) } m; the correction { $id } followed its points and changes { COUNT($points) } of them ({ COUNT($points_then) } then).
    .text2 = { $lost ->
        [one] { COUNT($lost) } of its clusters no longer lies together: it keeps its former class.
       *[other] { COUNT($lost) } of its clusters no longer lie together: they keep their former class.
     }
    .remedy = Look at the place; withdraw the correction if other points were meant.
    .meaning = Another trajectory put the corrected points elsewhere. The volume moved with them.
    .detection = The poses that measured the points have moved together, by more than 5 cm.

CLASSES-NOT-CORRECTED = Correction of classes without effect
    .text1 = Points that { $who } made { $to }, near x { DECIMAL($x_m, digits: 1) } m, y { DECIMAL($y_m, digits: 1) } m, z { DECIMAL($z_m, digits: 1) } m, have their former class: the correction { $id } changes nothing.
    .text2-if-bent = They have moved by { LENGTH($apart_m) } against each other since.
    .text3-if-gone = This walk no longer has the times at which they were measured.
    .text4-if-empty = No point in its volume has a class that it corrects ({ COUNT($points_then) } had one).
    .remedy = Make the correction again in this map, or withdraw it.
    .meaning = The map was made again and differs from the one that a person looked at. A correction is not applied where its points no longer are.
    .detection = The poses that measured the points have moved by more than 10 cm against each other, are missing, or no point is left to change.

## Line scans

LASER-MISSING = No 2-D laser
    .text1-if-drifts = no 2-D laser: the first trajectory is from the IMU alone and drifts by meters
    .text2-if-rests = no 2-D laser: the IMU feels no motion for { DECIMAL($rest_s, digits: 1) } s, and none is assumed there
    .meaning = The refinement has to correct meters, except where the IMU feels no motion.
    .detection = The recording has no scans of a 2-D laser. A note if the IMU feels no motion for 95 % of the time: samples within a second differ by less than 0.02 rad/s and 0.06 m/s².

LASER-ELSEWHEN = 2-D laser at other times
    .text1 = the scans of the 2-D laser cover { DECIMAL($first_s, digits: 1) } … { DECIMAL($last_s, digits: 1) } s of a walk of { DECIMAL($walk_s, digits: 1) } s: are the clocks the same? Without them the first trajectory is from the IMU alone and drifts by meters
    .meaning = The scans cannot be used.
    .detection = Too few scans lie within the times of the lines.

LASER-SILENT = 2-D laser silent
    .text1 = the 2-D laser is silent for { DECIMAL($seconds, digits: 1) } s, first { DECIMAL($first_s, digits: 1) } s after the start
    .meaning = The IMU bridges these times.
    .detection = No scan for longer than a second.

LASER-MIRRORED = 2-D laser upside down
    .text1 = the 2-D laser turns against the gyroscope: its scans were turned over; it is mounted upside down, or its angles have the wrong sign
    .meaning = The scans were corrected.
    .detection = The turns of the 2-D SLAM have the sign opposite to those of the gyroscope.

LASER-CLOCK = Clock of the IMU against the 2-D laser
    .text1 = the clock of the IMU is { DECIMAL($ahead_ms, digits: 0) } ms { WORD($way, of: "LASER-CLOCK") } that of the 2-D laser. In the rig file add { EXACT($imu_s, digits: 3, sign: 1) } to time_offset_s of the IMU, or { EXACT($laser_s, digits: 3, sign: 1) } to that of the 2-D laser, whichever does not run with the profiler
    .word-ahead = ahead of
    .word-behind = behind
    .meaning = Lines are placed by a motion of another time.
    .detection = Turn rates of both correlate best with an offset.

LASER-BRIDGED = 2-D tracking missing
    .text1 = 2-D tracking is missing for { DECIMAL($seconds, digits: 1) } s: only the IMU bridges that time
    .meaning = The first trajectory drifts there.
    .detection = Multiframes farther from a tracked scan than what bridges it can.

LINES-WITHOUT-IMU = No IMU
    .text1 = { WORD($cause, of: "LINES-WITHOUT-IMU") }: steps and tilts between two scans of the 2-D laser are not known
    .word-none = no IMU
    .word-uncovered = the IMU's samples do not cover the walk
    .meaning = The head of the profiler is placed by the 2-D laser alone.
    .detection = There are no samples, or they do not cover the walk.

PROFILER-CLOCK = Clock of the profiler
    .text1 = the clock of the profiler is { DECIMAL($ahead_ms, digits: 0) } ms { WORD($way, of: "PROFILER-CLOCK") } those of the IMU and the 2-D laser: in the rig file add { EXACT($add_s, digits: 3, sign: 1) } to its time_offset_s
    .word-ahead = ahead of
    .word-behind = behind
    .meaning = Walls are bent where the body turns.
    .detection = The map is sharpest with an offset of the times of the lines.

PROFILER-MOUNT = Mount of the profiler
    .text1 = the map is sharper with the profiler mounted otherwise than the rig file says: { $change } of the body, against the 2-D laser
    .remedy = Calibrate with the command recon4 calibrate --method entropy.
    .meaning = Walls are double, once for each side of the head.
    .detection = Another rotation of the profiler sharpens the map clearly.

## 2-D maps

SCANS-TRACKED = Tracking never lost
    .text1 = Tracking was not lost for longer than a moment in any of { $scans } scans.
    .meaning = Each scan was matched to the local map.
    .detection = No loss lasts longer than 0.5 s.

SCANS-LOST = Tracking lost
    .text1 = Tracking was lost in { $lost } of { $scans } scans, for up to { DECIMAL($longest_s, digits: 1) } s.
    .meaning = The map is joined by the prediction there.
    .detection = For more than 0.5 s no scan could be matched. *Do not use* above 2 % of the scans without odometry.

SCANS-SILENT = Laser silent
    .text1 = { $count ->
        [one] The laser is silent once, for { DECIMAL($longest_s, digits: 1) } s.
       *[other] The laser is silent { $count } times, for up to { DECIMAL($longest_s, digits: 1) } s.
    }
    .text2 = The longest silence begins { DECIMAL($since_s, digits: 1) } s after the start.
    .text3 = { WORD($by, of: "SCANS-SILENT") }.
    .word-odometry = The odometry says how it moved meanwhile
    .word-motion = There is no odometry: how it moved meanwhile is unknown
    .meaning = Two parts of the map are joined by the odometry of the recording, or by the prediction.
    .detection = No scan for more than 1 s. A note if the recording has odometry.

SCANS-SEARCHED = Pose found by a search
    .text1 = At { $searched } scans the laser had moved so far that its pose was found by a search.
    .meaning = Places that look alike may be confused.
    .detection = A correlative search found the pose of more than 0.5 % of the scans.

SUBMAP-RESTARTED = Local map started again
    .text1 = The local map started again { $resets ->
        [one] once
       *[other] { $resets } times
     }: the parts of the map are joined by { WORD($by, of: "SUBMAP-RESTARTED") } and by loop closures only.
    .word-odometry = the odometry of the recording
    .word-motion = the motion before
    .meaning = How the parts lie to each other is hardly measured.
    .detection = No scan fitted the local map. *Do not use* without odometry.

CORRIDOR = Direction hardly observed
    .text1 = From { DECIMAL($start_s, digits: 0) } to { DECIMAL($end_s, digits: 0) } s the laser hardly observes one direction, as in a corridor without doors: there the length of the map comes from { WORD($by, of: "CORRIDOR") }.
    .word-odometry = the odometry
    .word-motion = the motion before
    .meaning = The length of the corridor is not measured.
    .detection = The standard deviation of a scan is above 5 cm along a direction for at least 2 s. *Do not use* from 10 s in all on without odometry.

POSITION-UNCERTAIN = Uncertain positions
    .text1 = Positions are uncertain by up to { DECIMAL($sd_m, digits: 1) } m (one standard deviation).
    .meaning = Stated from the covariances of the graph.
    .detection = The largest standard deviation is above 0.5 m.

MAPPED-TWICE = Places mapped twice
    .text1 = { PERCENT($ratio, digits: 0) } of the beams cross walls of the map: places were mapped twice.
    .meaning = Loop closures are missing or wrong.
    .detection = More than 10 % of the beams cross occupied cells; *do not use* above 20 %.

LASER-MOUNT = Mount of the laser
    .text1 = { $text }
    .meaning = The plane of the laser is not level, or nothing says how it is mounted. The recording was read by an earlier version, which wrote sentences.
    .detection = Rig file or tf. *Do not use* from a tilt of 30° on.

BEAM-ORDER = Beams in the wrong order
    .text1 = The scans turn against the odometry: their beams are stored in the wrong order, and the scans are mirrored.
    .text2 = This contradicts the recording: { MOUNT($by_recording) } ({ $parent } -> { $child }, { $sources }).
    .text3 = This contradicts the rig file: { MOUNT($by_rig) }.
    .text4 = This contradicts what is stated: { $mount }.
    .meaning = As recorded, the map would be a mirror image. The scans were corrected.
    .detection = The turns of the scans have the sign opposite to those of the odometry. A note if nothing states the mount of the laser.

GRID-COARSE = Coarse grid
    .text1 = The map is { DECIMAL($width_m, digits: 0) } x { DECIMAL($height_m, digits: 0) } m large: its cells are { SIGNIFICANT($cell_m, digits: 6) } m, { $enlarged } times as large as requested. Is a position wrong?
    .meaning = The grid is limited to 150 million cells.
    .detection = The bounds of the map. *Do not use* with cells above 0.25 m.

PATH-UNCONFIRMED = No loop closure
    .text1 = No loop closure on a path of { DECIMAL($path_m, digits: 0) } m: nothing confirms the map.
    .remedy = Walk through places twice, and end where the walk began.
    .meaning = The drift is not corrected.
    .detection = A path longer than 60 m without an accepted loop closure.

## Against a ground truth

ERROR-RELATIVE = Relative error
    .text1 = e_r is { LENGTH($error_m) }: { WORD($side, of: "ERROR-RELATIVE") } the goal of { LENGTH($goal_m) }.
    .word-within = within
    .word-above = above
    .meaning = Relative error of the map against a ground truth.
    .detection = *Do not use* above 5 cm.

ERROR-TRAJECTORY = Trajectory error
    .text1 = The absolute trajectory error is { LENGTH($error_m) } (RMSE, SVD-aligned).
    .meaning = Positions against those of a ground truth.
    .detection = A note above 5 cm.

TRUTH-INCOMPLETE = Ground truth incomplete
    .text1 = The ground truth covers only { PERCENT($ratio, digits: 1) } of the poses.
    .meaning = The errors say nothing of the others.
    .detection = Below 95 %.

## Approval

APPROVAL-ALTERED = Approved files changed
    .text1 = the approved files were not put back, this is a draft: { $reason }
    .meaning = What was issued was changed afterwards.
    .detection = Hashes of the approved version differ.
