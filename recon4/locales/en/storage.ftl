### What takes space on the server.

## Page

storage-page = Storage · recon4
reading = Reading the sizes…
takes-space = What takes space
kind = Kind
used-by = Used by
action = Action
nothing-stored = Nothing is stored yet
kind-recording = Recording, uploaded
kind-upload = Unfinished upload
kind-deleted = Deleted
recording-used = { $projects } keep their maps, but cannot be processed from it again.
restorable = It can be restored for a week.
upload-goes = What was received is removed at once.
not-restorable = It cannot be restored afterwards.
open = Open
until = until { $when }
disk-is = { $free } of { $disk } are free. Listed here: { $listed }; queue, logs and caches of the server: { $server }.
