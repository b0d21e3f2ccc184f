### Problems that the server answers with: each has a code, which is stable, and values.

## Disk and server

done-not-logged = { $action }: done, but the disk is full and the audit log does not have it; tell an admin, and make room before anything else
disk-full = the disk is full: make room and try again
disk-full-entirely = the disk is full, also the space kept for the audit log: nothing can be changed until there is room; remove other files from the disk of { $folder }
server-stopping = the server is stopping
too-slow = stopped after { $seconds } s; request less at a time
helper-bad-result = the result of the helper process is not of the declared type: { $detail }
helper-bad-error = the error of the helper process is malformed
result-too-large = expected a result of at most { $limit } bytes, got { $size }: request less at a time
helper-no-file = the helper process did not write { $file }
helper-no-regular-file = { $file }: expected a file, got a link or a device
out-of-memory = out of memory: request less at a time
documentation-missing = the documentation was not built: run `make site`, then start again
documentation-page-unknown = the documentation has no page { QUOTED($page) }
too-many-started = { $name } may start { $count } { WORDS($what, of: "started") } within { $minutes } minutes; wait a while
client-left = the client disconnected before the answer was ready
viewer-ends = the viewer of { $project } ends as soon as it starts
recording-unknown = no uploaded recording { QUOTED($name) }
recording-in-use = a job of { $project } reads this recording; cancel it first
metrics-not-allowed = { $name } is a { $role } here and may not read metrics; ask an admin
metrics-sign-in = sign in as an admin, or send the token of: recon4 users metrics-token

## Accounts, login, pairing, guests

guest-link-unknown = no guest link { QUOTED($link) } of { $project }
attempts-too-many = too many attempts; wait a moment
guest-links-too-many = a project has at most { $limit } guest links; revoke one first
guest-link-expired = this link expired on { $day }; ask who gave it to you for another one
guest-link-invalid = there is no such link, or not any more; ask who gave it to you
guest-link-revoked = this link was revoked on { $day }; ask who gave it to you for another one
guest-signed-in-already = this browser is signed in already: sign out to see what a guest sees
guests-need-login = this server has no login, so it has no guests: start it with the command recon4 serve ROOT --lan
role-not-assignable = the role { $role } cannot be assigned; disable the person instead
account-unknown = no account is named { QUOTED($name) }
account-name-invalid = a name has 1 to 64 letters, digits, spaces and . ' @ + - _; it begins with a letter or digit, and ends with one of them or . _
account-name-reserved = the name { QUOTED($name) } is reserved: choose another one
account-exists = an account named { $name } exists already
last-admin = { $name } is the last admin; make another person admin first
logins-at-once = too many people sign in at once; try again
logins-failed = too many failed logins; wait a while
login-wrong = wrong name or password
setup-attempts = too many attempts; wait a while
setup-link-used = this link was used, or is of another start of the server
password-length = the password needs { $shortest } to { $longest } characters, got { $length }; use three or four unrelated words, or let a password manager make one
password-weak = the password is found in about { COUNT($attempts) } attempts, it needs { COUNT($needed) }: it is mostly { WORDS($weak, of: "weakness") }. Add two or three unrelated words; digits or signs at the end, repeating and reversing help little
no-login = this server has no login: the person at this computer is { $name }
session-unknown = no session { QUOTED($session) }
other-site = requests from other sites are not accepted
other-host = this server does not answer to that host name
sign-in-page = sign in first
sign-in-first = sign in first: POST /api/login
requests-too-many = too many requests at a time
phone-code-unknown = no phone shows that code now; they are good for five minutes
phone-role = { $name } is a { $own } here and may not pair a phone as { $role }
pairing-code-used = this code was used already or is too old; make a new one
phone-name-long = the name of a phone has at most { $limit } characters
invitations-too-many = too many invitations are open
phones-too-many = too many phones wait to be paired
phone-not-approved = this phone was not approved within five minutes; request pairing again
phones-need-lan = this server listens on this computer only: phones need one that was started with the command recon4 serve ROOT --lan
signed-in-already = this browser is signed in already
phone-may-not = a paired phone may not do that; sign in with your password
token-may-not = a program may not do that; sign in with your password
token-role = { $name } is a { $own } here and may not give a program the role { $role }
tokens-too-many = a person has at most { $limit } access tokens; end one first
token-needed = an assistant needs an access token: a person makes one on the page Account
assistant-missing = this server has no tools for assistants; who installed it runs: pip install "recon4[mcp]"
password-needed-again = give your password again: this is signed with your name
not-allowed = { $name } is a { $role } here and may not { $what }; ask an admin
guest-one-project = a guest link shows the map, the slices and the report of one project, nothing else
root-read-only = the folder of the projects cannot be written: nothing can change

