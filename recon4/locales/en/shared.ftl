### What all pages have in common; each page has these texts together with its own.

## Words of many pages

cancel = Cancel
close = Close
name = Name
language = Language
save = Save
delete = Delete
delete-open = Delete…
remove = Remove
size = Size
delete-ask = Delete { $name }?
restore-it = Restore
delete-now = Delete now
copy = Copy
copied = ✓ Copied

## Bar at the top

head-where = Where you are
head-projects = Projects
all-projects = All projects
head-pages = Pages of the project
head-project = Project
head-map = Map
head-review = Review
head-slices = Slices
head-report = Report
head-live = Live
head-rigs = Rigs
head-storage = Storage
head-api = API
head-help = Help
head-people = People
head-account = Account of { $name } { $role }
head-sign-out = Sign out
head-menu = Menu
head-lost = Connection lost, trying again

## Roles

role-nobody = nobody
role-guest = guest
role-viewer = viewer
role-operator = operator
role-reviewer = reviewer
role-admin = admin

## Words of states and progress

state-queued = Waiting
state-running = Running
state-succeeded = Finished
state-failed = Failed
state-cancelled = Cancelled
state-finished = Finished
state-check = Check this map
state-unusable = Do not use this map
state-sound = No problem found in this map
state-unjudged = No verdict on this map
state-unfinished = Not finished
starting = Starting
time-left = { $time } left
time-left-about = about { $time } left
time-left-none = nearly done
run-part = { $part } % of the run
this-part = This part { $progress }
share-tiny = below { $least } %
unit-multiframe = multiframe
unit-multiframes = multiframes
unit-points = points
unit-steps = steps
unit-files = files
unit-evaluations = evaluations
unit-node = node
unit-pair = pair
unit-pairs = pairs
unit-sweep = sweep
unit-scans = scans
unit-frames = frames
unit-windows = windows
unit-tiles = tiles
unit-rounds = rounds
unit-kernels = kernels
unit-artifacts = artifacts
unit-versions = versions
unit-places = places

## Requests

lost-not-allowed = Not allowed
lost-not-found = Page not found
lost-failed = The request failed
shared-map-open = Open the shared map
no-response = The server does not answer. Is it still running?
bad-response = The server returned { $status }

## Figures of a run

figure-path = Path length
figure-points = Points in the map
figure-duration = Duration of the walk
figure-multiframes = Multiframes
figure-lost = Multiframes, tracking lost
figure-accepted = Edges accepted
figure-rejected = Edges rejected
figure-unverified = Edges unverified
figure-rig = Rig
figure-serials = Serial numbers
figure-calibrated = Rig calibrated
figure-time = Processing time
figure-memory = Peak memory
not-known = not known
calibrated-unknown = not known: the rig file does not say
calibrated-by = { $date } by { $method }
calibrated-age = , { $days } days before the walk
calibrated-age-old = , { $days } days before the walk (old)
headline-path = { $m } m path
headline-points = { COUNT($points) } points
headline-2d = 2-D map

## Verdicts and findings

level-do-not-use = Do not use
level-check = Check
level-note = Note
level-good = Confirms
place-xyz = x { $x }, y { $y }, z { $z } m
span-s = { $start } s to { $end } s
direction-vertical = the vertical direction
direction-some = a { $direction } direction
direction-horizontal = horizontal
direction-one = one direction
unobserved = { $which }, degeneracy { $degeneracy }
unobserved-where = , from { $from } to { $to }
findings = Findings
hardly-observable = Hardly observable (0 = unobservable)
notes = Notes
finding-levels = Level of findings
finding-kinds = Kind of findings
finding-all = All ({ $count })
acknowledge = Acknowledge
acknowledge-open = Acknowledge…
acknowledge-note = Note (the verdict does not change)
acknowledged = ✓ Acknowledged by { $who }, { $when }:
acknowledged-outdated = Outdated acknowledgments: this map has no such finding
finding-in-map = Show in the map: { $stretch }
finding-in-graph = In the graph
finding-in-graph-of = In the graph: { $stretch }
finding-cut = Cut here
walk-axis = Time of the walk, 0 to { $end } s, with findings: { $findings }

## Approvals

approval-signed = Approved v{ $version } · { $who } · { $day }
approval-draft = Draft: not approved
approval-written-as-draft = Draft: written without approval
approval-changed = Draft: changed since version { $version }
approval-earlier = Approved v{ $version } · { $who } · { $day }; version { $newest } is newer
approval-decided-since = Approved v{ $version } · { $who } · { $day }; changed since: later decisions are not in this map
approval-altered = Altered since the approval of version { $version }
approval-unknown-key = Signed by unknown key { $key }: not counted as approved
approval-older = Not approved: older than what this server approved
approval-not-in-journal = Not approved: an approval is missing in the journal
approval-invalid = Not approved: the approval is not valid
approval-unreadable = Not approved: the approval cannot be read
approval-checking = { $text }; its bytes are being compared with the signature
in-spite-of = , in spite of the verdict “{ $verdict }”
usability-check = check
usability-do-not-use = do not use
usability-good = good

