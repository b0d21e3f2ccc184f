### The page of a live capture, on the phone and on the laptop.

## Page

title = Live · recon4
map-keys = Map. Arrow keys move it, plus and minus zoom, question mark lists all keys.
connecting = Connecting
help-and-more = Help and more
all-values = All values of sensors, disk and batteries (V)
warnings = Warnings
all-warnings = All warnings
view = View
turn-map-back = Turn the map back
turn-map-back-key = Turn the map back (U)
tilt = 3-D
tilt-key = From above or in 3-D (T)
follow = Follow
follow-key = Follow me; off shows the whole map (F)
height = Height
height-key = Color by height instead of intensity (C)
gaps = Gaps
gaps-key = Coverage and gaps (G)
sun = Sun
sun-key = For bright sun (S)
coverage = Coverage
well = Well
poorly = Poorly
next-gap-key = Show the next place not seen (N)

## Dialogs

begin-title = New capture
rig = Rig
surroundings = Surroundings
start-recording = Start recording
note-title = Mark this place
note = Note
note-example = Crack in the wall
mark = Mark
marks-kept = { $count ->
    [one] No link: the mark is kept on this phone, and sent when there is one
   *[other] No link: { $count } marks are kept on this phone, and sent when there is one
}
marks-refused = { $count ->
    [one] A mark that this phone kept is not taken, its capture is over: { $texts }
   *[other] { $count } marks that this phone kept are not taken, their capture is over: { $texts }
}
naming-title = Name of the place
naming-example = Town hall, 2nd floor
name-it = Name it
ending-title = Stop recording?
continue = Continue
stop = Stop
sensors = Sensors
sensor = Sensor
packets = Packets
lost = Lost
clock = Clock
health-legend = Lost: of the last 10 seconds. Clock "in step": driven by GPS (PPS), or the same as the recorder's; "own, shifted": it runs freely and is corrected by the arrival times.
dance-title = Calibration dance
dance-needs = What a calibration needs, so far
dance-legend = About 60 s at a place with walls near you. x points forward, y to the left, z up. Then stop, make the map, and use "Calibrate and map again" on the project's page.
help = Help
name-the-place = Name the place…
dance-it = Calibration dance…
ceiling = Show what is above head height, as ceilings (H)
legend-well = seen well: often, and from near
legend-poor = seen poorly: go nearer, or past it again
legend-gap = not seen: a room not entered, a corner not looked into
legend-me = you; the line is your path, the ring its start
legend-height = height: floor to head; gray is the intensity
gestures = One finger moves the map, in 3-D it turns it; two fingers zoom and turn. Follow off shows the whole map.
key-tilt = 3-D
key-follow = follow me
key-color = color
key-gaps = gaps
key-next-gap = next gap
key-sun = sun
key-ceiling = ceiling
key-mark = mark
key-sensors = sensors
key-zoom = zoom
key-turn = turn
key-turn-back = turn back
key-move = move
signed-in = Signed in as { $name }, { $role }. { $points }
points-here = { COUNT($points) } points on this phone.

## Actions

one-moment = One moment…
start = Start…
pause = Pause
resume = Resume
project = Project
make-map = Make the map
new = New…
walk-name = Walk { $time }
loop-is-closed = The loop is closed.
loop-is-open = The loop is not closed yet: the map is better if you return to the start first.

## State

state-none = Nothing is recorded
state-recording = Recording
state-paused = Paused
state-finishing = Finishing
state-ready = Ready
no-link = No link
link-lost = No link for { $seconds } s, trying again.
link-lost-recording = No link for { $seconds } s, trying again. The recording continues
no-webgl = This browser cannot draw points (no WebGL 2); plan, path and warnings work
more-warnings = and { $count } more

## Sensors, disk and batteries

fix-single = single
fix-dgnss = DGNSS
fix-rtk-fixed = RTK fixed
fix-rtk-float = RTK float
fix-none = no fix
gnss = GNSS { $fix }
gnss-within-cm = GNSS { $fix } ±{ DECIMAL($cm, digits: 0) } cm
gnss-within-m = GNSS { $fix } ±{ DECIMAL($m, digits: 1) } m
clock-in-step = in step
clock-shifted = own, shifted
clock-jumped = { $jumps ->
    [one] jumped
    *[other] jumped { $jumps } times
}
clock-shifted-brief = own clock
clock-jumped-brief = clock jumped
disk-brief = disk { $left }
laptop-brief = laptop { $charge }
phone-brief = phone { $charge }
lost-brief = { $name } { $ratio } lost
silent-brief = { $name } silent
silent = silent
imu = IMU
gnss-name = GNSS
no-position-yet = { $rate }/s, no position yet
none = none
disk = Disk
disk-free = { DECIMAL($gigabytes, digits: 0) } GB free
disk-free-for = { DECIMAL($gigabytes, digits: 0) } GB free, for { $left } at this rate
recorded = Recorded
recorded-whole = { DECIMAL($megabytes, digits: 0) } MB, nothing lost
recorded-lost = { DECIMAL($megabytes, digits: 0) } MB, { $lost } packets lost
computer = Computer
on-mains = { $charge }, on mains
no-battery = no battery, or unknown
phone = Phone
charging = { $charge }, charging
battery-unknown = battery unknown
ratio = { PERCENT($ratio, digits: 1) }
hours = { $hours } h
minutes = { $minutes } min

## What to do next

hint-start = Put the backpack on, stand still, then start
hint-view = View only. Nothing is recorded yet
hint-finishing = The recording is safe; the map is being completed
hint-make = Everything is stored. Now make the map
hint-over = The walk is over; everything is stored
hint-paused = Stay here: resume where the pause began
hint-still = Stand still: the map starts in a few seconds
hint-walk = Open all rooms and walk slowly through each
hint-closed = ✓ Loop closed
hint-closed-drift = ✓ Loop closed, drift { $cm } cm
hint-at-start = At the start, loop not closed yet
hint-open = Loop open: return to the start, { $m } m

## Coverage

gaps-none = none
gaps-none-here = none here
gaps-elsewhere = , { $count } on other floors
gaps-next = { $count ->
    [one] { $count } place not seen{ $elsewhere }, show the next
   *[other] { $count } places not seen{ $elsewhere }, show the next
}
gaps-no = No gaps near your path{ $elsewhere }
gap-chosen = Not seen: { DECIMAL($width, digits: 1) } m wide, { DECIMAL($away, digits: 0) } m from your path{ $elsewhere }

## Calibration dance

dance-still = Still
dance-still-text = Stand still for { $seconds } s
dance-seconds = { $seconds } s
dance-tilt = Tilt
dance-tilt-text = Bend forward and back, then to both sides
dance-turn = Turn
dance-turn-text = Turn around once to the left and once to the right
dance-degrees = { $one }° and { $other }° of { $most }°
dance-loop = Loop
dance-loop-text = Walk a loop of { $m } m and come back
dance-loop-now = { $walked } m, { $away } m from the start
dance-rotation = rotation
dance-position = position
dance-clock = clock
dance-observed = ✓ observed
dance-all = ✓ Every axis is observed: stop now
dance-again = Bend and turn again, faster: some axes are not observed yet

## On the map

stretch-lost = tracking lost
stretch-weak = hardly observable
start-here = start