## Projects and recordings

name-taken = there is a project or folder { $name } already; choose another name
path-no-utf8 = { QUOTED($path) } cannot be used: rename it: its name is no UTF-8 text
path-not-allowed = recordings may only lie in { $folders }: move it there or upload it; who starts the server may name more folders in the environment variable RECON4_RECORDINGS
path-hidden = { QUOTED($path) } is hidden, or belongs to the server or the system: move what you need into a folder of recordings
path-unknown = no such file or folder: { QUOTED($path) }
path-special = { QUOTED($path) } is neither a file nor a folder
folder-unreadable = { QUOTED($folder) } cannot be listed: { $reason }
project-has-job = a job of { $project } waits or runs; cancel it first
project-unknown = no project { QUOTED($name) }
project-exists = there is a project or folder { $name } already: choose another name, or run the project again from its own page
name-of-server = { $name } is a folder of the server: choose another name
project-file-unknown = project { $project } has no file { QUOTED($file) }
project-no-map = project { $project } has no map yet
project-name-invalid = not a valid project name: { QUOTED($name) }
project-planar-map = project { $project } has a 2-D map: it has no points in space
project-busy = not now: { $detail }
thumbnail-missing = there is no thumbnail of this map: { $detail }
removed-for-good = it was removed permanently
restore-taken = another { $kind } { $name } exists now; delete or rename it first

## Jobs, exports, comparisons

comparison-no-map = name the map to compare with
targets-gone = what this search found was removed, or is not there yet: search again
comparison-gone = this comparison was removed, or is not made yet: order it again
export-not-ordered = { $file } with these options was not made of this map yet: order it with POST /api/projects/{ $project }/exports
export-being-made = { $file } is being made: ask again when it is finished
export-gone = this file was removed, or is not made yet: order it again
export-not-over = this export is not over: cancel it first
export-no-room = this export needs about { SIZE($needed_bytes) } while it is made, { SIZE($free_bytes) } are free
job-transition = job { $job } is { $state } and cannot become { $next }
order-unknown = project { $project } has no job { QUOTED($job) } of this kind
order-not-resumed = an export or a comparison is not resumed: order it again
job-no-log = this job has no log yet
jobs-too-many = { $waiting } jobs wait already; try again when some are done, or cancel some
job-unknown = no job { $job }
project-has-job-already = project { $project } already has a job that waits or runs; cancel it first
job-changed = job { $job } is no longer { $state }
job-over = job { $job } is { $state } already
job-no-space = no space: this job needs about { SIZE($needed_bytes) } ({ $times } x { SIZE($given_bytes) } of recording, and some to spare), { SIZE($free_bytes) } are free; make room, then start again

## Live capture

capture-ended = the recording has ended
capture-none = nothing is being captured
capture-running = { $project } is being captured: stop it first
capture-still-running = the capture is still running: stop it first
capture-ended-itself = The recording ended by itself: { NAMED($why, of: "word-stopped") }
capture-recorder-died = the recorder died; its recording until then is safe
capture-map-stopped = the map stopped growing (its process died)
capture-recording-goes-on = the recording continues

