### The page of rigs.

## Page

rigs-page = Rigs · recon4
import-open = Import…
axes-and-keys = Body axes: x forward, y left, z up. Drag or use the arrow keys to turn, + and − to zoom, 0 to reset.
numbers = Numbers
zoom-in = Zoom in
zoom-out = Zoom out
reset-view = Reset the view
shipped-brief = comes with recon4
shipped = Comes with recon4. Duplicate it to change it.
version-brief = version { $version }
version = Version { $version }
version-of = Version { $version } of { $newest }
edit = Edit
duplicate-open = Duplicate…
export-toml = Export TOML
same-numbers = The same numbers
changed-since = Changed since version { $version }
versions = Versions
used-by-projects = Projects that used it
no-use = No project of this server yet
shown = shown
show-it = Show
evidence = Evidence of the calibration
steep-pitch = With a pitch near 90°, roll and yaw turn about the same axis: at 90° only their difference counts, at −90° their sum.
described = Rig { $name }: { $sensors }
described-sensor = { $name }, { $model }, at { $place } cm, turned { $turned }°
gap = ,{" "}

## Sensors

sensor = Sensor
model = Model
position = Position
rotation = Rotation
clock = Clock
port = Port
address = Address
imu = IMU
gnss-antenna = GNSS antenna
any = any
none = none
disabled-sensor = { $name } (disabled)
kind-lidar = LiDAR
kind-profiler = Profiler
kind-laser2d = 2-D laser

## Form

add-sensor = Add a sensor
note-why = Note: what changed and why
save-version = Save as a new version
inside-of = Inside of the LiDAR
inside-of-none = none: mounted by itself
topic = Topic
lever-arm = Lever arm
serial-line = Serial line
clock-rate = Clock rate
sensor-number = Sensor { $number }
detected = detected
serial-number = Serial number
columns = Columns
known = known
used-for-map = Used for the map
kind = Kind
head-topic = Topic of the head
head-rate = Turn rate of the head
udp-port = UDP port

## Changes between versions

change-position = position { $change } cm
change-rotation = rotation about { $change }°
change-clock = clock { $change } ms
change-lever-arm = lever arm { $change } cm
change-enabled = enabled
change-disabled = disabled
change-added = added
change-removed = { $name }: removed
change-name = name: { $before } → { $after }
field-kind = kind
field-model = model
field-serial = serial
field-address = address
field-port = port
field-topic = topic
field-head-topic = head topic
field-head-rate-deg-s = head rate deg s
field-clock-rate-ppm = clock rate ppm

## Dialogs

new-rig-name = Name of the new rig
name-letters = Letters, digits, dot, dash and underscore
note = Note
duplicate-of = Duplicate { $id }
duplicate = Duplicate
import-as = Import as
a-new-rig = A new rig
a-new-version = A new version of { $id }
import-of = Import { $name }
import-beside = Describes its LiDARs: { $names }
import = Import
file-size = A file of a rig has 1 to { COUNT($most) } bytes, this one { COUNT($size) }
