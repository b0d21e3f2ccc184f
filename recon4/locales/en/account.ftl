### Login, pairing, guests, accounts and people.

## Login

login-page = Sign in · recon4
show-password = Show the password
password-hint = At least 12 characters. A few words you do not say together are good
first-admin-page = First admin · recon4
first-admin = Create the first admin
first-admin-why = This server has no accounts yet. This link works once
first-admin-go = Create admin and sign in

## Guests

guest-page = Shared map · recon4
shared-map = Shared map
opening = Opening…
sign-in-password = Sign in with a password
guest-signed-in = This browser is signed in already: sign out to see what a guest sees.
guest-nothing = This link opens nothing.
guest-no-link = Open the link that you were given; its address ends with a long word.
guest-ended = This visit has ended: open the link that you were given again. If it opens nothing, ask the person who sent it.

## Pairing, on the phone

pair-page = Pair this phone · recon4
pair-phone = Pair this phone
phone-name = Name of this phone
phone-example = Anna's phone
show-code = Show a code
signing-in = Signing in…
pair-new-code = Make a new QR code on the laptop, or sign in with a code
pair-enter = On a computer that is signed in, open the page Phone and enter this code
pair-waiting = Waiting, { $time } left
pair-ended = The session of this phone has ended; a running capture goes on.
pair-scan = Scan the QR code on the laptop (page Phone), or sign in with a code

## Account

account-page = Account · recon4
account = Account
signed-in-where = Where you are signed in
change-your-password = Change your password
old-password = Old password
new-password = New password, at least 12 characters
change-password = Change password
programs = Programs can do what these pages do:
http-api = HTTP API
no-login = This server has no login
password-changed = The password is changed; your other sessions have ended

## Sessions

device = { $browser } on { $system }
device-unknown = Unknown program
person = Person
session-device = Device
from-address = From
session-began = Signed in
session-seen = Last seen
action = Action
session-end-of = End session of { $who }, { $device }
session-end = End
session-this = This one
session-token = Access token “{ $label }”, until { $when }

## Access tokens

tokens = Access tokens
tokens-what = A program or an assistant with a token acts in your name until the token expires. End it above at any time; a new password ends all.
token-for = For which program
token-example = Assistant of the office
token-may = It may
token-role-viewer = look only
token-role-operator = look, and start jobs and captures
token-role-reviewer = look, start jobs and decide loop closures
token-days = For
token-make = Make access token
token-made = Shown only now. Programs send it as Authorization: Bearer …
token-assistant = Entry for a program that hosts an assistant:

## People

people-page = People · recon4
people-without = This server runs without login: these people can sign in once it is started with --lan
role = Role
state = State
since = Since
no-accounts = No accounts yet
add-person = Add a person
first-password = First password, at least 12 characters
add = Add
sessions = Sessions
role-is-viewer = Viewer: looks and measures
role-is-operator = Operator: records and processes
role-is-reviewer = Reviewer: processes, decides, approves
role-is-admin = Admin: everything
role-of = Role of { $name }
enable = Enable
disable = Disable
enable-of = Enable { $name }
disable-of = Disable { $name }
is-disabled = Disabled
may-sign-in = May sign in

## Audit log

audit-log = Audit log
when = When
who = Who
what = What
outcome = Outcome
older = Older entries
outcome-done = Done
outcome-refused = Refused
outcome-failed = Failed
chain-broken = Entry { $entry } does not match the hash of the one before: the log was altered
chain-intact = { $entries ->
    [one] { COUNT($entries) } entry
   *[other] { COUNT($entries) } entries
 }, hash chain intact

## Trusted keys

trusted-keys = Trusted keys
keys-what = An approval counts only if one of these keys signed it. Before you add a key of other people, compare it with them by telephone or on paper.
whose = Whose
key = Key
change = Change
no-keys = No keys yet: this server makes its own with the first approval
whose-key = Whose key
public-key-digits = Public key, 64 hexadecimal digits
trust-key = Trust this key
remove-key-of = Remove the key of { $name }
public-key = Public key
key-counts = Counts
key-removed = Removed { $when } by { $who }
made-here = { $when }, made here
added-by = { $when }, by { $who }

## Webhooks