## Map, notes, slices

photo-unreadable = expected a JPEG or PNG photo: { $detail }
photo-too-large = the photo has { $width } x { $height } pixels; expected at most { $limit } million
photo-not-base64 = the photo must be sent as base64
photo-missing = this note has no photo
note-file-changed = { $file } was changed by another program
note-changed = { $name } changed this note meanwhile: look at it again
entry-gone = there is no { $what } { QUOTED($id) } any more
photos-too-many = a project has at most { $limit } photos of notes
entries-too-many = a project has at most { $limit } { $what }s; remove one first
entry-of-other = { $name } made this { $what }: only they or a reviewer remove it
map-lacks-value = the map does not state the { $stored } of its points
map-lacks-points = the map has no points { $start } to { $stop } in a tile { $tile }
ray-invalid = expected the direction of a ray, got { $direction }
chunks-too-many = expected at most { $limit } parts, got { $got }
chunk-invalid = expected 1 to { $limit } points, got { $got }
map-remade-measure = the map was made again meanwhile: reload the page to measure in it
map-layout = expected layout { $version } of points, got { $got }: reload the page
align-no-surface = alignment: map or reference has no flat surface to align
align-bad-pose = alignment: expected a pose with a unit quaternion
slice-export-no-room = an export needs { SIZE($needed_bytes) } free on the disk, there are { SIZE($free_bytes) }
control-point-unknown = no point { QUOTED($name) }
file-not-base64 = the file must be sent as base64
export-malformed = what to export is not understood: { $detail }
compare-malformed = what to compare is not understood: { $detail }
control-needs-stages = control points need the results of { $stages }, which this project lacks: process its recording again
control-none-measured = no control point was measured in this map
map-empty = the map has no points
color-scale = color scale: expected low < high, got { $low } and { $high }
map-unknown = no map { QUOTED($map) }
reference-unknown = no reference { QUOTED($reference) } in project { $project }
references-too-many = a project has at most { $limit } references; remove one first
control-points-changed = the control points were changed by another user; read them again
slice-superseded = a newer image was requested
map-gone = project { $project } has no map { $map } any more

## Review

findings-differ = the map was made again, and its findings differ: look at them again
correction-refused = no class is corrected: { $detail }
class-no-points = there is no point in it
class-no-points-near = there is no point in it: the map ends { DECIMAL($away_m, digits: 1) } m away
class-already = all points in it are { NAMED($title, of: "class") } already
class-not-corrected = no point in it has a class that is corrected; it has { COUNTED($there, of: "class") }
like-nothing-there = there is no point to correct within 30 cm of it
like-too-large = this thing has { COUNT($points) } points and is too large: choose its points with the brush, a box or a polygon
like-too-many-cells = this class is all over the map: choose its points with the brush, a box or a polygon
map-remade-classes = the map was made again meanwhile: reload the page to correct its classes
approve-while-running = a job of this project is queued or running; approve when it is done
alignment-forgotten = this alignment is not known any more; align the pair again
assignee-may-not-review = { $name } is nobody who may review here

## Rigs

rig-not-calibrated = project { $project } has no calibrated rig
rig-file-too-large = the rig file: expected at most { $limit } bytes, got { $size }
rig-files-unused = { $names }: describes none of the LiDARs of the rig; of several LiDARs of one maker, a file belongs to the one whose name it begins with
rig-one-of-three = give exactly one of content, toml and copy_of
rig-one-of-two = give exactly one of content and toml
rig-unknown = no rig { QUOTED($name) }
rig-version-unknown = rig { $rig } has no version { $version }
rig-shipped = { $rig } is a rig of recon4: choose another name
rigs-folder-taken = { $folder } is a project: rename its folder to store rigs
rig-exists = there is a rig { $rig } already: choose another name
rigs-too-many = there are { $limit } rigs already
rig-changed = rig { $rig } has version { $newest } by now, you changed version { $seen }: load it again
rig-versions-too-many = rig { $rig } has { $limit } versions: start a new rig