## Files

upload-again = Trying again in { $seconds } s: { $why }
upload-unreadable = { $name } cannot be read any more; select it again
file-being-made = { $name }: the file is being made…

## Guest links

share-title = Share with a guest
share-what = Anyone who has a link sees the map, the slices and the report of this project; no other project, no jobs, no people, no notes. Nothing can be changed or downloaded.
share-no-login = This server has no login, so it has no guests.
share-links = Links ({ $open } open)
share-none = None yet
share-for = For whom
share-client = Client
share-works-for = Works for
share-days = { $days ->
    [one] { $days } day
   *[other] { $days } days
}
share-make = Make a link
share-made = The link: copy it now, it is shown this once
share-revoke-of = Revoke the link for { $whom }
share-revoke = Revoke
share-revoked = ✕ revoked { $when } by { $who }
share-works = works until { $when }
share-expired = ✕ expired { $when }
share-may-not = ✕ its maker may not share
share-made-by = by { $who }, { $when } ·{" "}
share-opened = { $opened ->
    [one] opened once { $when }
   *[other] opened { $opened } times, last { $when }
}
share-not-opened = not opened yet

## Classes of points and their corrections

class-never-classified = never classified
class-unclassified = unclassified
class-ground = ground
class-low-vegetation = low vegetation
class-medium-vegetation = medium vegetation
class-high-vegetation = high vegetation
class-building = building
class-low-noise = low noise
class-high-noise = high noise
class-moving = moving
class-carrier = carrier
class-reflection = reflection
alike-finding = Looking for all like it…
alike-things = { $count ->
    [one] { $count } thing
   *[other] { $count } things
  } alike: { COUNT($points) } points, { $class }
alike-limit = Most different: { $limit }
alike-limit-means = 0 = the same; 1 = as different as one thing looks from two sides. Compared are size, height above the ground, flatness, and how many beams see through.
alike-points = { $points ->
    [one] { COUNT($points) } point
   *[other] { COUNT($points) } points
 }
alike-where = x { $x }  y { $y }  z { $z } m
alike-difference = difference { $difference }
alike-high = { $m } m high
alike-over = { $m } m above the ground
alike-seen = { $percent } % seen through
alike-show = Show
alike-show-of = Show the thing at { $where }
alike-left-out = { $count } further ones have no room in one correction.
alike-forget = Choose something else
correct-counting = Counting…
correct-noting = Noting it…
correct-undoing = Undoing…
correct-starting = Starting…
correct-who = Reviewers correct classes.
correct-delivered = all points of the map
correct-every = all points, also those left out
correct-only = only { $class }
correct-new = New class
correct-of = Of
correct-why = Why
correct-count = Count the points
correct-apply = Apply
correct-nothing = Nothing to change: { $why }.
correct-counted = { $points ->
    [one] { COUNT($points) } point
   *[other] { COUNT($points) } points
 }, now: { $now }
correct-waiting = { $count } not in the map yet
correct-withdrawn = { $count } still in the map, but undone or no longer first
correct-row = { $points ->
    [one] { COUNT($points) } point
   *[other] { COUNT($points) } points
 } → { $class }
correct-not-yet = not in the map yet
correct-undo-of = Undo the correction to { $class } by { $who }, { $when }
correct-undo = Undo
correct-remade = The map is made again:
correct-progress = its progress
correct-remake = Make the map again

## Frames of maps

frame-local = map frame (local), x y z, z up, meters
frame-placed = map frame (origin at E { $east } N { $north } H { $up } in { $crs }), x y z, z up, meters

## Presets

preset-indoor = Rooms, corridors, staircases, halls
preset-outdoor = Streets, squares, fields: voxels of 3 cm, ranges up to 100 m
preset-hector = A 2-D laser, matched as hector_slam does; no loop closures
preset-wuerzburg = A backpack with a profiler, by the methods of its publication
preset-thesis = The algorithm of the 4RECON thesis as published

## Sign in, or password again

sign-in = Sign in
session-ended = Your session has ended. Sign in to go on where you were.
password = Password
password-again = Your password again
password-why = This is signed with your name, and you signed in a while ago
confirm = Confirm

## A map that is made, or made again

map-was-remade = The map was made again.
show-new = Show the new map
being-made = A job is making this map. It appears here once it is made.
being-remade = This map is being made again. You see the one before.