webhooks = Webhooks
webhooks-what = Finished jobs and approvals are posted to these addresses, signed, until they are taken.
address = Address
takes = Takes
no-webhooks = No webhooks yet
webhook-secret = The receiver checks signatures with this secret, which is shown only now:
add-webhook = Add webhook
event-jobs = finished jobs
event-approvals = approvals
event-tests = tests
undelivered = { $count } not delivered yet
delivered = All delivered
test = Test

## Pairing, on the laptop

phone-page = Phone · recon4
phone = Phone
phone-without = This server listens to this computer only
phone-network = A phone can view and control a capture once the server is started for the network, with TLS and login:
phone-first-start = Its first start makes a certificate and shows a link to create the first admin. No internet is needed: phone and laptop in the same Wi-Fi are enough, the laptop's own hotspot too.
phone-live-here = Live page on this computer
phone-may = The phone may
with-qr = With a QR code
show-qr = Show QR code
qr-alt = QR code for one phone
qr-host = The phone reaches this computer at
with-code = With a code the phone shows
code-open = On the phone open
code-touch = and touch "Show a code". Then type it here:
six-digits = Six digits
approve = Approve
trust-server = The phone asks whether to trust this server
fingerprint = Compare before you go on: the certificate the phone shows must have this SHA-256 fingerprint
paired-for = A phone stays paired for 12 hours.
end-session = End its session
at-any-time = at any time.
phone-operator = look, and start, mark and stop
phone-viewer = look only
approve-as = Approve as { $role }
show-new-code = Show a new code
qr-left = For one phone, as { $role }, { $seconds } s left
phone-signed-in = { $name } at { $address } is signed in as { $role }

## Workers

workers = Workers of jobs
workers-what = Loop closures, classes and the map take most of the time of a job. Processes of Dask can make parts of them, here or on other computers; the results have the same bytes. The choice holds for jobs that begin from now on.
workers-here = Processes of this computer, 0 = none
workers-scheduler = Scheduler of Dask, tls://HOST:PORT
workers-dashboard = Its dashboard, shown to admins
workers-saved = Saved; now test them
workers-tested = Testing…
certificates-there = The certificates for a scheduler are in
certificates-missing = A scheduler needs the certificates ca.pem, client.pem and client-key.pem in

## Actions of the audit log

audit-add-note = add note
audit-add-person = add person
audit-add-webhook = add webhook
audit-approve-phone = approve phone
audit-cancel-comparison = cancel comparison
audit-cancel-export = cancel export
audit-cancel-job = cancel job
audit-cancel-search-for-targets = cancel search for targets
audit-change-note = change note
audit-change-password = change password
audit-change-project = change project
audit-choose-workers = choose workers
audit-compare = compare
audit-delete-project = delete project
audit-delete-recording = delete recording
audit-disable = disable
audit-enable = enable
audit-end-session = end session
audit-export = export
audit-find-targets = find targets
audit-free-space = free space
audit-give-up-upload = give up upload
audit-invite-phone = invite phone
audit-live-start = start capture
audit-live-stop = stop capture
audit-make-access-token = make access token
audit-open-guest-link = open guest link
audit-pair-phone = pair phone
audit-post-webhook = post webhook
audit-put-map-on-control-points = put map on control points
audit-rebuild-map = rebuild map
audit-remove = remove
audit-remove-export = remove export
audit-remove-key = remove key
audit-remove-note = remove note
audit-remove-photo-of-note = remove photo of note
audit-remove-view = remove view
audit-remove-webhook = remove webhook
audit-restore = restore
audit-restore-people = restore people
audit-resume-job = resume job
audit-revoke-guest-link = revoke guest link
audit-save-rig = save rig
audit-save-view = save view
audit-set-password = set password
audit-set-role = set role
audit-set-up = set up
audit-share = share
audit-sign-in = sign in
audit-sign-in-again = sign in again
audit-sign-out = sign out
audit-start-job = start job
audit-take-map-off-control-points = take map off control points
audit-test-webhook = test webhook
audit-trust-key = trust key
audit-upload-recording = upload recording
audit-withdraw-correction-of-classes = withdraw correction of classes
audit-administer = administer
audit-capture = capture
audit-look = look
audit-process = process
audit-request = request
audit-review = review
audit-shared = shared
audit-show-metrics-token = show metrics token
audit-renew-signing-key = renew signing key
audit-approve = approve
audit-assistant = assistant
audit-correct-classes = correct classes
audit-photo-of-note = photo of note