## Uploads

upload-name-invalid = expected the name of a file in at most { $limit } folders, got { QUOTED($name) }
upload-length = expected { $expected } bytes, got { $got }
upload-checksum = the checksum differs: the bytes were damaged; send them again
upload-disk-full = the disk is full; make room, then resume the upload
upload-no-name = Upload-Metadata must name the file: relativePath or filename
upload-locked = another request writes to this file; send HEAD and try again
upload-offset = expected Upload-Offset { $expected }, got { $got }
upload-sender-left = the sender disconnected; HEAD returns the offset
upload-file-unknown = no file { QUOTED($number) } in upload { $upload }
upload-too-large = { SIZE($size_bytes) } are more than this server accepts in one upload ({ SIZE($limit_bytes) })
uploads-too-many = { $count } uploads are unfinished already; finish or remove one first
upload-no-room = the disk has room for { SIZE($room_bytes) }, this recording has { SIZE($size_bytes) }; make room first
upload-not-announced = { QUOTED($name) } with { $length } bytes was not announced: this upload has { $files } files of { $bytes } bytes in all
upload-unknown = no upload { QUOTED($upload) }; it may have been removed: send it again
upload-file-and-folder = a file and a folder are both called { QUOTED($name) }
tus-version = expected the header Tus-Resumable: { $version }
tus-type = expected the header Content-Type: { $type }
tus-number = expected the header { $header } with a number of bytes, got { QUOTED($got) }
tus-metadata-long = Upload-Metadata has more than { $limit } letters
tus-algorithm = Upload-Checksum may be { $known }, got { QUOTED($got) }
tus-checksum-malformed = Upload-Checksum is not base64
tus-metadata-malformed = Upload-Metadata: { QUOTED($name) } is not base64 of UTF-8

## Webhooks

webhook-url-malformed = url: expected https://HOST/PATH in ASCII
webhook-url-parts = url: a name, a password or a fragment cannot be part of it
webhook-url-long = url: expected at most { $limit } characters
webhook-url = url: { $detail }
webhook-host-unknown = url: { $host } is not known: no answer to its name
webhook-secret = secret: expected { $prefix } and { $least } to { $most } bytes in base64; leave it out, and the server makes one
webhook-no-event = events: expected at least one
webhook-unknown = no webhook { QUOTED($webhook) }
webhooks-too-many = there are { $limit } webhooks already: remove one
host-unknown = { $host } is not known: { $reason }
host-needs-https = { $host } is in the internet: https is required
host-not-public = { $host } ({ $addresses }) is not in the internet: the person who runs the server may allow its network with RECON4_WEBHOOK_NETWORKS
host-no-answer = no answer within { $seconds } s
host-unreachable = not reachable: { $reason }
host-ended = the connection ended before a response
host-refused = the receiver answered { $status }
host-moved = the receiver answered { $status }; redirects are not followed, change the address

## The server as a whole

message = { $detail }
kind-configuration = { $detail }
kind-recording = { $detail }
kind-unknown-format = { $detail }
kind-empty-recording = { $detail }
kind-corrupt-file = { $detail }
kind-out-of-range = { $detail }
kind-map-too-large = { $detail }
kind-calibration = { $detail }
kind-graph = { $detail }
kind-georeference = { $detail }
kind-store = { $detail }
kind-no-space = { $detail }
internal-error = internal error { $number }: the server log has the cause under this number
address-unknown = there is no such address on this server
method-not-allowed = this address does not take that method
disk-is-full = the disk is full; make room and try again
token-stale = the header { $header } must carry the token of /api/me
own-waiting = { $limit } requests of { $name } of kind { $lane } wait already; try again when some are done
all-waiting = { $limit } requests of kind { $lane } wait already; try again when some are done
streams-full = { $open } { $what } are open, the limit is { $limit }: close one, try again
own-streams-full = you have { $limit } { $what } open: close one and try again
address-streams-full = your address has { $limit } { $what } open: close one, try again
viewer-does-not-start = the viewer of { $project } does not start; its log is in { $log }
helper-silent = the helper process does not respond; try again
helper-killed = the helper process died (killed by { $signal }: out of memory, or a damaged file); try again
helper-exited = the helper process died (exit code { $status }: out of memory, or a damaged file); try again
order-of-other = { $name } ordered it: ask them, or an admin
order-of-another = another person ordered it: ask them, or an admin
project-or-title = a project needs a name: give project or title
capture-needs-name = a capture needs a name: give project or place
notice-read-only = The folder of the projects cannot be written: it is shown as it is. Jobs, uploads, reviews, rigs and live captures need a copy of it.
notice-disk = The disk is nearly full: { SIZE($free_bytes) } of { SIZE($disk_bytes) } are free. Delete projects or uploads that are not needed: the page Storage lists them.
notice-unlisted = Not listed: { $names } ({ $count } in all). The folder name of a project has up to 64 letters A-Z, digits, '.', '_' and '-': rename the folder.
notice-upload = Upload { $upload } cannot be resumed, its files are damaged ({ $damage }). Send the recording again. What was received is kept for a while in { $folder }.
notice-jobs-restored = The list of jobs was damaged ({ $damage }){ $kept ->
    [0] {""}
   *[other] ; it is kept as { $aside }
    }. The backup of { $day } replaces it: jobs started later are no longer listed. Projects and recordings are unchanged; start such a job again and it continues after its last finished stage.
notice-jobs-empty = The list of jobs was damaged ({ $damage }){ $kept ->
    [0] {""}
   *[other] ; it is kept as { $aside }
    }. There is no intact backup, so the list is empty. Projects and recordings are unchanged; start such a job again and it continues after its last finished stage.
notice-people-restored = The file of people and of the audit log, { $file }, was damaged ({ $damage }){ $kept ->
    [0] {""}
   *[other] ; it is kept as { $aside }
    }. The copy of { $day } replaces it: people, roles and passwords are those of that day, later entries of the audit log are missing, and everybody has to sign in again. An admin should look through the list of people.

## Pages that help

see-storage = See what takes space
see-login = Sign in
see-capture = Open the capture
see-jobs = See all jobs
see-project = Open { $project }
see-rig = Load { $rig } again

## Approvals and decisions

approve-map-changed = the map was changed since it was looked at: look at it again
approve-again = version { $version } by { $who } approves these results already
approve-no-map = there is no finished map yet: nothing to approve
approve-damaged = { $detail }: rebuild the map first
approve-journal-altered = the journal was altered: { $detail }
approve-conflicts = { $count ->
    [one] { $count } accepted loop closure does not fit the graph: reject it, or confirm it with a reason
   *[other] { $count } accepted loop closures do not fit the graph: reject them, or confirm them with a reason
 }
reason-no-verdict = this map has no verdict: an earlier version of recon4 made it
reason-do-not-use = the verdict on this map is "do not use": { $reasons }
reason-not-observable = a direction of this map is not observable along { $count } of its stretches
approve-reason-no-verdict = this map has no verdict: an earlier version of recon4 made it; to approve it in spite of that, give a reason of at least { $characters } characters
approve-reason-do-not-use = the verdict on this map is "do not use": { $reasons }; to approve it in spite of that, give a reason of at least { $characters } characters
approve-reason-not-observable = a direction of this map is not observable along { $count } of its stretches; to approve it in spite of that, give a reason of at least { $characters } characters
approve-other-result = { $file } is not what the run wrote: rebuild the map first
approve-decisions-missing = the last decisions are not in the map: rebuild the map first
decided-meanwhile = { $count ->
        [one] another reviewer decided once meanwhile
       *[other] another reviewer made { $count } decisions meanwhile
    }; look again
nothing-to-undo = there is nothing to { $step }
correction-not-in-force = no correction of classes { $id } is in force
correction-made-already = { $who } made the same correction of classes already
pair-decided-by-you = you, in another window, decided about this pair meanwhile ({ $kind }): look at it again, then decide
pair-decided = { $who } decided about this pair meanwhile ({ $kind }): look at it again, then decide
corrections-changed = { $who } changed corrections of classes meanwhile ({ $kind }): count again, then apply

## Fields of a request, by the kinds of pydantic

field-missing = Field required
field-extra_forbidden = Extra inputs are not permitted
field-string_type = Input should be a valid string
field-int_type = Input should be a valid integer
field-int_parsing = Input should be a valid integer, unable to parse string as an integer
field-int_from_float = Input should be a valid integer, got a number with a fractional part
field-float_type = Input should be a valid number
field-float_parsing = Input should be a valid number, unable to parse string as a number
field-finite_number = Input should be a finite number
field-bool_type = Input should be a valid boolean
field-bool_parsing = Input should be a valid boolean, unable to interpret input
field-list_type = Input should be a valid list
field-dict_type = Input should be a valid dictionary
field-greater_than = Input should be greater than { $gt }
field-greater_than_equal = Input should be greater than or equal to { $ge }
field-less_than = Input should be less than { $lt }
field-less_than_equal = Input should be less than or equal to { $le }
field-string_too_short = String should have at least { $min_length ->
        [one] { $min_length } character
       *[other] { $min_length } characters
}
field-string_too_long = String should have at most { $max_length ->
        [one] { $max_length } character
       *[other] { $max_length } characters
}
field-string_pattern_mismatch = String should match pattern '{ $pattern }'
field-too_short = { $field_type } should have at least { $min_length ->
        [one] { $min_length } item
       *[other] { $min_length } items
} after validation, not { $actual_length }
field-too_long = { $field_type } should have at most { $max_length ->
        [one] { $max_length } item
       *[other] { $max_length } items
} after validation, not { $actual_length }
field-enum = Input should be { $expected }
field-literal_error = Input should be { $expected }
field-json_invalid = JSON decode error

## Words

word-stopped-the-disk-is-nearly-full = the disk is nearly full
word-weakness-repeat = a repetition
word-weakness-spatial = neighboring keys
word-weakness-sequence = a sequence such as abc or 123
word-weakness-regex = a year
word-weakness-date = a date or year
word-weakness-user_inputs = your name, a role, or a name of this product or computer
word-weakness-dictionary = a common word, name or password
word-weakness-bruteforce = too few different characters
word-permission-shared = see a shared map
word-permission-look = look
word-permission-review = review
word-permission-process = process
word-permission-capture = capture
word-permission-share = share
word-permission-administer = administer
word-entry-note = note
word-entry-view = view
word-trash-project = project
word-trash-recording = recording
word-started-jobs = jobs
word-started-exports = exports
word-started-verifications = verifications of deliveries
word-started-comparisons = comparisons
word-started-target-searches = searches for targets
word-streams-assistant-calls = calls of assistants
word-streams-viewers = viewers
word-streams-event-streams = event streams
word-streams-live-streams = live streams
word-step-undo = undo
word-step-redo = redo
word-decision-accept = accept
word-decision-reject = reject
word-decision-restore = restore
word-decision-replace = replace
word-decision-add = add
word-decision-classify = classify
word-decision-withdraw = withdraw

## Workers

workers-count = count: expected 0 to { $most }, got { $got }
workers-scheduler-malformed = scheduler: expected tls://HOST:PORT; anyone who reaches a scheduler without certificates can run programs on its workers
workers-dashboard-malformed = dashboard: expected the address of a page, https://HOST:PORT/status
workers-both = choose processes of this computer or a scheduler, not both
workers-being-tested = the workers are being tested: wait for the answer
workers-test-failed = the test gave no answer: see recon4 doctor
